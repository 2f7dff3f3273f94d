#pragma once
// Squares of a light's maps, each once, however often it is added.

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/needed_nodes.h"

namespace obscura {

/// Four by four squares to a word of 64 bits: a key (view, level, the place of the four by four) above a mask
/// of 16. Neighbouring samples mostly read squares of one word, and there are several times fewer words to
/// sort than squares. Words stand in a table by hash; what is in it does not depend on the order of adding.
class SquareSet {
  public:
    /// Squares x0 .. x1, y0 .. y1. view: 0 .. 5; level: 0 .. 20; x, y: 0 .. 2^19 - 1 in squares, whatever the
    /// levels mean.
    void add(int view, int level, std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
        for (std::int32_t y = y0 >> 2; y <= y1 >> 2; ++y) {
            for (std::int32_t x = x0 >> 2; x <= x1 >> 2; ++x) {
                const std::uint64_t key = (static_cast<std::uint64_t>(view * 32 + level) << place_bits |
                                           static_cast<std::uint64_t>(y))
                                              << place_bits |
                                          static_cast<std::uint64_t>(x);
                if (table_[last_] >> mask_bits != key || table_[last_] == 0) last_ = slot_of(key);
                table_[last_] |= columns(x0 - 4 * x, x1 - 4 * x) & rows(y0 - 4 * y, y1 - 4 * y);
            }
        }
    }

    /// The words; their keys hold Morton codes now, so that sorted words have sorted squares. Empties the
    /// set.
    std::vector<std::uint64_t> take_words();

  private:
    static constexpr int place_bits = 17, mask_bits = 16;
    // Squares of a word in columns, in rows first .. last, as far as it has them. Bit i of a word is its
    // square with Morton code i.
    static constexpr std::uint64_t columns(std::int32_t first, std::int32_t last) {
        constexpr std::uint64_t from[4] = {0xffff, 0xfafa, 0xf0f0, 0xa0a0},
                                to[4] = {0x0505, 0x0f0f, 0x5f5f, 0xffff};
        return from[first < 0 ? 0 : first] & to[last > 3 ? 3 : last];
    }
    static constexpr std::uint64_t rows(std::int32_t first, std::int32_t last) {
        constexpr std::uint64_t from[4] = {0xffff, 0xffcc, 0xff00, 0xcc00},
                                to[4] = {0x0033, 0x00ff, 0x33ff, 0xffff};
        return from[first < 0 ? 0 : first] & to[last > 3 ? 3 : last];
    }
    std::size_t slot_of(std::uint64_t key);
    std::size_t probe(std::uint64_t key) const;
    void grow();

    int log2_slots_ = 8;
    std::vector<std::uint64_t> table_ = std::vector<std::uint64_t>(std::size_t{1} << log2_slots_, 0);
    std::size_t used_ = 0, last_ = 0;
};

/// Number of squares in words of which no two have the same key.
std::int64_t count_squares(std::span<const std::uint64_t> words);

/// Sorts words of any number of sets, joins those of one key, and gives each view its squares. Those of level
/// 0 become squares of 2^texel_level texels with all of their texels, others stay what they are.
std::vector<NeededNodes> needed_of_words(std::vector<std::uint64_t> words, std::size_t views,
                                         int texel_level);

}  // namespace obscura
