// Lesson 7. Straight from triangles: a construction whose work follows its result.
//
// You learn: rasterizing N x N texels to throw most of them away costs N x N; so the construction goes down
// from the root with lists of triangles (J. Warnock, "A Hidden Surface Algorithm for Computer Generated
// Halftone Pictures", 1969) and stops at a square as soon as the one interval of all its texels is certain.
// What it finds is bit for bit what lesson 5 builds from all texels.
//
// Calls: hierarchy/build.h build_shadow_tree with BuildParams::trace, hierarchy/multires.h build_bottom_up.

#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/build.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/tree_scene.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

constexpr int drawn_texels = 1024;

using Fate = decltype(BuildSquare::fate);

Rgb8 fate_color(Fate fate) {
    switch (fate) {
        case BuildSquare::cover:
            return ink::sky;
        case BuildSquare::mesh:
            return ink::green;
        case BuildSquare::rasterized:
            return ink::red;
        case BuildSquare::nothing:
            return ink::panel;
        default:
            return ink::paper;
    }
}

// Step 1: the construction tells what became of every square it visited.
struct Traced {
    std::vector<BuildSquare> squares;
    BuildStats stats;
};
Traced trace_of(const Mesh& mesh, int texels, const Exec& exec) {
    Traced traced;
    BuildParams params;
    params.trace = &traced.squares;
    build_shadow_tree(mesh, lesson_view(mesh, texels), params, exec, &traced.stats);
    return traced;
}

// What it builds must be what lesson 5 builds from all texels.
void check_equal(const Mesh& mesh, int texels, const Exec& exec) {
    const LightView view = lesson_view(mesh, texels);
    const MultiresTree tree = build_shadow_tree(mesh, view, {}, exec);
    const MultiresTree all = build_bottom_up(interval_map(mesh, view, {}, exec).view());
    CHECK(count_nodes(tree) == count_nodes(all));
    for (int i = 0; i < texels; ++i) {
        const auto x = static_cast<std::uint32_t>(i), y = static_cast<std::uint32_t>(i * 7 % texels);
        CHECK(value_at(tree, x, y) == value_at(all, x, y));
    }
}

// Step 2: the squares where the recursion stopped.
void draw_squares(Figure& f, const Traced& traced, const char* name, const Box& box) {
    const BuildStats& stats = traced.stats;
    const double scale = box.w / drawn_texels;
    for (const BuildSquare& s : traced.squares) {
        if (s.fate == BuildSquare::divided) continue;
        const Box square{box.x + s.x0 * scale, box.y + s.y0 * scale, s.side * scale, s.side * scale};
        f.fill(square, fate_color(s.fate));
        if (square.w > 6) f.frame(square, {ink::paper, 1});
    }
    f.frame(box, {ink::soft, 1});
    f.text({box.x, box.y - 12}, name, lettering::head);
    constexpr double all = static_cast<double>(drawn_texels) * drawn_texels;
    f.paragraph(
        {box.x, box.y + box.h + 26},
        fmt::format(
            "{} squares visited, {} certain by a plane, {} by a mesh;\n{:.1f} % of {} x {} texels rasterized",
            stats.nodes_visited, stats.certified_cover, stats.certified_mesh,
            100 * static_cast<double>(stats.texels_rasterized) / all, drawn_texels, drawn_texels));
}

// Step 3: the work for larger and larger maps.
void draw_work(Figure& f, const Mesh& mesh, const Traced& traced, const Box& box, const Exec& exec) {
    double y = box.y;
    for (int n = 128; n <= 2048; n *= 2) {
        BuildStats stats = traced.stats;
        if (n != drawn_texels) build_shadow_tree(mesh, lesson_view(mesh, n), {}, exec, &stats);
        const double share = static_cast<double>(stats.texels_rasterized) / (static_cast<double>(n) * n);
        f.text({box.x + 52, y + 16}, fmt::format("{}", n), lettering::right);
        f.fill({box.x + 62, y + 4, box.w - 62, 14}, ink::panel);
        f.fill({box.x + 62, y + 4, (box.w - 62) * share, 14}, ink::red);
        f.text({box.x + 70 + (box.w - 62) * share, y + 16}, fmt::format("{:.1f} %", 100 * share),
               {9, ink::dark, Align::left, false, true});
        y += 26;
    }
}

}  // namespace

Image<Rgb8> lesson_7_recursion(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(7, "Straight from triangles",
              "Go down with lists of triangles; stop where one interval is certain. Equal, bit for bit, to "
              "rasterizing everything.");
    const Mesh town = lesson_town(), solids = lesson_solids();
    check_equal(town, 256, exec);
    check_equal(solids, 256, exec);
    const Traced of_town = trace_of(town, drawn_texels, exec),
                 of_solids = trace_of(solids, drawn_texels, exec);
    draw_squares(f, of_town, "A town: large faces", {40, 170, 560, 560});
    draw_squares(f, of_solids, "Smooth solids: triangles smaller than squares", {630, 170, 560, 560});
    f.text({1220, 158}, "Texels rasterized, of all", lettering::head);
    f.text({1220, 188}, "town, map of N x N", lettering::bold);
    draw_work(f, town, of_town, {1220, 200, 300, 140}, exec);
    f.text({1220, 366}, "smooth solids", lettering::bold);
    draw_work(f, solids, of_solids, {1220, 378, 300, 140}, exec);
    f.text({1220, 552}, "When is a square certain?", lettering::head);
    f.paragraph(
        {1220, 580},
        "By a plane: every triangle that matters\ncovers the whole square, and the order\nof the planes is "
        "the same at its four\ncorners. Depth planes are monotone,\nso corners hold the extremes.\n \n"
        "By a mesh: one texel is covered, no\noutline crosses the square, and the\nlatest entry lies before "
        "the first exit.\n \nElse: divide. Squares of 8 x 8 texels,\nand larger ones where triangles are "
        "so\nsmall that lists cost more than texels,\nare rasterized.");
    f.legend({40, 930},
             {{Mark::square, fate_color(BuildSquare::cover), "certain: single planes cover it"},
              {Mark::square, fate_color(BuildSquare::mesh), "certain: a surface of several triangles"},
              {Mark::square, fate_color(BuildSquare::rasterized), "not certain in time: rasterized"},
              {Mark::square, fate_color(BuildSquare::nothing), "nothing there"}});
    f.source_line(
        7, "hierarchy/build.h build_shadow_tree BuildParams::trace · hierarchy/multires.h build_bottom_up");
    return f.picture;
}

}  // namespace obscura
