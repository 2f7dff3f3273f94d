#pragma once
// Panels of the lesson on graphs: treelets and where they stand, a small tree whose values are counted, a
// chunk of values, and bytes in two halves.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/pixel.h"
#include "core/types.h"
#include "hierarchy/dag/chunks.h"
#include "hierarchy/dag/topology.h"
#include "hierarchy/multires.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// A treelet, and how many squares of the map it stands for.
struct TreeletUse {
    std::uint32_t treelet = 0;
    std::uint64_t squares = 0;
};
/// Of all treelets, the commonest first.
std::vector<TreeletUse> treelet_uses(const DagTopology& dag);

/// The commonest have a colour of their own, by their rank.
constexpr std::size_t coloured_treelets = 6;
Rgb8 treelet_color(std::size_t rank);

/// A map of `texels` a side with every square that a treelet stands for in its colour.
Image<Rgb8> treelet_map(const DagTopology& dag, const std::vector<TreeletUse>& uses, int texels);
/// Which of its nodes have a value: every level's squares inside those of the level above.
void draw_treelet(Figure& f, const Treelet& treelet, int levels, const Box& box, Rgb8 color);

/// The tree of a map of 4 x 4 texels from its root down, its values numbered; the way to texel (x, y) in red.
/// Returns the number of the last value met.
std::uint32_t draw_counted_tree(Figure& f, const MultiresTree& tree, std::uint32_t x, std::uint32_t y,
                                const Box& box);

/// A chunk of the paper's: ranges as bars, the representative, the grid of factors, and the bits.
void draw_chunk(Figure& f, const std::vector<NumberRange>& ranges, const ValueChunk& chunk, TreeLayout layout,
                const Box& box);

/// One bar of bytes.
struct TwoHalves {
    std::string name;
    double structure = 0, values = 0;
    double sum() const { return structure + values; }
};
/// Bars side by side, as shares of the first.
void draw_halves(Figure& f, const std::vector<TwoHalves>& bars, const Plot& plot);

}  // namespace obscura
