#include "core/hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace obscura {
namespace {

constexpr std::size_t lanes = 4, block_bytes = lanes * sizeof(std::uint64_t);
static_assert(std::endian::native == std::endian::little, "words are hashed as they lie in memory");

void add_block(std::uint64_t (&lane)[lanes], const unsigned char* block) {
    std::uint64_t word[lanes];
    std::memcpy(word, block, block_bytes);
    for (std::size_t i = 0; i < lanes; ++i)
        lane[i] = std::rotl(lane[i] + word[i] * 0xc2b2ae3d27d4eb4fu, 31) * 0x9e3779b185ebca87u;
}

}  // namespace

std::uint64_t bulk_hash(const void* data, std::size_t size) {
    std::uint64_t lane[lanes] = {0xcbf29ce484222325u, 0x9ae16a3b2f90404fu, 0xc3a5c85c97cb3127u,
                                 0xb492b66fbe98f273u};
    const auto* p = static_cast<const unsigned char*>(data);
    std::size_t left = size;
    for (; left >= block_bytes; left -= block_bytes, p += block_bytes)
        add_block(lane, p);
    if (left > 0) {
        // The size tells a short last block from one with zeros.
        unsigned char last[block_bytes] = {};
        std::copy_n(p, left, last);
        add_block(lane, last);
    }
    Hasher joined;
    for (const std::uint64_t l : lane)
        joined.value(l);
    return joined.value(static_cast<std::uint64_t>(size)).state;
}

std::string hash_text(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

}  // namespace obscura
