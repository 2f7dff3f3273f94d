#pragma once
// A 64-bit content hash for golden pictures, caches and determinism tests. Not cryptographic.

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace obscura {

/// FNV-1a (Fowler, Noll, Vo), 64 bits, byte by byte: slow and unambiguous on any machine.
struct Hasher {
    std::uint64_t state = 0xcbf29ce484222325u;

    Hasher& bytes(const void* data, std::size_t size) {
        const auto* p = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i)
            state = (state ^ p[i]) * 0x100000001b3u;
        return *this;
    }
    /// T must have no padding: bytes that mean nothing would be hashed too.
    template <class T>
    requires std::is_trivially_copyable_v<T> Hasher& value(const T& v) { return bytes(&v, sizeof v); }
    template <class T>
    requires std::is_trivially_copyable_v<T> Hasher& values(const std::vector<T>& v) {
        return bytes(v.data(), v.size() * sizeof(T));
    }
};

/// A hash of large memory at the speed of reading it, the same on any machine: four interleaved lanes of
/// little-endian 64-bit words with the round of xxHash64 (Y. Collet, 2014), joined by a Hasher together with
/// the size. Rounds can be undone, so any change within one word changes its lane.
std::uint64_t bulk_hash(const void* data, std::size_t size);

/// 16 lower-case hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace obscura
