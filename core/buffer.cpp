#include "core/buffer.h"

#include <sys/mman.h>

#include <cstdlib>
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

}  // namespace obscura
