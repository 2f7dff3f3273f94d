#pragma once
// What the lookups of one frame will ask of a tree.

#include <cstdint>
#include <span>
#include <vector>

#include "core/morton.h"

namespace obscura {

/// Squares of a map whose values will be asked for: at level 0 texels, at level l squares of 2^l texels whose
/// own value (a descent that stops there) is wanted, not what lies below it.
class NeededNodes {
  public:
    /// x, y in squares of that level.
    void add(std::uint32_t x, std::uint32_t y, int level);
    /// All texels of the 2^level square (x, y).
    void add_texels(std::uint32_t x, std::uint32_t y, int level);
    /// The same for morton_code(x, y).
    void add(std::uint64_t morton, int level);
    void add_texels(std::uint64_t morton, int level);
    /// Takes over all of the other's.
    void add(const NeededNodes& other);
    /// Sorts, drops repetitions; call before building.
    void finish();

    /// What is needed inside a square: a run of codes.
    using Codes = std::span<const std::uint64_t>;
    Codes all() const { return codes_; }
    /// Those inside child i of the square whose codes are given; `height`: of the child, log2 of its side.
    static Codes inside_child(Codes codes, std::uint64_t child_morton, int height);
    /// Whether the whole square is asked for: its value or all of its texels.
    static bool asks_for_all(Codes codes, std::uint64_t morton, int height);
    /// Whether its value is wanted and nothing of what lies below it.
    static bool asks_for_value_only(Codes codes, std::uint64_t morton, int height);

  private:
    std::vector<std::uint64_t> codes_;
};

}  // namespace obscura
