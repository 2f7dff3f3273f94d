// Solids that a section leaves behind when it moves: prisms, strips, tubes, mouldings.

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/build.h"
#include "scenes/polygon.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

std::uint32_t add_vertex(Mesh& m, Vec3d p, Vec3d n, Vec2d uv) {
    m.positions.push_back(stored(p));
    m.normals.push_back(to_float(n));
    m.uvs.push_back({static_cast<float>(uv.x), static_cast<float>(uv.y)});
    return static_cast<std::uint32_t>(m.positions.size() - 1);
}

void finish(Mesh& m) {
    m.material.assign(m.triangles.size(), 0);
    m.object.assign(m.triangles.size(), 0);
}

/// The side wall of a prism over a closed counter-clockwise outline.
void add_wall(Mesh& m, const std::vector<Vec2d>& outline, double back, double front, double crease_deg) {
    const std::size_t n = outline.size();
    const double crease_cos = on_circle(crease_deg / 360.0).x;
    std::vector<Vec3d> flat(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d d = outline[(i + 1) % n] - outline[i];
        CHECK(d.x != 0 || d.y != 0);
        flat[i] = normalize(Vec3d{d.y, -d.x, 0});
    }
    const auto corner_normal = [&](std::size_t side, std::size_t neighbour) {
        const bool smooth = dot(flat[side], flat[neighbour]) >= crease_cos;
        return smooth ? normalize(flat[side] + flat[neighbour]) : flat[side];
    };
    double u = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d a = outline[i], b = outline[(i + 1) % n];
        const Vec3d na = corner_normal(i, (i + n - 1) % n), nb = corner_normal(i, (i + 1) % n);
        const double next_u = u + std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        const std::uint32_t a1 = add_vertex(m, {a.x, a.y, front}, na, {u, front});
        const std::uint32_t a0 = add_vertex(m, {a.x, a.y, back}, na, {u, back});
        const std::uint32_t b0 = add_vertex(m, {b.x, b.y, back}, nb, {next_u, back});
        const std::uint32_t b1 = add_vertex(m, {b.x, b.y, front}, nb, {next_u, front});
        m.triangles.push_back({{a1, a0, b0}});
        m.triangles.push_back({{a1, b0, b1}});
        u = next_u;
    }
}

/// A flat end at height z, facing +Z (front) or -Z.
void add_end(Mesh& m, const std::vector<Vec2d>& outline, const std::vector<Triangle>& triangles, double z,
             bool front) {
    const auto first = static_cast<std::uint32_t>(m.positions.size());
    for (const Vec2d p : outline) {
        add_vertex(m, {p.x, p.y, z}, {0, 0, front ? 1.0 : -1.0}, {front ? p.x : -p.x, p.y});
    }
    for (const Triangle& t : triangles) {
        m.triangles.push_back({{first + t.v[0], first + t.v[front ? 1 : 2], first + t.v[front ? 2 : 1]}});
    }
}

}  // namespace

Mesh extrude(const std::vector<Vec2d>& outline, double back, double front, double crease_deg) {
    CHECK(outline.size() >= 3 && back < front);
    const std::vector<Triangle> triangles = triangulate(outline);
    Mesh m;
    add_end(m, outline, triangles, front, true);
    add_end(m, outline, triangles, back, false);
    add_wall(m, outline, back, front, crease_deg);
    finish(m);
    return m;
}

Mesh strip(const std::vector<Vec2d>& lower, const std::vector<Vec2d>& upper, double back, double front,
           double crease_deg) {
    CHECK(lower.size() == upper.size() && lower.size() >= 2 && back < front);
    // The outline runs right below and returns left above; the ends are ladders of quads between the chains.
    std::vector<Vec2d> outline = lower;
    outline.insert(outline.end(), upper.rbegin(), upper.rend());
    const auto n = static_cast<std::uint32_t>(lower.size());
    std::vector<Triangle> ladder;
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
        const std::uint32_t a = i, b = i + 1, c = 2 * n - 2 - i, d = 2 * n - 1 - i;
        ladder.push_back({{a, b, c}});
        ladder.push_back({{a, c, d}});
    }
    Mesh m;
    add_end(m, outline, ladder, front, true);
    add_end(m, outline, ladder, back, false);
    add_wall(m, outline, back, front, crease_deg);
    finish(m);
    return m;
}

Mesh tube(const std::vector<TubePoint>& path, int sides) {
    CHECK(path.size() >= 2 && sides >= 3);
    const std::size_t n = path.size();
    const auto columns = static_cast<std::uint32_t>(sides);
    Mesh m;
    // A frame that is carried along without twist (parallel transport).
    Vec3d previous = normalize(path[1].at - path[0].at);
    Vec3d side = normalize(cross(previous, std::fabs(previous.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}));
    double v = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d before = normalize(path[i].at - path[i ? i - 1 : 0].at, previous);
        const Vec3d after = i + 1 < n ? normalize(path[i + 1].at - path[i].at) : before;
        const Vec3d along = normalize(before + after, after);
        side = normalize(side - along * dot(side, along));
        const Vec3d other = cross(along, side);
        if (i) v += length(path[i].at - path[i - 1].at);
        for (std::uint32_t j = 0; j <= columns; ++j) {
            const Vec2d c = on_circle(static_cast<double>(j % columns) / sides);
            const Vec3d out = side * c.x + other * c.y;
            add_vertex(m, path[i].at + out * path[i].radius_m, out,
                       {6.2832 * path[i].radius_m * j / sides, v});
        }
        previous = along;
    }
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
        for (std::uint32_t j = 0; j < columns; ++j) {
            const std::uint32_t a = i * (columns + 1) + j, b = a + 1, c = a + columns + 1, d = c + 1;
            m.triangles.push_back({{a, b, d}});
            m.triangles.push_back({{a, d, c}});
        }
    }
    // Flat caps over the first and the last ring.
    for (const bool top : {false, true}) {
        const std::uint32_t ring = top ? static_cast<std::uint32_t>(n - 1) * (columns + 1) : 0;
        const Vec3d out =
            top ? normalize(path[n - 1].at - path[n - 2].at) : normalize(path[0].at - path[1].at);
        const auto first = static_cast<std::uint32_t>(m.positions.size());
        for (std::uint32_t j = 0; j < columns; ++j) {
            m.positions.push_back(m.positions[ring + j]);
            m.normals.push_back(to_float(out));
            m.uvs.push_back({0, 0});
        }
        for (std::uint32_t j = 2; j < columns; ++j) {
            const std::uint32_t b = top ? j - 1 : j, c = top ? j : j - 1;
            m.triangles.push_back({{first, first + b, first + c}});
        }
    }
    finish(m);
    return m;
}

Mesh moulding(const std::vector<Vec2d>& profile, double width_m, double depth_m) {
    CHECK(profile.size() >= 3);
    Mesh m;
    const Vec2d corners[4] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
    const auto at = [&](std::size_t corner, Vec2d p) {
        return Vec3d{corners[corner].x * (0.5 * width_m + p.x), p.y,
                     corners[corner].y * (0.5 * depth_m + p.x)};
    };
    for (std::size_t side = 0; side < 4; ++side) {
        for (std::size_t i = 0; i < profile.size(); ++i) {
            const Vec2d p = profile[i], q = profile[(i + 1) % profile.size()];
            add_facet(m, {at(side, p), at((side + 1) % 4, p), at((side + 1) % 4, q), at(side, q)});
        }
    }
    return m;
}

}  // namespace obscura
