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
#include "core/topology.h"
#include "hierarchy/build.h"
#include "lessons/figure.h"
#include "lessons/ladder.h"
#include "lessons/tree_scene.h"
#include "raster/interval_map.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

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
std::vector<BuildSquare> trace_of(const Mesh& mesh, int texels, const Exec& exec, BuildStats& stats) {
    std::vector<BuildSquare> trace;
    BuildParams params;
    params.trace = &trace;
    build_shadow_tree(mesh, lesson_view(mesh, texels), params, exec, &stats);
    return trace;
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
void draw_squares(Figure& f, const Mesh& mesh, const char* name, int texels, const Box& box,
                  const Exec& exec) {
    BuildStats stats;
    const std::vector<BuildSquare> trace = trace_of(mesh, texels, exec, stats);
    const double scale = box.w / texels;
    for (const BuildSquare& s : trace) {
        if (s.fate == BuildSquare::divided) continue;
        const Box square{box.x + s.x0 * scale, box.y + s.y0 * scale, s.side * scale, s.side * scale};
        f.fill(square, fate_color(s.fate));
        if (square.w > 6) f.frame(square, {ink::paper, 1});
    }
    f.frame(box, {ink::soft, 1});
    f.text({box.x, box.y - 12}, name, lettering::head);
    const double all = static_cast<double>(texels) * texels;
    f.paragraph(
        {box.x, box.y + box.h + 26},
        fmt::format(
            "{} squares visited, {} certain by a plane, {} by a mesh;\n{:.1f} % of {} x {} texels rasterized",
            stats.nodes_visited, stats.certified_cover, stats.certified_mesh,
            100 * static_cast<double>(stats.texels_rasterized) / all, texels, texels));
}

// Step 3: the work for larger and larger maps.
void draw_work(Figure& f, const Mesh& mesh, const char* name, const Box& box, const Exec& exec) {
    f.text({box.x, box.y - 12}, name, lettering::bold);
    double y = box.y;
    for (int n = 128; n <= 2048; n *= 2) {
        BuildStats stats;
        build_shadow_tree(mesh, lesson_view(mesh, n), {}, exec, &stats);
        const double share = static_cast<double>(stats.texels_rasterized) / (static_cast<double>(n) * n);
        f.text({box.x + 52, y + 16}, fmt::format("{}", n), lettering::right);
        f.fill({box.x + 62, y + 4, box.w - 62, 14}, ink::panel);
        f.fill({box.x + 62, y + 4, (box.w - 62) * share, 14}, ink::red);
        f.text({box.x + 70 + (box.w - 62) * share, y + 16}, fmt::format("{:.1f} %", 100 * share),
               {9, ink::dark, Align::left, false, true});
        y += 26;
    }
}

/// A ball and a ring over a slab: surfaces of many small triangles.
Mesh smooth_solids() {
    Mesh mesh = box({-4, -0.6, -4}, {4, 0, 4});
    add_part(mesh, sphere(1.7, 160, 80), translation(-1.1, 2.0, -0.7));
    add_part(mesh, torus(1.3, 0.5, 160, 64), translation(1.9, 1.6, 1.5) * rotation_x(50));
    analyse_topology(mesh);
    return mesh;
}

}  // namespace

Image<Rgb8> lesson_7_recursion(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(7, "Straight from triangles",
              "Go down with lists of triangles; stop where one interval is certain. Equal, bit for bit, to "
              "rasterizing everything.");
    const Mesh town = lesson_town(), solids = smooth_solids();
    check_equal(town, 256, exec);
    check_equal(solids, 256, exec);
    draw_squares(f, town, "A town: large faces", 1024, {40, 170, 560, 560}, exec);
    draw_squares(f, solids, "Smooth solids: triangles smaller than squares", 1024, {630, 170, 560, 560},
                 exec);
    f.text({1220, 158}, "Texels rasterized, of all", lettering::head);
    draw_work(f, town, "town, map of N x N", {1220, 200, 300, 140}, exec);
    draw_work(f, solids, "smooth solids", {1220, 378, 300, 140}, exec);
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
