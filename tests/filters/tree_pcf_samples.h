#pragma once
// Receivers whose place on the map is chosen, not rendered.

#include <random>
#include <vector>

#include "core/image.h"
#include "filters/pcf.h"
#include "hierarchy/multires.h"
#include "raster/shadow_map.h"

namespace obscura::chosen {

/// A light straight from above the map: texel = world x, y; depth = -world z. Planes tilt it by their
/// normals.
inline PcfLight light_above(int size, int side, bool parallel) {
    PcfLight light;
    light.side = side;
    light.directional = parallel;
    light.to_light[0] = light.to_light[1] = 0;
    light.to_light[2] = 1;
    light.position[0] = light.position[1] = 0.5f * static_cast<float>(size);
    light.position[2] = 1e6f;
    PcfView& view = light.view[0];
    view = {};
    view.to_map[0][0] = view.to_map[1][1] = view.to_map[3][3] = 1;
    view.to_map[2][2] = -1;
    view.size = size;
    // The plane x nx + y ny + z nz = c has dz/dx = -nx / nz, and depth is -z.
    view.slope_x[0] = 1;
    view.slope_y[1] = 1;
    return light;
}

/// Blocks of covered samples at these places, with normals that tilt by up to `tilt`.
struct Place {
    float x, y, depth;
};
inline std::vector<SurfaceBlock> blocks_at(const std::vector<Place>& places, float tilt, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> lean(-tilt, tilt);
    std::vector<SurfaceBlock> blocks((places.size() + block_samples - 1) / block_samples);
    for (std::size_t i = 0; i < blocks.size() * block_samples; ++i) {
        SurfaceBlock& b = blocks[i / block_samples];
        const auto at = static_cast<int>(i % block_samples);
        if (at == 0) b = SurfaceBlock{};
        if (i >= places.size()) continue;
        b.covered[at / 16] |= 1u << (at % 16);
        b.px[at] = places[i].x;
        b.py[at] = places[i].y;
        b.pz[at] = -places[i].depth;
        // Neighbours mostly lie on one plane.
        const Vec3f n = normalize(Vec3f{lean(rng), lean(rng), 1});
        const bool own = at % 16 == 0 || rng() % 8 == 0;
        b.gx[at] = own ? n.x : b.gx[at - 1];
        b.gy[at] = own ? n.y : b.gy[at - 1];
        b.gz[at] = own ? n.z : b.gz[at - 1];
    }
    return blocks;
}

/// Every texel of the map and three around it, at several places of the texel, row by row; then anywhere.
/// Some lie beyond the depth range.
inline std::vector<Place> places_everywhere(int size, std::uint32_t seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<float> within(0, 1);
    std::vector<Place> places;
    for (int y = -3; y < size + 3; ++y) {
        for (int x = -3; x < size + 3; ++x) {
            for (int k = 0; k < 2; ++k) {
                places.push_back({static_cast<float>(x) + within(rng), static_cast<float>(y) + within(rng),
                                  static_cast<float>(rng() % 36) / 32.0f});
            }
        }
    }
    for (int k = 0; k < 1000; ++k) {
        places.push_back({within(rng) * static_cast<float>(size), within(rng) * static_cast<float>(size),
                          static_cast<float>(rng() % 36) / 32.0f});
    }
    return places;
}

/// Mostly two depths, detail here and there: large nodes and small ones.
inline Image<DepthInterval> patchy_intervals(int size, std::uint32_t seed) {
    std::mt19937 rng(seed);
    Image<DepthInterval> map(size, size, DepthInterval{0.5f, 0.9f});
    for (int k = 0; k < size / 4; ++k) {
        const int w = 1 << rng() % 4, x0 = static_cast<int>(rng()) & (size - 1),
                  y0 = static_cast<int>(rng()) & (size - 1);
        const auto entry = static_cast<float>(rng() % 28) / 32.0f;
        for (int y = y0; y < std::min(y0 + w, size); ++y) {
            for (int x = x0; x < std::min(x0 + w, size); ++x)
                map(x, y) = {entry, entry + 0.05f};
        }
    }
    return map;
}

/// The dense map of size / 2^level squares a side that `value(x, y)` fills.
template <class Value>
StoredDepths dense(int size, Value&& value) {
    StoredDepths map;
    map.size = size;
    map.depth.reset(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x)
            map.depth[map.index(x, y)] = value(x, y);
    }
    return map;
}

}  // namespace obscura::chosen
