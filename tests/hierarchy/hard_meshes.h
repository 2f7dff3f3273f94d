#pragma once
// Small meshes that look for trouble: what touches, coincides, crosses at a hair's breadth, is thinner than a
// texel, is turned inside out, hangs open, leaves the map or the near plane.

#include <cmath>
#include <random>

#include "core/mesh.h"
#include "core/topology.h"
#include "raster/view.h"
#include "scenes/shapes.h"
#include "tests/raster/raster_solids.h"

namespace obscura::hard {

/// Draws meshes and views; the same for the same seed and compiler.
class Source {
  public:
    explicit Source(std::uint32_t seed) : rng_(seed) {}

    int pick(int count) { return static_cast<int>(rng_() % static_cast<std::uint32_t>(count)); }
    bool chance(int percent) { return pick(100) < percent; }
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(rng_()) / 4294967296.0);
    }
    /// On a coarse grid mostly, so that planes, edges and corners coincide; a few steps of the float grid
    /// beside it sometimes.
    double coordinate() {
        double x = pick(3) == 0 ? uniform(-4, 4) : 0.5 * (pick(17) - 8);
        if (chance(10)) {
            const float f = static_cast<float>(x);
            x = static_cast<double>(std::nextafterf(f, chance(50) ? 10.0f : -10.0f));
        }
        return x;
    }
    Vec3d point() { return {coordinate(), coordinate(), coordinate()}; }

    Mesh mesh();
    LightView view(const Mesh& mesh, int side);

  private:
    void add_part(Mesh& all);
    void add_calm_part(Mesh& all);
    Mesh soup(int triangles, bool thin);
    Mesh fan();
    Mesh prism_with_t_junctions();
    Mesh near_copy(const Mesh& part);

    std::mt19937 rng_;
};

/// Triangles without order; `thin`: slivers.
inline Mesh Source::soup(int triangles, bool thin) {
    Mesh m;
    for (int i = 0; i < triangles; ++i) {
        const Vec3d p = point(), q = point();
        const Vec3d r = thin ? p + (q - p) * uniform(-0.2, 1.2) + point() * 0.002 : point();
        const auto base = static_cast<std::uint32_t>(m.positions.size());
        for (const Vec3d& v : {p, q, r})
            m.positions.push_back(to_float(v));
        m.triangles.push_back({{base, base + 1, base + 2}});
        if (chance(20)) m.triangles.push_back({{base, base + 1, base + 2}});
        if (chance(20)) m.triangles.push_back({{base, base + 2, base + 1}});
    }
    return m;
}

/// A closed double cone of many triangles round two points.
inline Mesh Source::fan() {
    const int n = 3 + pick(60);
    Mesh m;
    const Vec3d centre = point();
    const double radius = uniform(0.01, 3), height = chance(50) ? uniform(0, 0.01) : uniform(0, 2);
    m.positions.push_back(to_float(centre + Vec3d{0, height, 0}));
    m.positions.push_back(to_float(centre - Vec3d{0, chance(50) ? 0.0 : height, 0}));
    for (int i = 0; i < n; ++i) {
        const double t = 6.283185307179586 * i / n;
        m.positions.push_back(to_float(
            centre + Vec3d{radius * std::cos(t), chance(10) ? height / 2 : 0.0, radius * std::sin(t)}));
    }
    for (int i = 0; i < n; ++i) {
        const auto a = static_cast<std::uint32_t>(2 + i), b = static_cast<std::uint32_t>(2 + (i + 1) % n);
        m.triangles.push_back({{0, b, a}});
        m.triangles.push_back({{1, a, b}});
    }
    return m;
}

/// A box one of whose faces is cut by a vertex that its neighbour does not know: open by count, closed to
/// the eye.
inline Mesh Source::prism_with_t_junctions() {
    const Vec3d low = point();
    Mesh m = box(low, low + Vec3d{uniform(0.01, 3), uniform(0.01, 3), uniform(0.01, 3)});
    const std::size_t at = static_cast<std::size_t>(pick(static_cast<int>(m.triangles.size())));
    const Triangle t = m.triangles[at];
    const Vec3d p = to_double(m.positions[t.v[0]]), q = to_double(m.positions[t.v[1]]);
    const auto middle = static_cast<std::uint32_t>(m.positions.size());
    m.positions.push_back(to_float(p + (q - p) * uniform(0.1, 0.9)));
    m.normals.clear();
    m.uvs.clear();
    m.material.clear();
    m.object.clear();
    m.objects.clear();
    m.triangles[at] = {{t.v[0], middle, t.v[2]}};
    m.triangles.push_back({{middle, t.v[1], t.v[2]}});
    return m;
}

/// The part once more: in the same place, a hair beside it, or tilted by a hair.
inline Mesh Source::near_copy(const Mesh& part) {
    Affine map;
    if (chance(60)) map = solids::rotation({uniform(-1, 1), uniform(-1, 1), 1}, uniform(-1, 1) * 1e-6);
    if (chance(60)) {
        for (int i = 0; i < 3; ++i)
            map.m[i][3] = uniform(-1, 1) * 1e-6;
    }
    return chance(20) ? part : solids::moved(part, map);
}

/// Drops what only pictures need, and takes the topology.
inline void append_analysed(Mesh& all, Mesh part, bool casts) {
    part.normals.clear();
    part.uvs.clear();
    part.material.clear();
    part.objects = {{"part", casts}};
    part.object.assign(part.triangles.size(), 0);
    analyse_topology(part);
    append_mesh(all, part);
}

inline void Source::add_part(Mesh& all) {
    Mesh part;
    switch (pick(11)) {
        case 0:
        case 1:
        case 2: {
            const Vec3d low = point();
            const double thin = chance(30) ? 1e-3 : 1.0;
            part =
                box(low, low + Vec3d{thin * (0.5 + 0.5 * pick(6)), 0.5 + 0.5 * pick(6), 0.5 + 0.5 * pick(6)});
            break;
        }
        case 3:
            part = box({uniform(0.001, 3), uniform(0.001, 3), uniform(0.001, 3)});
            break;
        case 4:
            part = sphere(uniform(0.05, 2.5), 3 + pick(40), 2 + pick(20));
            break;
        case 5:
            part = plane(uniform(0.1, 8), uniform(0.1, 8), 1 + pick(6), 1 + pick(6));
            break;
        case 6:
            part = soup(1 + pick(8), false);
            break;
        case 7:
            part = soup(1 + pick(8), true);
            break;
        case 8:
            part = fan();
            break;
        case 9:
            part = prism_with_t_junctions();
            break;
        default:
            part = torus(uniform(0.5, 2), uniform(0.01, 0.4), 3 + pick(30), 3 + pick(9));
            break;
    }
    if (chance(50)) {
        Affine map =
            chance(60) ? solids::rotation({uniform(-1, 1), uniform(-1, 1), 1}, uniform(-1, 1)) : Affine{};
        for (int i = 0; i < 3; ++i)
            map.m[i][3] = coordinate();
        part = solids::moved(part, map);
    }
    if (chance(15)) part = solids::flipped(part);
    if (chance(8) && part.triangles.size() > 3) part.triangles.resize(part.triangles.size() - 1);
    const bool casts = !chance(10);
    append_analysed(all, part, casts);
    if (chance(20)) append_analysed(all, near_copy(part), casts);
    if (chance(10)) append_analysed(all, solids::flipped(near_copy(part)), casts);
}

/// Closed solids with room between and around them, of many facets or of few: squares that can be decided.
/// Among them solids that lie upon each other with whole faces, exactly or but for a hair.
inline void Source::add_calm_part(Mesh& all) {
    Affine map =
        chance(70) ? solids::rotation({uniform(-1, 1), uniform(-1, 1), 1}, uniform(-1, 1)) : Affine{};
    for (int i = 0; i < 3; ++i)
        map.m[i][3] = coordinate();
    const int kind = pick(5), segments = 6 + pick(90), rings = 4 + pick(40);
    if (kind == 0) append_analysed(all, solids::moved(sphere(uniform(0.5, 4), segments, rings), map), true);
    if (kind == 1) append_analysed(all, solids::moved(torus(3, uniform(0.3, 2), segments, rings), map), true);
    if (kind == 2)
        append_analysed(all, solids::moved(cylinder(uniform(0.5, 3), uniform(0.001, 5), segments), map),
                        true);
    if (kind == 3)
        append_analysed(all, solids::moved(box({uniform(0.5, 6), uniform(1e-4, 3), uniform(0.5, 6)}), map),
                        true);
    if (kind != 4) return;
    const Vec3d size{uniform(2, 6), uniform(0.1, 2), uniform(2, 6)};
    const int count = 2 + pick(4);
    for (int i = 0; i < count; ++i) {
        const double gap = chance(50) ? 0.0 : uniform(-1, 1) * (chance(50) ? 1e-6 : 1e-4);
        Mesh slab = box({0, i * size.y + gap, 0}, {size.x, (i + 1) * size.y, size.z});
        if (chance(30))
            slab = solids::moved(slab, solids::rotation({1, 0, uniform(-1, 1)}, uniform(-1, 1) * 1e-6));
        append_analysed(all, solids::moved(slab, map), true);
    }
}

inline Mesh Source::mesh() {
    Mesh all;
    if (chance(50)) {
        const int parts = 1 + pick(5);
        for (int i = 0; i < parts; ++i)
            add_calm_part(all);
        if (chance(20)) add_part(all);
        return all;
    }
    const int parts = chance(10) ? 40 + pick(60) : 1 + pick(14);
    for (int i = 0; i < parts; ++i)
        add_part(all);
    // Sometimes all of it is one object without parts: topology then joins what touches.
    if (chance(30)) {
        const std::vector<std::uint32_t> object(all.triangles.size(), 0);
        all.objects = {{"all", true}};
        all.object = object;
        analyse_topology(all);
    }
    return all;
}

inline LightView Source::view(const Mesh& mesh, int side) {
    const Bounds b = bounds_of(mesh);
    const Vec3d directions[] = {{0, -1, 0}, {0, 0, -1},       {1, 0, 0},
                                {1, -1, 0}, {1e-5, -1, 2e-5}, {0.02, -0.001, 1}};
    const Vec3d direction =
        normalize(chance(50) ? directions[pick(6)] : Vec3d{uniform(-1, 1), uniform(-1, 0.2), uniform(-1, 1)});
    const int kind = pick(6);
    if (kind == 0)
        return perspective_light_view(point(), direction, uniform(10, 150), uniform(0.01, 1), 40, side);
    if (kind == 1) {
        return perspective_light_view((b.low + b.high) * 0.5 - direction * uniform(2, 12), direction,
                                      uniform(10, 100), uniform(0.01, 2), 40, side);
    }
    if (kind == 2) {  // Objects partly off the map, and before its beginning.
        const Vec3d p = point();
        return orthographic_light_view(
            {p - Vec3d{1, 1, 1} * uniform(0.1, 4), p + Vec3d{1, 1, 1} * uniform(0.1, 4)}, direction, side);
    }
    if (kind == 3) {
        // The grid of the scene falls on centres or borders of texels: no margin, a power of two.
        const LightView exact = orthographic_light_view({{-8, -8, -8}, {8, 8, 8}}, directions[pick(3)], side);
        LightView v = exact;
        const double scale = side / 16.0 /
                             std::sqrt(exact.to_map.m[0][0] * exact.to_map.m[0][0] +
                                       exact.to_map.m[0][1] * exact.to_map.m[0][1] +
                                       exact.to_map.m[0][2] * exact.to_map.m[0][2]);
        for (int r = 0; r < 2; ++r) {
            for (int c = 0; c < 3; ++c)
                v.to_map.m[r][c] *= scale;
            v.to_map.m[r][3] = 0.5 * side + (chance(50) ? 0.5 : 0.0);
        }
        return v;
    }
    return orthographic_light_view(b, direction, side);
}

}  // namespace obscura::hard
