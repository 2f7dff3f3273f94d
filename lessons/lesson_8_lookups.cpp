// Lesson 8. Lookups: a kernel goes down the tree together.
//
// You learn: a lookup costs a step per level that the tree has there; the 25 texels of a kernel have most of
// their way in common, down to the node that the leading zeros of their XORed coordinates name; and where the
// tree ends before that, one value holds for all. L. Scandolo, P. Bauszat, E. Eisemann, "Compressed
// Multiresolution Hierarchies for High-Quality Precomputed Shadows", Eurographics 2016, section 3.3,
// figure 6.
//
// Calls: hierarchy/build.h build_shadow_tree, hierarchy/codes/codes.h encode_tree, filters/shadow_lookup.h
//        pcf_light, pcf_steps, pcf_place.

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/parallel.h"
#include "filters/shadow_lookup.h"
#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "lessons/seen_surfaces.h"
#include "lessons/tree_panels.h"
#include "lessons/tree_scene.h"

namespace obscura {
namespace {

constexpr int map_texels = 2048;
constexpr int seen_width = 7 * frame_tile_side, seen_height = 4 * frame_tile_side;

// Step 1: the steps of every pixel's kernel.
std::vector<ref::PcfSteps> steps_of(const std::vector<SurfaceBlock>& blocks, const PcfLight& light,
                                    const Exec& exec) {
    std::vector<ref::PcfSteps> steps(blocks.size() * block_samples);
    parallel_for(blocks.size(), exec, [&](std::size_t b) {
        for (int at = 0; at < block_samples; ++at)
            steps[b * block_samples + static_cast<std::size_t>(at)] = ref::pcf_steps(blocks[b], light, at);
    });
    return steps;
}

/// Place on the colour scale: by the square root, so that few steps stay apart.
double share_of(int steps, int most) {
    return std::sqrt(static_cast<double>(steps) / most);
}

// Step 2: the picture, naive below the diagonal, shared above it.
void draw_steps(Figure& f, const std::vector<SurfaceBlock>& blocks, const std::vector<ref::PcfSteps>& steps,
                int most, Vec2d origin) {
    const Cells cells{origin, 2, seen_width, seen_height};
    const auto sun = to_float(-lesson_sun());
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const auto [x, y] = seen_pixel(i, seen_width);
        const bool below = y * seen_width > x * seen_height;
        const SurfaceBlock& s = blocks[i / block_samples];
        const auto at = static_cast<int>(i % block_samples);
        const float facing = s.gx[at] * sun.x + s.gy[at] * sun.y + s.gz[at] * sun.z;
        const bool covered = (s.covered[at / 16] >> (at % 16) & 1u) != 0;
        Rgb8 color =
            covered ? mix(ink::grey, ink::dark, 0.35 - 0.3 * static_cast<double>(facing)) : ink::panel;
        if (steps[i].naive > 0) color = heat(share_of(below ? steps[i].naive : steps[i].shared, most));
        f.fill(cells.cell(x, y), color);
    }
    f.line(cells.at(0, 0), cells.at(cells.columns, cells.rows), {ink::paper, 2});
    f.text(cells.at(6, cells.rows - 6), "every tap from the root", {11.5, ink::paper, Align::left, true});
    f.text(cells.at(cells.columns - 6, 14), "shared", {11.5, ink::dark, Align::right, true, true});
    f.frame(cells.box(), {ink::soft, 1});
    for (int i = 0; i < 200; ++i)
        f.fill({origin.x + 100 + i, cells.box().y + cells.box().h + 18, 1.2, 14}, heat(i / 199.0));
    const double y = cells.box().y + cells.box().h + 30;
    f.text({origin.x + 90, y}, "0 nodes", lettering::right);
    f.text({origin.x + 310, y},
           fmt::format("{} for a kernel of 5 x 5; its middle is a quarter · grey: not looked up", most));
}

// Step 3: mean steps for kernels of several sides.
void draw_means(Figure& f, const std::vector<SurfaceBlock>& blocks, const std::vector<ref::PcfSteps>& steps,
                PcfLight light, const Box& box, const Exec& exec) {
    double y = box.y;
    for (const int side : {1, 3, 5}) {
        light.side = side;
        double naive = 0, shared = 0, count = 0;
        const std::vector<ref::PcfSteps> others = side == 5 ? steps : steps_of(blocks, light, exec);
        for (const ref::PcfSteps& s : others) {
            if (s.naive == 0) continue;
            naive += s.naive;
            shared += s.shared;
            ++count;
        }
        const double scale = (box.w - 170) / 220.0;
        f.text({box.x, y + 16}, fmt::format("{} x {}", side, side), lettering::bold);
        f.fill({box.x + 60, y, naive / count * scale, 12}, ink::red);
        f.text({box.x + 66 + naive / count * scale, y + 10}, fmt::format("{:.1f}", naive / count), {8.5});
        f.fill({box.x + 60, y + 15, shared / count * scale, 12}, ink::blue);
        f.text({box.x + 66 + shared / count * scale, y + 26},
               side == 1 ? fmt::format("{:.1f}: the same", shared / count)
                         : fmt::format("{:.1f}: {:.1f} times fewer", shared / count, naive / shared),
               {8.5});
        y += 46;
    }
}

}  // namespace

Image<Rgb8> lesson_8_lookups(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(
        8, "Lookups",
        "Nodes visited to filter a shadow: each texel of the kernel from the root, or all of them together.");
    const Mesh mesh = lesson_town();
    const LightView view = lesson_view(mesh, map_texels);
    const MultiresTree built = build_shadow_tree(mesh, view, {}, exec);
    const ShadowTree tree = encode_tree(built, view);
    Camera camera;
    camera.eye = {-95, 62, 110};
    camera.look_at = {0, 0, 0};
    camera.vfov_deg = 30;
    const std::vector<SurfaceBlock> blocks =
        seen_surfaces(SeenMesh(mesh), camera, seen_width, seen_height, exec);
    Light sun;
    sun.direction = lesson_sun();
    PcfLight light = pcf_light(sun, {}, std::span(&tree, 1), camera.eye);
    light.side = 5;
    const std::vector<ref::PcfSteps> steps = steps_of(blocks, light, exec);
    draw_steps(f, blocks, steps, 25 * (tree.code.levels + 1), {40, 170});

    f.text({980, 158}, "Where the ways of a kernel part", lettering::head);
    // Step 4: one kernel on the map.
    const Vec2d kernel = telling_kernel(blocks, steps, light);
    draw_kernel(f, squares_of(built), static_cast<int>(kernel.x), static_cast<int>(kernel.y),
                {{980, 182}, 11.5, 48, 36});
    f.text({980, 712}, "Mean number of nodes per pixel", lettering::head);
    draw_means(f, blocks, steps, light, {980, 740, 580, 140}, exec);
    f.legend({980, 896}, {{Mark::square, ink::red, "from the root"}, {Mark::square, ink::blue, "shared"}});
    f.paragraph(
        {40, 780},
        "Where a face is far from any outline, the way down ends after a few levels: one value for all 25.\n"
        "Along the outlines of shadows and of steps the tree goes down to the texels: from the root that\n"
        "is 25 times the whole way; together it is the way once, and from texel to texel the last levels.\n"
        "Both give the same bits, wherever the kernel lies.");
    f.source_line(8,
                  "filters/shadow_lookup.h pcf_steps pcf_place · hierarchy/build.h build_shadow_tree · "
                  "hierarchy/codes/codes.h encode_tree");
    return f.picture;
}

}  // namespace obscura
