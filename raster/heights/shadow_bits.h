#pragma once
// One bit for each sample.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace obscura {

/// Rows of 64-bit words, the leftmost sample in bit 0; bits beyond the width are 0.
struct ShadowBits {
    int width = 0, height = 0;
    std::ptrdiff_t words_per_row = 0;
    std::vector<std::uint64_t> words;

    ShadowBits() = default;
    ShadowBits(int width_, int height_)
        : width(width_),
          height(height_),
          words_per_row((width_ + 63) / 64),
          words(static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(height_)) {}

    std::uint64_t* row(int y) { return words.data() + words_per_row * y; }
    const std::uint64_t* row(int y) const { return words.data() + words_per_row * y; }
    bool operator()(int x, int y) const { return (row(y)[x >> 6] >> (x & 63) & 1) != 0; }
    void set(int x, int y) { row(y)[x >> 6] |= std::uint64_t{1} << (x & 63); }
    void clear(int x, int y) { row(y)[x >> 6] &= ~(std::uint64_t{1} << (x & 63)); }
    friend bool operator==(const ShadowBits&, const ShadowBits&) = default;
};

/// Samples whose bit is set in either; both of one size.
ShadowBits united(const ShadowBits& a, const ShadowBits& b);

std::int64_t count_of(const ShadowBits& bits);

/// Samples whose bit is set, and those of all their eight neighbours, too; beyond the map all count as set.
ShadowBits eroded(const ShadowBits& bits);

}  // namespace obscura
