#include "lessons/graph_panels.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/fixed_depth.h"
#include "lessons/tree_scene.h"

namespace obscura {
namespace {

constexpr Rgb8 other_treelets{214, 212, 205};

/// Calls take(treelet, x, y, side) for every square that a treelet stands for; (x, y, side): that of the
/// node.
template <class Take>
void each_treelet(const DagTopology& dag, std::uint32_t node, int x, int y, int side, const Take& take) {
    const int half = side / 2;
    for (int i = 0; i < 4; ++i) {
        const int cx = x + (i & 1) * half, cy = y + (i >> 1) * half;
        const std::uint32_t child = dag.nodes[node].child[i];
        const DagKind kind = dag.nodes[node].kind(i);
        if (kind == DagKind::treelet) take(child, cx, cy, half);
        if (kind == DagKind::empty || kind == DagKind::full) each_treelet(dag, child, cx, cy, half, take);
    }
}

std::uint32_t root_of(const DagTopology& dag) {
    CHECK(!dag.nodes.empty());
    return static_cast<std::uint32_t>(dag.nodes.size() - 1);
}

double depth_of(TreeLayout layout, std::uint32_t number) {
    return static_cast<double>(depth_of_fixed(layout, number));
}

}  // namespace

std::vector<TreeletUse> treelet_uses(const DagTopology& dag) {
    std::vector<TreeletUse> uses(dag.treelets.size());
    for (std::uint32_t i = 0; i < uses.size(); ++i)
        uses[i].treelet = i;
    each_treelet(dag, root_of(dag), 0, 0, 1 << dag.levels,
                 [&](std::uint32_t treelet, int, int, int) { ++uses[treelet].squares; });
    std::stable_sort(uses.begin(), uses.end(),
                     [](const TreeletUse& a, const TreeletUse& b) { return a.squares > b.squares; });
    return uses;
}

Rgb8 treelet_color(std::size_t rank) {
    constexpr Rgb8 colors[coloured_treelets] = {ink::blue, ink::orange, ink::green,
                                                ink::red,  ink::sky,    ink::purple};
    return rank < coloured_treelets ? colors[rank] : other_treelets;
}

Image<Rgb8> treelet_map(const DagTopology& dag, const std::vector<TreeletUse>& uses, int texels) {
    std::vector<Rgb8> color(uses.size());
    for (std::size_t rank = 0; rank < uses.size(); ++rank)
        color[uses[rank].treelet] = treelet_color(rank);
    Image<Rgb8> map(texels, texels, ink::paper);
    each_treelet(dag, root_of(dag), 0, 0, texels, [&](std::uint32_t treelet, int x0, int y0, int side) {
        for (int y = y0; y < y0 + side; ++y)
            for (int x = x0; x < x0 + side; ++x)
                map(x, y) = color[treelet];
    });
    return map;
}

void draw_treelet(Figure& f, const Treelet& treelet, int levels, const Box& box, Rgb8 color) {
    f.fill(box, ink::panel);
    // Depth-first: a node, then all that hangs below each of its children.
    const auto draw = [&](auto&& self, std::uint32_t position, int below, const Box& square) -> void {
        const bool has_value = (treelet.bits[position / 32] >> position % 32 & 1u) != 0;
        if (has_value) {
            f.fill(square, color, 0.4);
            f.frame({square.x + 1, square.y + 1, square.w - 2, square.h - 2}, {color, 1.6});
        }
        if (below == 0) return;
        const double half = 0.5 * square.w;
        for (std::uint32_t i = 0; i < 4; ++i) {
            self(self, position + 1 + i * full_tree_nodes(below), below - 1,
                 {square.x + (i & 1u) * half, square.y + (i >> 1) * half, half, half});
        }
    };
    draw(draw, 0, levels - 1, box);
    f.frame(box, {ink::grey, 1});
}

std::uint32_t draw_counted_tree(Figure& f, const MultiresTree& tree, std::uint32_t x, std::uint32_t y,
                                const Box& box) {
    const auto place = [&](const TreeSquare& s) {
        // Squares of a level in the order of a quadtree, from left to right.
        double order = 0, count = 1;
        for (int bit = tree.levels - s.level; bit-- > 0; count *= 4)
            order = 4 * order + (s.x >> bit & 1u) + 2 * (s.y >> bit & 1u);
        return Vec2d{box.x + box.w * (order + 0.5) / count,
                     box.y + box.h * (tree.levels - s.level) / tree.levels};
    };
    const auto on_way = [&](const TreeSquare& s) { return x >> s.level == s.x && y >> s.level == s.y; };
    const std::vector<TreeSquare> squares = squares_of(tree);
    for (const TreeSquare& s : squares) {
        if (s.level == tree.levels) continue;
        const Vec2d from = place({s.level + 1, s.x / 2, s.y / 2});
        f.line(from, place(s), {on_way(s) ? ink::red : ink::grey, on_way(s) ? 3.0 : 1.2});
    }
    std::uint32_t number = 0, last = 0;
    for (const TreeSquare& s : squares) {
        const Vec2d at = place(s);
        const Rgb8 color = kind_color(s.kind);
        f.fill({at.x - 24, at.y - 13, 48, 26}, color);
        const bool has_value = s.kind != ChildKind::empty;
        f.label({at.x - 24, at.y - 13, 48, 26}, has_value ? fmt::format("{:.2f}", s.value) : "empty",
                {8.5, readable_on(color), Align::centre, true});
        if (!has_value) continue;
        if (on_way(s)) last = number;
        f.text(at + Vec2d{29, -2}, fmt::format("{}", number++),
               {9.5, on_way(s) ? ink::red : ink::dark, Align::left, true, true});
    }
    return last;
}

void draw_chunk(Figure& f, const std::vector<NumberRange>& ranges, const ValueChunk& chunk, TreeLayout layout,
                const Box& box) {
    std::vector<std::uint32_t> chosen;
    std::size_t next = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const bool factor = (chunk.has_factor[i / 32] >> i % 32 & 1u) != 0;
        chosen.push_back(factor ? chunk.base + chunk.step * chunk.factors[next++] : chunk.representative);
        CHECK(ranges[i].least <= chosen.back() && chosen.back() <= ranges[i].greatest, "lossless");
    }
    const auto [low, high] = std::minmax_element(chosen.begin(), chosen.end());
    const double least = depth_of(layout, *low), greatest = depth_of(layout, *high),
                 rim = 0.08 * (greatest - least);
    const Plot plot{{box.x, box.y, box.w, box.h - 40},
                    0,
                    static_cast<double>(ranges.size()),
                    -(greatest + rim),
                    -(least - rim)};
    f.fill(plot.box, ink::panel);
    const double step = depth_of(layout, chunk.step);
    for (double z = depth_of(layout, chunk.base); z < greatest + rim && step > 0.01 * (greatest - least);
         z += step) {
        if (z > least - rim) f.line(plot.at(plot.x0, -z), plot.at(plot.x1, -z), {ink::grid, 0.8});
    }
    const double of_most = -depth_of(layout, chunk.representative);
    f.line(plot.at(plot.x0, of_most), plot.at(plot.x1, of_most), {ink::orange, 1.6, 5});
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const bool factor = (chunk.has_factor[i / 32] >> i % 32 & 1u) != 0;
        const double x = static_cast<double>(i) + 0.5;
        const double top = std::max(-std::min(depth_of(layout, ranges[i].greatest), greatest + rim), plot.y0);
        const double end = -std::max(depth_of(layout, ranges[i].least), least - rim);
        const Vec2d from = plot.at(x, end), to = plot.at(x, top);
        const Rgb8 color = factor ? ink::blue : ink::orange;
        f.fill({from.x - 5, from.y, 10, std::max(to.y - from.y, 2.0)}, mix(color, ink::paper, 0.45));
        f.disc(plot.at(x, -depth_of(layout, chosen[i])), 3.6, color);
        f.text({from.x, box.y + box.h - 16}, factor ? "1" : "0", {9, color, Align::centre, true});
    }
}

void draw_halves(Figure& f, const std::vector<TwoHalves>& bars, const Plot& plot) {
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const double x = static_cast<double>(i) + 0.5, whole = bars[0].sum();
        const Vec2d foot = plot.at(x, 0), waist = plot.at(x, bars[i].structure / whole),
                    top = plot.at(x, bars[i].sum() / whole);
        f.fill({foot.x - 22, waist.y, 44, foot.y - waist.y}, ink::blue);
        f.fill({foot.x - 22, top.y, 44, waist.y - top.y}, ink::orange);
        f.text(top - Vec2d{0, 7}, fmt::format("{:.2f}", bars[i].sum() / whole),
               {8.5, ink::dark, Align::centre, true});
        f.text(foot + Vec2d{0, 20}, bars[i].name, {8.5, ink::soft, Align::centre});
    }
}

}  // namespace obscura
