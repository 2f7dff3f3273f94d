// Lesson 6. The tree, level by level: a shadow map that is precise only where it must be.
//
// You learn: every level of the tree is a shadow map of its own, half as fine as the next; nodes crowd where
// depth intervals have nothing in common, along the outlines of shadows and steps, and leave faces alone; so
// twice the resolution costs twice the nodes, not four times. L. Scandolo, P. Bauszat, E. Eisemann,
// "Compressed Multiresolution Hierarchies for High-Quality Precomputed Shadows", Eurographics 2016, figure 2.
//
// Calls: raster/interval_map.h interval_map, hierarchy/multires.h build_bottom_up, count_nodes,
//        hierarchy/codes/codes.h encode_tree, hierarchy/codes/decode.h tree_value_at_level.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/tree_scene.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

constexpr int map_texels = 256;
constexpr Rgb8 near_grey{238, 238, 235}, far_grey{110, 112, 118};

// Step 1: what a lookup that stops at a level sees, in greys.
Image<Rgb8> map_at_level(const ShadowTree& tree, int level, const std::array<float, 2>& range) {
    Image<Rgb8> map(map_texels, map_texels);
    for (int y = 0; y < map_texels; ++y) {
        for (int x = 0; x < map_texels; ++x) {
            // Every texel of a square sees the same.
            const int in_square = (1 << level) - 1, x0 = x & ~in_square, y0 = y & ~in_square;
            if (x != x0 || y != y0) {
                map(x, y) = map(x0, y0);
                continue;
            }
            const float depth = tree_value_at_level(tree.code, static_cast<std::uint32_t>(x),
                                                    static_cast<std::uint32_t>(y), level);
            const double t = static_cast<double>((depth - range[0]) / (range[1] - range[0]));
            map(x, y) = depth >= 1.0f ? ink::paper : mix(near_grey, far_grey, std::clamp(t, 0.0, 1.0));
        }
    }
    return map;
}

// Step 2: that map, with the nodes of the level as frames.
void draw_level(Figure& f, const ShadowTree& tree, const std::vector<TreeSquare>& squares, int level,
                const Cells& cells, const std::array<float, 2>& range) {
    const Image<Rgb8> map = map_at_level(tree, level, range);
    // Painted four times as fine, then averaged: 256 texels on 344 pixels leave no pattern.
    constexpr int shrink = 4;
    const int side_px = static_cast<int>(cells.box().w);
    Image<Rgb8> fine(side_px * shrink, side_px * shrink);
    for (int y = 0; y < fine.height; ++y) {
        for (int x = 0; x < fine.width; ++x)
            fine(x, y) = map(x * map_texels / fine.width, y * map_texels / fine.height);
    }
    f.image(static_cast<int>(cells.origin.x), static_cast<int>(cells.origin.y), fine, shrink);
    std::array<int, 4> counts{};
    for (const TreeSquare& s : squares) {
        if (s.level != level) continue;
        ++counts[static_cast<std::size_t>(s.kind)];
        const double side = 1 << level;
        const Vec2d corner = cells.at(s.x * side, s.y * side);
        const Box box{corner.x, corner.y, side * cells.side, side * cells.side};
        f.fill(box, kind_color(s.kind), level <= 1 ? 0.85 : 0.25);
        if (level > 1) f.frame(box, {kind_color(s.kind), 1.2});
    }
    f.frame(cells.box(), {ink::soft, 1});
    const int side = 1 << level;
    f.text(cells.at(0, 0) - Vec2d{0, 10},
           side == 1 ? std::string("texels") : fmt::format("squares of {} x {} texels", side, side),
           lettering::bold);
    f.text(cells.at(map_texels, 0) - Vec2d{0, 10},
           fmt::format("{} full · {} empty · {} leaves", counts[3], counts[2], counts[1]),
           {8, ink::dark, Align::right});
}

// Step 3: nodes against resolution.
void draw_growth(Figure& f, const Mesh& mesh, const Plot& plot, const Exec& exec) {
    f.axes(plot, "", "thousands");
    std::vector<Vec2d> nodes, texels;
    std::uint64_t before = 0;
    for (int n = 32; n <= 512; n *= 2) {
        const Image<DepthInterval> intervals = interval_map(mesh, lesson_view(mesh, n), {}, exec);
        const MultiresCounts c = count_nodes(build_bottom_up(intervals.view()));
        const std::uint64_t total = c.full + c.empty + c.leaf;
        const double x = n;
        nodes.push_back(plot.at(x, static_cast<double>(total) * 1e-3));
        if (x * x * 1e-3 <= plot.y1) texels.push_back(plot.at(x, x * x * 1e-3));
        f.disc(nodes.back(), 4.5, ink::blue);
        if (n >= 256) {
            f.text(nodes.back() + Vec2d{-8, -10},
                   fmt::format("x {:.2f}", static_cast<double>(total) / static_cast<double>(before)),
                   {8.5, ink::blue, Align::right, true, true});
        }
        before = total;
        if (n >= 128) f.text(plot.at(x, 0) + Vec2d{0, 20}, fmt::format("{}", n), lettering::tick);
    }
    f.polyline(nodes, {ink::blue, 2});
    f.polyline(texels, {ink::red, 2, 6});
    f.text(texels.back() + Vec2d{10, 16}, "texels", {9.5, ink::red, Align::left, true});
}

}  // namespace

Image<Rgb8> lesson_6_tree(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(6, "The tree, level by level",
              "Every level is a shadow map; nodes stand only where squares have no depth in common.");
    const Mesh mesh = lesson_town();
    const LightView view = lesson_view(mesh, map_texels);
    const Image<DepthInterval> intervals = interval_map(mesh, view, {}, exec);
    const MultiresTree built = build_bottom_up(intervals.view());
    const ShadowTree tree = encode_tree(built, view);
    const std::vector<TreeSquare> squares = squares_of(built);
    std::array<float, 2> range{1, 0};
    for (const DepthInterval& i : intervals.pixels) {
        if (i.entry < 1.0f) range = {std::min(range[0], i.entry), std::max(range[1], stored_depth(i))};
    }

    constexpr int levels[] = {6, 5, 4, 3, 2, 1, 0};
    for (int i = 0; i < 7; ++i) {
        const Cells cells{
            {40 + 390.0 * (i % 4), 160 + 400.0 * (i / 4)}, 344.0 / map_texels, map_texels, map_texels};
        draw_level(f, tree, squares, levels[i], cells, range);
    }
    f.text({1228, 550}, "Nodes against texels a side", lettering::bold);
    draw_growth(f, mesh, {{1256, 586, 290, 288}, 0, 540, 0, 18}, exec);
    f.legend({40, 936}, {{Mark::square, kind_color(ChildKind::full), "full: value and children"},
                         {Mark::square, kind_color(ChildKind::leaf), "leaf: value"},
                         {Mark::square, kind_color(ChildKind::empty), "empty: children only"},
                         {Mark::square, near_grey, "near the light"},
                         {Mark::square, far_grey, "far from it"}});
    f.source_line(6,
                  "raster/interval_map.h interval_map · hierarchy/multires.h build_bottom_up · "
                  "hierarchy/codes/decode.h tree_value_at_level");
    return f.picture;
}

}  // namespace obscura
