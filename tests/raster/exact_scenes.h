#pragma once
// Scenes for exact shadows, drawn at random, in which strangers' meshes differ from solids apart from one
// another.

#include <cmath>
#include <random>

#include "core/mesh.h"
#include "core/scene.h"
#include "core/topology.h"

namespace obscura::exact_scenes {

struct Source {
    std::mt19937 bits;
    explicit Source(unsigned seed) : bits(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits()) / 4294967296.0);
    }
    int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }
    Vec3d in(double low, double high) { return {between(low, high), between(low, high), between(low, high)}; }
};

inline void add_triangle(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& v : {a, b, c})
        mesh.positions.push_back(to_float(v));
    mesh.triangles.push_back({{first, first + 1, first + 2}});
}

inline void add_quad(Mesh& mesh, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

inline void add_box(Mesh& mesh, Vec3d low, Vec3d high, bool inside_out = false) {
    const auto at = [&](int k) {
        return Vec3d{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                     (k & 4) != 0 ? high.z : low.z};
    };
    constexpr int side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& s : side) {
        if (inside_out) {
            add_quad(mesh, at(s[3]), at(s[2]), at(s[1]), at(s[0]));
        } else {
            add_quad(mesh, at(s[0]), at(s[1]), at(s[2]), at(s[3]));
        }
    }
}

/// Scenes in which strangers' meshes differ from solids apart from one another.
inline Mesh draw_mesh(Source& source, double unit, Vec3d origin) {
    Mesh mesh;
    const auto place = [&](double x, double y, double z) { return origin + Vec3d{x, y, z} * unit; };
    const auto anywhere = [&] {
        return place(source.between(0, 3), source.between(0, 3), source.between(0, 3));
    };
    switch (source.below(7)) {
        case 0:  // Boxes in the cells of a lattice: faces, edges, corners in common.
            for (int n = 0; n < 8; ++n) {
                const int i = source.below(3), j = source.below(3), k = source.below(3);
                add_box(mesh, place(i, j, k), place(i + 1, j + 1, k + 1), source.below(8) == 0);
            }
            break;
        case 1:  // Boxes in boxes, some inside out.
            for (int n = 0; n < 6; ++n) {
                const double inset = 0.25 * n;
                add_box(mesh, place(inset, inset, inset), place(3 - inset, 3 - inset, 3 - inset),
                        source.below(2) == 0);
            }
            break;
        case 2:  // Sheets twice, back to back or the same way round, and others a hair apart.
            for (int n = 0; n < 10; ++n) {
                const Vec3d a = anywhere(), b = anywhere(), c = anywhere();
                const Vec3d apart = source.below(2) == 0 ? Vec3d{} : source.in(-1e-6, 1e-6) * unit;
                add_triangle(mesh, a, b, c);
                source.below(2) == 0 ? add_triangle(mesh, a + apart, c + apart, b + apart)
                                     : add_triangle(mesh, b + apart, c + apart, a + apart);
            }
            break;
        case 3:  // Slivers and needles.
            for (int n = 0; n < 60; ++n) {
                const Vec3d a = anywhere(), b = anywhere();
                const double t = source.between(-0.2, 1.2);
                add_triangle(
                    mesh, a, b,
                    a + (b - a) * t + source.in(-1, 1) * (unit * std::pow(10, source.between(-6, -1))));
            }
            break;
        case 4: {  // A fan around one corner, its rim up and down.
            const Vec3d tip = anywhere();
            const int rays = 40;
            for (int n = 0; n < rays; ++n) {
                const auto rim = [&](int k) {
                    const double a = 2 * 3.14159265358979 * (k % rays) / rays;
                    return tip + Vec3d{2 * std::cos(a), 0.3 * ((k % rays) % 3 - 1), 2 * std::sin(a)} * unit;
                };
                add_triangle(mesh, tip, rim(n + 1), rim(n));
            }
            add_box(mesh, anywhere(), anywhere());
            break;
        }
        case 5:  // Soup of all sizes.
            for (int n = 0; n < 120; ++n) {
                const Vec3d a = anywhere();
                const double size = unit * std::pow(10, source.between(-3, 0.3));
                add_triangle(mesh, a, a + source.in(-1, 1) * size, a + source.in(-1, 1) * size);
            }
            break;
        default: {  // A field of heights over a floor: concave edges everywhere.
            constexpr int n = 9;
            double height[n][n];
            for (auto& row : height) {
                for (double& h : row)
                    h = source.between(0, 1);
            }
            const auto at = [&](int i, int j) {
                return place(3.0 * i / (n - 1), height[i][j], 3.0 * j / (n - 1));
            };
            for (int i = 0; i + 1 < n; ++i) {
                for (int j = 0; j + 1 < n; ++j)
                    add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
            }
            break;
        }
    }
    analyse_topology(mesh);
    return mesh;
}

inline Light draw_light(Source& source, const Mesh& mesh, double unit, Vec3d origin) {
    Light light;
    const int kind = source.below(5);
    const Vec3d middle = origin + Vec3d{1.5, 1.5, 1.5} * unit;
    light.near_m = 1e-3 * unit;
    light.range_m = 100 * unit;
    if (kind < 3) {
        light.kind = LightKind::directional;
        light.direction = source.in(-1, 1);
        if (kind == 1) {  // Along an axis: on the planes of faces.
            constexpr Vec3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
            light.direction = axes[source.below(6)];
        }
        if (kind == 2) {  // Nearly in some face's plane: down to 0.01 degrees.
            const Plane& plane =
                mesh.faces[static_cast<std::size_t>(source.below(static_cast<int>(mesh.faces.size())))];
            const Vec3d along = normalize(cross(plane.n, source.in(-1, 1)));
            light.direction = along - plane.n * std::pow(10, source.between(-3.76, -1));
        }
        light.direction = normalize(light.direction);
        return light;
    }
    light.kind = kind == 3 ? LightKind::point : LightKind::spot;
    light.position = middle + source.in(-2.5, 2.5) * unit;
    // On the planes of the lattice, or on a corner, or so near that the near plane cuts.
    if (source.below(3) == 0) light.position.y = origin.y + unit * source.below(4);
    if (source.below(4) == 0)
        light.position = to_double(mesh.positions[static_cast<std::size_t>(
                             source.below(static_cast<int>(mesh.positions.size())))]) +
                         source.in(-2e-3, 2e-3) * unit;
    light.direction = normalize(middle + source.in(-0.5, 0.5) * unit - light.position);
    light.outer_cone_deg = source.between(10, 80);
    return light;
}

}  // namespace obscura::exact_scenes
