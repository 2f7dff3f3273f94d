#pragma once
// Scenes under area lights, points that ask for light there, and a stack of both.

#include <cstdint>
#include <random>
#include <vector>

#include "core/topology.h"
#include "hierarchy/stack/stack.h"
#include "hierarchy/stack/visible_share.h"
#include "scenes/shapes.h"
#include "tests/raster/raster_solids.h"

namespace obscura::lit {

/// Which light stands over a scene.
enum class Lamp { level, tilted, sun, path };

inline LightSamples samples_of(Lamp lamp, int count) {
    switch (lamp) {
        case Lamp::level:
            return parallelogram_samples({1, 14, -2}, {3, 0, 0}, {0, 0, 3}, count);
        case Lamp::tilted:
            return parallelogram_samples({6, 12, 1}, {2, -1.5, 0}, {0.5, 0, 2.5}, count);
        case Lamp::sun:
            return sun_samples({0.5, -1, 0.3}, 2, count);
        default:
            break;
    }
    LightSamples path;
    path.directional = true;
    for (int k = 0; k < count; ++k) {
        const double t = 3.0 * (k + 0.5) / count - 1.5;
        path.at.push_back(normalize(Vec3d{t, -1, 0.2 + 0.1 * t * t}));
    }
    return path;
}

/// Solids on and over a slab of ground, 24 m wide.
inline Mesh scene(std::uint32_t seed, bool open) {
    Mesh mesh = solids::random_solids(seed, 20, open, false);
    for (Vec3f& p : mesh.positions)
        p.y = p.y * 0.5f + 2.5f;
    solids::add(mesh, solids::shifted(box({24, 0.5, 24}), {0, -0.25, 0}));
    return mesh;
}

inline FocusParams focus(int resolution) {
    FocusParams params;
    params.resolution = resolution;
    return params;
}

/// Points with normals: of the ground, in the air, on faces, in and behind the light, and off the map.
struct Points {
    std::vector<float> px, py, pz, nx, ny, nz;
    std::vector<std::uint16_t> pattern;

    void add(Vec3d p, Vec3d n, std::uint32_t at) {
        px.push_back(static_cast<float>(p.x));
        py.push_back(static_cast<float>(p.y));
        pz.push_back(static_cast<float>(p.z));
        nx.push_back(static_cast<float>(n.x));
        ny.push_back(static_cast<float>(n.y));
        nz.push_back(static_cast<float>(n.z));
        pattern.push_back(static_cast<std::uint16_t>(at * 0x9e37u >> 3));
    }
    StackPoints view() const {
        return {px.data(), py.data(), pz.data(), nx.data(), ny.data(), nz.data(), pattern.data(), px.size()};
    }
};

inline Points drawn_points(const Mesh& mesh, Vec3d eye, int count, std::uint32_t seed) {
    std::mt19937 rng(seed);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(rng()) / 4294967296.0);
    };
    Points points;
    for (int i = 0; i < count; ++i) {
        Vec3d p{uniform(-13, 13), 0, uniform(-13, 13)};
        Vec3d n{0, 1, 0};
        if (i % 4 == 1) {
            // Some of them far beyond what casts.
            p = Vec3d{uniform(-30, 30), uniform(i % 16 == 5 ? -400 : -4, 20), uniform(-30, 30)};
            n = normalize(Vec3d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
        } else if (i % 4 != 0) {
            const Triangle& t = mesh.triangles[rng() % mesh.triangles.size()];
            const Vec3d a = to_double(mesh.positions[t.v[0]]), b = to_double(mesh.positions[t.v[1]]),
                        c = to_double(mesh.positions[t.v[2]]);
            const double u = uniform(0, 1), v = uniform(0, 1 - u);
            p = a + (b - a) * u + (c - a) * v;
            n = normalize(cross(b - a, c - a));
        }
        points.add(p - eye, n, static_cast<std::uint32_t>(i));
    }
    return points;
}

/// A grid of points on the ground.
inline Points ground_points(int side, double half_m) {
    Points points;
    for (int i = 0; i < side * side; ++i) {
        const auto at = [&](int k) { return half_m * ((k + 0.5) * 2 / side - 1); };
        points.add({at(i % side), 0, at(i / side)}, {0, 1, 0}, static_cast<std::uint32_t>(i));
    }
    return points;
}

}  // namespace obscura::lit
