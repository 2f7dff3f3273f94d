#pragma once
// Random solids and sheets for the interval tests.

#include <random>

#include "core/mesh.h"
#include "core/topology.h"
#include "scenes/shapes.h"

namespace obscura::solids {

/// Rotation about a unit axis by a rational angle: c + s^2 = 1 exactly enough, no trigonometry.
inline Affine rotation(Vec3d axis, double t) {
    const double c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t), k = 1 - c;
    const Vec3d u = normalize(axis);
    return {{{c + u.x * u.x * k, u.x * u.y * k - u.z * s, u.x * u.z * k + u.y * s, 0},
             {u.y * u.x * k + u.z * s, c + u.y * u.y * k, u.y * u.z * k - u.x * s, 0},
             {u.z * u.x * k - u.y * s, u.z * u.y * k + u.x * s, c + u.z * u.z * k, 0}}};
}

inline Mesh moved(Mesh mesh, const Affine& map) {
    for (Vec3f& p : mesh.positions)
        p = to_float(transform_point(map, to_double(p)));
    return mesh;
}

inline Mesh shifted(Mesh mesh, Vec3d by) {
    Affine map;
    map.m[0][3] = by.x;
    map.m[1][3] = by.y;
    map.m[2][3] = by.z;
    return moved(std::move(mesh), map);
}

/// Turns every triangle over.
inline Mesh flipped(Mesh mesh) {
    for (Triangle& t : mesh.triangles)
        std::swap(t.v[1], t.v[2]);
    return mesh;
}

/// Analyses `part` on its own, then appends it.
inline void add(Mesh& to, Mesh part) {
    analyse_topology(part);
    append_mesh(to, part);
}

/// Boxes and spheres that touch, nest, coincide and interpenetrate, with some open sheets and flipped solids.
inline Mesh random_solids(std::uint32_t seed, int count, bool open_sheets, bool flips) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> place(-4, 4), size(0.05, 2.5), turn(-1, 1);
    std::uniform_int_distribution<int> kind(0, 9);
    Mesh all;
    for (int i = 0; i < count; ++i) {
        const int k = kind(rng);
        Mesh part;
        if (k < 5) {
            part = box({size(rng), size(rng), size(rng)});
        } else if (k < 7) {
            part = sphere(size(rng) * 0.6, 12, 7);
        } else if (k == 7 && open_sheets) {
            part = plane(size(rng) * 2, size(rng) * 2, 2, 2);
        } else {
            // On a coarse grid and unturned, so that faces touch and coincide exactly.
            const auto grid = [&] { return std::floor(place(rng)); };
            const Vec3d low{grid(), grid(), grid()};
            add(all, box(low, low + Vec3d{1, 1, 1}));
            if (i % 3 == 0) add(all, box(low, low + Vec3d{1, 1, 1}));
            continue;
        }
        Affine map = rotation({turn(rng), turn(rng), turn(rng) + 0.1}, turn(rng));
        map.m[0][3] = place(rng);
        map.m[1][3] = place(rng);
        map.m[2][3] = place(rng);
        part = moved(std::move(part), map);
        if (flips && i % 7 == 0) part = flipped(std::move(part));
        add(all, std::move(part));
    }
    return all;
}

}  // namespace obscura::solids
