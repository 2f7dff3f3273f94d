#include "lessons/cut.h"

#include <cmath>

#include "core/topology.h"
#include "raster/layers.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

constexpr int texels = 230;

/// The row's texels as floor(position) in a map that is `fine` times as wide.
Layers fine_row(const CutScene& scene, int fine, const Exec& exec) {
    LightView wide = scene.view;
    wide.width *= fine;
    for (double& entry : wide.to_map.m[0])
        entry *= fine;
    return layers_of(scene.mesh, wide, {0, scene.row, wide.width, 1}, exec);
}

Rgb8 solid_color(int counter) {
    constexpr Rgb8 one{201, 211, 222}, many{96, 116, 142};
    return counter == 0 ? ink::panel : mix(one, many, (counter - 1) * 0.5);
}

}  // namespace

CutScene cut_scene() {
    CutScene scene;
    const auto add = [&](const Mesh& part, const Affine& move) {
        Mesh placed;
        add_part(placed, part, move);
        analyse_topology(placed);
        append_mesh(scene.mesh, placed);
    };
    add(box({-10, 0, -1.5}, {8.2, 0.6, 1.5}), Affine{});  // the slab
    add(sphere(1.5, 32, 16), translation(-8, 2.5, 0));
    add(box({1.2, 1.1, 1.2}), translation(-8, 2.5, 0));
    add(box({-5.7, 1.4, -1}, {-3.3, 2.5, 1}), Affine{});
    add(box({-5.1, 2.5, -0.6}, {-3.9, 3.6, 0.6}), Affine{});
    add(sphere(1.1, 32, 16), translation(-0.7, 2.4, 0.2));
    add(box({1.6, 1.6, 1.6}), translation(0.5, 2.5, 0) * rotation_z(30));
    add(cylinder(0.7, 1.9, 32), translation(3.3, 0.6, 0));
    add(plane(4.9, 2.4), translation(7.4, 3.1, 0) * rotation_z(-9));
    scene.view = orthographic_light_view(bounds_of(scene.mesh), {0, -1, 0}, texels);
    scene.row = texels / 2;
    return scene;
}

std::vector<CutRay> cut_rays(const CutScene& scene) {
    const auto at = [&](double x) {
        return static_cast<int>(std::floor(to_map_space(scene.view, {x, 0, 0}).x));
    };
    return {{"nested", at(-8.35)},           {"touching", at(-4.6)}, {"slab alone", at(-2.5)},
            {"interpenetrating", at(-0.15)}, {"standing", at(3.2)},  {"sheet, slab", at(6.2)},
            {"sheet alone", at(9.0)}};
}

Vec2d in_cut(const CutScene& scene, const Box& box, double X, double depth) {
    return {box.x + box.w * X / scene.view.width, box.y + box.h * depth};
}

void draw_cut(Figure& figure, const CutScene& scene, const Box& box, double strength, const Exec& exec) {
    constexpr int shrink = 2, pen = 2;  // two pixels for each of the figure's, lines two of them wide
    const int width = static_cast<int>(box.w) * shrink, height = static_cast<int>(box.h) * shrink;
    const Layers layers = fine_row(scene, width / scene.view.width, exec);
    CHECK(layers.region.width == width);
    Image<int> counter(width, height, 0);
    for (int x = 0; x < width; ++x) {
        for (const LayerCrossing& c : layers.at(x, scene.row)) {
            const int step = c.crossing == Crossing::entry ? 1 : c.crossing == Crossing::exit ? -1 : 0;
            for (int y = static_cast<int>(c.depth * static_cast<float>(height)); y < height; ++y)
                counter(x, y) += step;
        }
    }
    Image<Rgb8> fine(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // Walls that no ray crosses, as the light sees them edge-on, show as a change from left to right.
            const bool wall = counter(x, y) != counter(std::min(x + pen, width - 1), y);
            fine(x, y) = wall ? ink::soft : solid_color(counter(x, y));
        }
    }
    for (int x = 0; x < width; ++x) {
        for (const LayerCrossing& c : layers.at(x, scene.row)) {
            const bool sheet = c.crossing == Crossing::open;
            const int y = static_cast<int>(c.depth * static_cast<float>(height)), half = sheet ? 3 : 1;
            for (int i = std::max(y - half, 0); i < std::min(y + half, height); ++i)
                fine(x, i) = sheet ? ink::green : ink::soft;
        }
    }
    for (Rgb8& p : fine.pixels)
        p = mix(ink::panel, p, strength);
    figure.image(static_cast<int>(box.x), static_cast<int>(box.y), fine, shrink);
}

}  // namespace obscura
