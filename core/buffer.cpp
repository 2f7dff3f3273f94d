#include "core/buffer.h"

#include <emmintrin.h>
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace obscura {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t cache_line = 64;

std::size_t rounded(std::size_t bytes) {
    const std::size_t unit = bytes >= huge_page ? huge_page : cache_line;
    return (bytes + unit - 1) / unit * unit;
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
    if (bytes == 0) return nullptr;
    const std::size_t size = rounded(bytes);
    if (size < bytes) throw std::bad_alloc();
    void* p = std::aligned_alloc(size >= huge_page ? huge_page : cache_line, size);
    if (p == nullptr) throw std::bad_alloc();
    // Only advice: without huge pages everything works, slower.
    if (size >= huge_page) madvise(p, size, MADV_HUGEPAGE);
    return p;
}

void free_pages(void* p, std::size_t) noexcept {
    std::free(p);
}

void copy_streaming(void* to, const void* from, std::size_t bytes) noexcept {
    if (reinterpret_cast<std::uintptr_t>(to) % 16 != 0) {
        std::memcpy(to, from, bytes);
        return;
    }
    auto* target = static_cast<char*>(to);
    const auto* source = static_cast<const char*>(from);
    std::size_t i = 0;
    for (; i + 64 <= bytes; i += 64) {
        for (std::size_t k = 0; k < 64; k += 16) {
            _mm_stream_si128(reinterpret_cast<__m128i*>(target + i + k),
                             _mm_loadu_si128(reinterpret_cast<const __m128i*>(source + i + k)));
        }
    }
    std::memcpy(target + i, source + i, bytes - i);
}

void finish_streaming() noexcept {
    _mm_sfence();
}

}  // namespace obscura
