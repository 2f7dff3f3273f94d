#pragma once
// Trees to encode: random ones, ones from solids, and the extremes.

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/image.h"
#include "hierarchy/multires.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/raster/raster_solids.h"

namespace obscura {

struct TreeSample {
    std::string name;
    MultiresTree tree;
};

/// Few distinct depths: intervals that often agree, whose bounds coincide and tie.
inline Image<DepthInterval> random_interval_map(std::uint32_t seed, int side) {
    std::mt19937 rng(seed);
    std::uniform_int_distribution<int> step(0, 12);
    Image<DepthInterval> map(side, side);
    for (DepthInterval& i : map.pixels) {
        const int entry = step(rng), exit = entry + step(rng) / 3;
        i = {static_cast<float>(entry) / 16.0f, static_cast<float>(exit) / 16.0f};
    }
    return map;
}

/// No two texels agree: the tree has every node that it can have.
inline Image<DepthInterval> distinct_interval_map(int side) {
    Image<DepthInterval> map(side, side);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const float depth = static_cast<float>(i) / static_cast<float>(map.pixels.size());
        map.pixels[i] = {depth, depth};
    }
    return map;
}

/// One corner full of detail, three quarters without: blocks of very different size side by side.
inline Image<DepthInterval> lopsided_interval_map(int side) {
    Image<DepthInterval> map(side, side);
    const Image<DepthInterval> corner = distinct_interval_map(side / 2);
    for (int y = 0; y < side / 2; ++y) {
        for (int x = 0; x < side / 2; ++x)
            map(x, y) = corner(x, y);
    }
    map(side - 1, side - 1) = {0.25f, 0.5f};
    map(side - 1, 3) = {0.125f, 0.25f};
    return map;
}

inline Image<DepthInterval> solid_interval_map(std::uint32_t seed, int side, bool open) {
    const Mesh mesh = solids::random_solids(seed, 40, open, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), side);
    return interval_map(mesh, view, {}, Exec{});
}

inline std::vector<TreeSample> tree_samples() {
    const Image<DepthInterval> texel(1, 1, {0.25f, 0.5f}), background(64, 64);
    std::vector<TreeSample> samples{
        {"one texel", build_bottom_up(texel.view())},
        {"background", build_bottom_up(background.view())},
        {"two by two", build_bottom_up(random_interval_map(5, 2).view())},
        {"distinct 64", build_bottom_up(distinct_interval_map(64).view())},
        {"distinct 256", build_bottom_up(distinct_interval_map(256).view())},
        {"lopsided 128", build_bottom_up(lopsided_interval_map(128).view())},
        {"top down 64", build_top_down(random_interval_map(9, 64).view())},
    };
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        samples.push_back({"random 128", build_bottom_up(random_interval_map(seed, 128).view())});
        samples.push_back(
            {"solids 256", build_bottom_up(solid_interval_map(seed, 256, seed % 2 == 0).view())});
    }
    return samples;
}

/// A view that the file format takes for a tree of these levels.
inline LightView any_view(int levels) {
    LightView view;
    view.width = view.height = 1 << levels;
    return view;
}

}  // namespace obscura
