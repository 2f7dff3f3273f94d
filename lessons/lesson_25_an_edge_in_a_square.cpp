// Lesson 25. An edge in a square.
//
// You learn: most nodes of a tree of depths follow an edge between two planes, and there are twice as many of
// them whenever the map's side doubles, though nothing new is to be seen. A leaf that holds the edge and the
// two planes does not mind how many texels it has: a square is divided only as long as it has more than one
// edge in it. Its values lie behind the planes, as depths of other trees lie between entry and exit; where
// two surfaces meet at the edge, so does what lies between them, and the offset has to shrink with the
// distance from it.
//
// Calls: hierarchy/facet/facet.h build_facet_tree, encode_facet, facet_stats,
//        hierarchy/facet/facet_step.h FacetCode, hierarchy/codes/decode.h tree_value.

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/facet/facet_step.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/facet_panels.h"
#include "lessons/ladder.h"
#include "lessons/tree_scene.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

BuildParams lesson_params() {
    BuildParams params;
    params.receivers = Receivers::static_only;
    return params;
}

// Steps 1 and 2: squares of either tree over the same roofs.
void draw_squares(Figure& f, const Mesh& mesh, const Exec& exec) {
    constexpr int texels = 256;
    constexpr double zoom = 1.5;
    const LightView view = lesson_view(mesh, texels);
    const MultiresTree depths = build_shadow_tree(mesh, view, lesson_params(), exec);
    const FacetTree tree = build_facet_tree(mesh, view, lesson_params(), exec);
    const Vec2d left{40, 166}, right{470, 166};
    f.text({40, 146}, "1  A tree of depths", lettering::head);
    f.text({470, 146}, "2  Planes and edges as leaves", lettering::head);
    for (const Vec2d at : {left, right})
        f.fill({at.x, at.y, texels * zoom, texels * zoom}, ink::panel);
    std::size_t nodes = 0;
    for (const TreeSquare& s : squares_of(depths)) {
        const double side = zoom * static_cast<double>(1 << s.level);
        const Box box{left.x + side * s.x, left.y + side * s.y, side, side};
        if (s.kind == ChildKind::leaf) f.fill(box, ink::green, 0.8);
        ++nodes;
    }
    std::size_t lines = 0, leaves = 0;
    const std::vector<FacetSquare> squares = squares_of(tree);
    for (const FacetSquare& s : squares) {
        const Box box{right.x + zoom * s.x, right.y + zoom * s.y, zoom * s.side, zoom * s.side};
        if (s.node != nullptr) {
            f.fill(box, s.line ? ink::sky : ink::green, s.line ? 0.35 : 0.5);
            if (s.side >= 4) f.frame(box, {ink::grid, 0.7});
        }
        ++(s.line ? lines : leaves);
    }
    for (const FacetSquare& s : squares) {
        if (!s.line) continue;
        const std::vector<Vec2d> ends = crossing(tree.edges[s.node->edge], s);
        if (ends.size() >= 2) f.line(right + ends[0] * zoom, right + ends[1] * zoom, {ink::red, 1.2});
    }
    f.paragraph(
        {40, 580},
        fmt::format(
            "The town of lesson 6, {} x {} texels: {} nodes, a leaf for\nevery texel or two along each "
            "edge.",
            texels, texels, nodes));
    f.paragraph(
        {470, 580},
        fmt::format("The same map, {} nodes: {} squares with one edge\nin them; small ones stand where edges "
                    "meet.",
                    tree.nodes.size(), lines));
}

// Step 3: a row of texels through one leaf.
void draw_row(Figure& f, const Mesh& mesh, const Exec& exec) {
    constexpr int texels = 1024;
    const LightView view = lesson_view(mesh, texels);
    const FacetTree tree = build_facet_tree(mesh, view, lesson_params(), exec);
    const ShadowTree encoded = encode_facet(tree, view, {});
    // The largest leaf with a plane on a ramp on one of its sides, and its middle row.
    const std::vector<FacetSquare> squares = squares_of(tree);
    const FacetSquare* shown = largest_ramp(tree, squares);
    f.text({900, 146}, "3  A row of texels through a leaf", lettering::head);
    if (shown == nullptr) return;
    const int row = middle_row(tree.edges[shown->node->edge], *shown);
    IntervalParams params;
    params.receivers = Receivers::static_only;
    params.region = {shown->x, row, shown->side, 1};
    const Image<DepthInterval> intervals = interval_map(mesh, view, params, exec);
    double low = 1, high = 0;
    for (int i = 0; i < shown->side; ++i) {
        low = std::min(low, double{intervals(i, 0).entry});
        high = std::max(high, double{intervals(i, 0).entry});
    }
    const double margin = std::max(0.6 * (high - low), 1e-4);
    const Plot plot{
        {930, 170, 620, 380}, 0, static_cast<double>(shown->side), -(high + margin), -(low - 0.3 * margin)};
    f.axes(plot, "texels of the row", "towards the light");
    for (int i = 0; i < shown->side; ++i) {
        const DepthInterval d = intervals(i, 0);
        const Vec2d top = plot.at(i + 0.1, -double{d.entry});
        const Vec2d bottom = plot.at(i + 0.9, std::max(-double{d.exit}, plot.y0));
        f.fill({top.x, top.y, bottom.x - top.x, std::max(bottom.y - top.y, 1.5)}, ink::sky, 0.5);
        const float value = tree_value(encoded.code, static_cast<std::uint32_t>(shown->x + i),
                                       static_cast<std::uint32_t>(row));
        if (-double{value} > plot.y0) f.disc(plot.at(i + 0.5, -double{value}), 3, ink::red);
    }
    f.paragraph(
        {900, 590},
        fmt::format("{} texels of one leaf of a map of {}: depth intervals, from the first surface to the "
                    "next,\nand what is stored. Near the edge the next surface comes close, and the "
                    "offset\nends where it does.",
                    shown->side, texels));
}

// Step 4: bytes.
void draw_bytes(Figure& f, const Mesh& mesh, const Exec& exec) {
    f.text({40, 660}, "4  Bytes as powers of ten, whenever the side doubles", lettering::head);
    const Plot plot{{110, 690, 700, 200}, 8, 13, 4, 7.2};
    level_lines(f, plot, {4, 5, 6, 7});
    std::vector<Vec2d> plain, ours;
    for (int levels = 8; levels <= 13; ++levels) {
        const LightView view = lesson_view(mesh, 1 << levels);
        const auto mh = static_cast<double>(
            encode_tree(build_shadow_tree(mesh, view, lesson_params(), exec), view).bytes);
        const auto facet = static_cast<double>(
            encode_facet(build_facet_tree(mesh, view, lesson_params(), exec), view, {}).bytes);
        plain.push_back(plot.at(levels, decades_of(mh)));
        ours.push_back(plot.at(levels, decades_of(facet)));
        f.text({plot.at(levels, plot.y0).x, plot.box.y + plot.box.h + 20}, fmt::format("{}", 1 << levels),
               lettering::tick);
    }
    f.polyline(plain, {ink::dark, 2});
    f.polyline(ours, {ink::red, 2});
    f.text(plain.back() + Vec2d{10, 4}, "depths");
    f.text(ours.back() + Vec2d{10, 4}, "planes and edges", {9.5, ink::red, Align::left, true});
    f.paragraph({1010, 700},
                "An edge through a square is one leaf at any resolution.\nWhat grows is the way down to the "
                "places where edges meet,\n"
                "and the lines where this town's roofs and walls pierce\neach other, which are no edges of "
                "its mesh: squares there\n"
                "are divided to texels. A tree of depths has twice as many\nnodes along every edge.\n\nWhat "
                "each texel decodes to lies in its interval, as in every\nother code, at every one of "
                "them.");
}

}  // namespace

Image<Rgb8> lesson_25_an_edge_in_a_square(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(
        25, "An edge in a square",
        "A square that one edge crosses is one leaf, however many texels it has: two planes, and the line "
        "between them.");
    const Mesh mesh = lesson_town();
    draw_squares(f, mesh, exec);
    draw_row(f, mesh, exec);
    draw_bytes(f, mesh, exec);
    f.legend({40, 946}, {{Mark::square, ink::green, "a leaf with one value"},
                         {Mark::square, ink::sky, "a leaf with an edge; depth intervals"},
                         {Mark::line, ink::red, "edges, and what is stored"}});
    f.source_line(
        25,
        "hierarchy/facet/facet.h build_facet_tree, encode_facet · hierarchy/facet/facet_step.h FacetCode");
    return f.picture;
}

}  // namespace obscura
