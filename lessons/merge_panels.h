#pragma once
// Panels of the lesson on merging: two houses on a map, their depths and differences; which squares of a town
// stand for others.

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"
#include "core/types.h"
#include "hierarchy/mmh/merge.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"
#include "lessons/drawing/figure.h"

namespace obscura {

inline DepthInterval moved(DepthInterval i, float by) {
    return {i.entry - by, i.exit - by};
}
inline DepthInterval common(DepthInterval a, DepthInterval b) {
    return {std::max(a.entry, b.entry), std::min(a.exit, b.exit)};
}
inline float middle(DepthInterval i) {
    return 0.5f * (i.entry + i.exit);
}

/// A roof of 4 x 4 texels and what stands out of it: the texels at (1, 0) and (2, 3).
struct House {
    DepthInterval roof, first, second;
};

/// 0: the roof; 1, 2: what stands out of it.
inline DepthInterval part_of(const House& house, std::size_t part) {
    return part == 0 ? house.roof : part == 1 ? house.first : house.second;
}

/// Two houses on level ground, far enough apart to be subtrees of their own.
Image<DepthInterval> map_of(const std::array<House, 2>& houses);
/// Depths that a tree of that map has: of house `i`, in the order of House.
std::array<float, 3> decoded(const ShadowTree& tree, int i);

/// Intervals as bars, depth growing downwards, from plot.x to the right; each with its depth as a dot.
struct DepthBar {
    double x = 0;
    DepthInterval interval;
    Rgb8 color;
    double half_px = 14;
};
void draw_bar(Figure& f, const Plot& plot, const DepthBar& bar);
/// A dot at a depth of the plot, and its number beside it.
void draw_depth(Figure& f, const Plot& plot, double x, double depth, Rgb8 color,
                const std::string& text = "");
/// A plot of depths from `least` at the top to `greatest`, `columns` wide.
Plot depth_plot(Figure& f, const Box& box, double columns, double least, double greatest);

constexpr Rgb8 house_colors[] = {ink::blue, ink::orange};
/// Two houses by their intervals and stored depths (in the order of House); beside them the intervals of what
/// stands out of the roofs, less the roofs' depths, and what is common to both.
void draw_houses(Figure& f, const std::array<House, 2>& houses,
                 const std::array<std::array<float, 3>, 2>& depths, const Box& absolute, const Box& relative);

/// Bytes of a merged tree, of those of the tree as it is, when so many subtrees are compared with each; 0:
/// all.
struct LimitedShare {
    int limit = 0;
    double share = 1;
};
/// A curve, one step to the right for each.
void draw_shares(Figure& f, const std::vector<LimitedShare>& shares, const Plot& plot);

/// Where a subtree's four nodes lie on the map.
struct SubtreeSquare {
    int x = 0, y = 0, side = 0;
};
/// Of every subtree of the set, in its order.
std::vector<SubtreeSquare> subtree_squares(const SubtreeSet& set, int side);

/// The town of a tree's map from the light, grey by depth; squares whose subtree is another's are coloured,
/// those of the same subtree alike.
Image<Rgb8> merged_town(const Image<DepthInterval>& map, const SubtreeSet& set, const Merged& merged);

}  // namespace obscura
