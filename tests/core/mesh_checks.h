#pragma once
// What the tests of shapes and generators ask of a mesh, counted here on their own: nothing below calls the
// project's topology code.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "core/hash.h"
#include "core/mesh.h"

namespace obscura::mesh_checks {

/// Index of the first vertex with the same position, for every vertex.
inline std::vector<std::uint32_t> welded(const Mesh& mesh) {
    std::map<std::tuple<float, float, float>, std::uint32_t> first;
    std::vector<std::uint32_t> to;
    for (const Vec3f p : mesh.positions) {
        to.push_back(
            first.emplace(std::tuple{p.x, p.y, p.z}, static_cast<std::uint32_t>(to.size())).first->second);
    }
    return to;
}

/// Connected parts of a mesh, by welded vertices.
inline std::vector<std::vector<Triangle>> parts(const Mesh& mesh) {
    const std::vector<std::uint32_t> weld = welded(mesh);
    std::vector<std::uint32_t> root(weld.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t i) {
        while (root[i] != i)
            i = root[i] = root[root[i]];
        return i;
    };
    for (const Triangle& t : mesh.triangles) {
        for (int k = 1; k < 3; ++k)
            root[find(weld[t.v[0]])] = find(weld[t.v[k]]);
    }
    std::map<std::uint32_t, std::vector<Triangle>> by_root;
    for (const Triangle& t : mesh.triangles) {
        by_root[find(weld[t.v[0]])].push_back({{weld[t.v[0]], weld[t.v[1]], weld[t.v[2]]}});
    }
    std::vector<std::vector<Triangle>> result;
    for (auto& [key, triangles] : by_root)
        result.push_back(std::move(triangles));
    return result;
}

struct EdgeCount {
    std::int64_t unbalanced = 0;  ///< edges walked more often one way than the other
    std::int64_t multiple = 0;    ///< edges with more than two triangles
};

inline EdgeCount count_edges(const std::vector<Triangle>& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t.v[k], b = t.v[(k + 1) % 3];
            auto& use = uses[std::minmax(a, b)];
            ++(a < b ? use.first : use.second);
        }
    }
    EdgeCount count;
    for (const auto& [edge, use] : uses) {
        count.unbalanced += use.first != use.second;
        count.multiple += use.first + use.second > 2;
    }
    return count;
}

inline double area(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = to_double(mesh.positions[t.v[0]]), b = to_double(mesh.positions[t.v[1]]),
                    c = to_double(mesh.positions[t.v[2]]);
        sum += 0.5 * length(cross(b - a, c - a));
    }
    return sum;
}

/// Positive for a closed part that is counter-clockwise from outside (divergence theorem).
inline double volume(const Mesh& mesh, const std::vector<Triangle>& triangles) {
    const Vec3d origin = to_double(mesh.positions[triangles.front().v[0]]);
    double sum = 0;
    for (const Triangle& t : triangles) {
        const Vec3d a = to_double(mesh.positions[t.v[0]]) - origin,
                    b = to_double(mesh.positions[t.v[1]]) - origin,
                    c = to_double(mesh.positions[t.v[2]]) - origin;
        sum += dot(a, cross(b, c)) / 6;
    }
    return sum;
}
inline double volume(const Mesh& mesh) {
    return volume(mesh, mesh.triangles);
}

struct Verdict {
    std::size_t solids = 0;
    std::size_t open_parts = 0;   ///< with an unbalanced edge
    std::size_t inside_out = 0;   ///< closed, but with a volume that is not positive
    std::size_t degenerate = 0;   ///< triangles with two equal corners or no area
    std::size_t bad_normals = 0;  ///< not unit, or on the far side of their triangle
    bool arrays_agree = false;
};

inline Verdict inspect(const Mesh& mesh) {
    Verdict v;
    v.arrays_agree =
        mesh.normals.size() == mesh.positions.size() && mesh.uvs.size() == mesh.positions.size() &&
        mesh.material.size() == mesh.triangles.size() && mesh.object.size() == mesh.triangles.size();
    for (const auto& part : parts(mesh)) {
        ++v.solids;
        const bool open = count_edges(part).unbalanced > 0;
        v.open_parts += open;
        v.inside_out += !open && !(volume(mesh, part) > 0);
    }
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = to_double(mesh.positions[t.v[0]]), b = to_double(mesh.positions[t.v[1]]),
                    c = to_double(mesh.positions[t.v[2]]);
        const Vec3d n = cross(b - a, c - a);
        const bool flat = !(length(n) > 0);
        v.degenerate += flat;
        for (const std::uint32_t k : t.v) {
            const Vec3d stored = to_double(mesh.normals[k]);
            v.bad_normals += !(std::fabs(length(stored) - 1) < 1e-5) || (!flat && !(dot(stored, n) > 0));
        }
    }
    return v;
}

/// Everything a generator decides, in one number.
inline std::uint64_t hash(const Mesh& mesh) {
    return Hasher{}
        .values(mesh.positions)
        .values(mesh.normals)
        .values(mesh.uvs)
        .values(mesh.triangles)
        .values(mesh.material)
        .state;
}

}  // namespace obscura::mesh_checks
