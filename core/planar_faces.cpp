#include "core/planar_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/edges.h"

namespace obscura {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
constexpr double cos_same_plane = 0.99985;  // 1 degree
constexpr std::size_t most_triangles_crossed = 16;

std::array<Vec3d, 3> corners(const Mesh& mesh, std::uint32_t t) {
    const auto& v = mesh.triangles[t].v;
    return {to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
            to_double(mesh.positions[v[2]])};
}

auto order(const Vec3d& p) {
    return std::tie(p.x, p.y, p.z);
}

/// The corners turned so that the smallest position comes first: the same numbers whichever corner the file
/// names first.
std::array<Vec3d, 3> canonical_corners(const Mesh& mesh, std::uint32_t t) {
    auto c = corners(mesh, t);
    const auto first = std::min_element(c.begin(), c.end(),
                                        [](const Vec3d& a, const Vec3d& b) { return order(a) < order(b); });
    std::rotate(c.begin(), first, c.end());
    return c;
}

double largest_coordinate(const std::array<Vec3d, 3>& c) {
    double m = 0;
    for (const Vec3d& p : c)
        m = std::max({m, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return m;
}

Vec3d area_vector(const std::array<Vec3d, 3>& c) {
    return cross(c[1] - c[0], c[2] - c[0]);
}

/// Twice the area as a vector, per triangle.
std::vector<Vec3d> area_vectors(const Mesh& mesh) {
    std::vector<Vec3d> areas(mesh.triangles.size());
    for (std::uint32_t t = 0; t < areas.size(); ++t)
        areas[t] = area_vector(canonical_corners(mesh, t));
    return areas;
}

double round_to(double step, double value) {
    return std::nearbyint(value / step) * step;
}

/// Faces of different solids that touch come from different corners, so their planes would differ by
/// rounding, and which of the two is nearer would change from texel to texel. Planes are therefore taken from
/// a grid: coarser than the rounding of this calculation by 2^16, finer than that of the corners' own
/// coordinates by 2^4 or more.
Plane plane_of(const Mesh& mesh, std::uint32_t t, Vec3d area) {
    constexpr double grid = 0x1p-36;
    const auto c = canonical_corners(mesh, t);
    // Divisions, not products with a rounded reciprocal: faces that look along an axis get exactly that.
    const double len = length(area);
    Vec3d n = len > 0 ? Vec3d{area.x / len, area.y / len, area.z / len} : Vec3d{0, 1, 0};
    n = {round_to(grid, n.x), round_to(grid, n.y), round_to(grid, n.z)};
    // The step for distances is that of a power of 256 metres, so that faces of one size of scene share it;
    // walls that touch on either side of such a bound may still differ, which costs time but nothing else.
    double scale = 0x1p-64;
    while (scale < largest_coordinate(c))
        scale *= 256.0;
    return {n, round_to(grid * scale, -(dot(n, c[0]) + dot(n, c[1]) + dot(n, c[2])) / 3.0)};
}

bool lies_on(const std::array<Vec3d, 3>& c, Vec3d area, const Plane& plane, double seed_coordinate) {
    // The normals first: on a curved surface they settle almost every question.
    const double along = dot(area, plane.n);
    if (!(along >= 0 && along * along >= cos_same_plane * cos_same_plane * dot(area, area))) return false;
    const double tolerance = 4.0 * 0x1p-23 * std::max(seed_coordinate, largest_coordinate(c));
    return std::all_of(c.begin(), c.end(),
                       [&](const Vec3d& p) { return std::fabs(dot(plane.n, p) + plane.d) <= tolerance; });
}

/// Triangles from large to small; equal areas by position, identical triangles by number.
std::vector<std::uint32_t> seeds_by_area(const Mesh& mesh, const std::vector<Vec3d>& areas) {
    struct Seed {
        double area2;
        std::uint32_t triangle;
    };
    std::vector<Seed> seeds;
    seeds.reserve(areas.size());
    for (std::uint32_t t = 0; t < areas.size(); ++t)
        seeds.push_back({dot(areas[t], areas[t]), t});
    std::sort(seeds.begin(), seeds.end(), [&](const Seed& a, const Seed& b) {
        if (a.area2 != b.area2) return a.area2 > b.area2;
        const auto ca = canonical_corners(mesh, a.triangle), cb = canonical_corners(mesh, b.triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            if (ca[k] != cb[k]) return order(ca[k]) < order(cb[k]);
        }
        return a.triangle < b.triangle;
    });
    std::vector<std::uint32_t> triangles;
    triangles.reserve(seeds.size());
    for (const Seed& seed : seeds)
        triangles.push_back(seed.triangle);
    return triangles;
}

/// For every triangle and corner where the edge that starts there lies in `uses`.
struct EdgeMap {
    std::vector<EdgeUse> uses;
    std::vector<std::array<std::uint32_t, 3>> begin;  ///< per triangle; none = not crossed
    std::vector<std::uint8_t> length;                 ///< per first use of an edge
};

EdgeMap map_edges(const Mesh& mesh, std::span<const Triangle> welded) {
    EdgeMap map;
    const std::vector<std::uint32_t> all = all_indices(welded.size());
    map.uses = edge_uses(welded, static_cast<std::uint32_t>(mesh.positions.size()), all, mesh.component);
    map.begin.assign(welded.size(), {none, none, none});
    map.length.assign(map.uses.size(), 0);
    for_each_edge(map.uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() > most_triangles_crossed) return;
        const auto first = static_cast<std::uint32_t>(edge.data() - map.uses.data());
        map.length[first] = static_cast<std::uint8_t>(edge.size());
        for (const EdgeUse& use : edge)
            map.begin[use.triangle][use.corner] = first;
    });
    return map;
}

/// Calls fn(neighbour) for triangles that walk an edge of `t` the other way.
template <class Fn>
void for_each_neighbour(const EdgeMap& map, std::uint32_t t, Fn&& fn) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t first = map.begin[t][corner];
        if (first == none) continue;
        const std::span<const EdgeUse> edge(&map.uses[first], map.length[first]);
        const bool forward = std::find_if(edge.begin(), edge.end(), [&](const EdgeUse& use) {
                                 return use.triangle == t && use.corner == corner;
                             })->forward;
        for (const EdgeUse& use : edge) {
            if (use.forward != forward) fn(use.triangle);
        }
    }
}

/// Numbers faces by their first triangle.
void renumber(Mesh& mesh) {
    std::vector<std::uint32_t> number(mesh.faces.size(), none);
    std::vector<Plane> planes;
    planes.reserve(mesh.faces.size());
    for (std::uint32_t& face : mesh.face) {
        if (number[face] == none) {
            number[face] = static_cast<std::uint32_t>(planes.size());
            planes.push_back(mesh.faces[face]);
        }
        face = number[face];
    }
    mesh.faces = std::move(planes);
}

}  // namespace

void find_planar_faces(Mesh& mesh, std::span<const Triangle> welded) {
    const EdgeMap edges = map_edges(mesh, welded);
    mesh.face.assign(mesh.triangles.size(), none);
    mesh.faces.clear();
    std::vector<std::uint32_t> front;
    const std::vector<Vec3d> areas = area_vectors(mesh);
    for (const std::uint32_t seed : seeds_by_area(mesh, areas)) {
        if (mesh.face[seed] != none) continue;
        const auto face = static_cast<std::uint32_t>(mesh.faces.size());
        const Plane plane = plane_of(mesh, seed, areas[seed]);
        const double seed_coordinate = largest_coordinate(corners(mesh, seed));
        mesh.faces.push_back(plane);
        mesh.face[seed] = face;

        // Everything reachable on the plane joins, in whatever order it is reached.
        front.assign(1, seed);
        while (!front.empty()) {
            const std::uint32_t t = front.back();
            front.pop_back();
            for_each_neighbour(edges, t, [&](std::uint32_t neighbour) {
                if (mesh.face[neighbour] != none) return;
                if (!lies_on(corners(mesh, neighbour), areas[neighbour], plane, seed_coordinate)) return;
                mesh.face[neighbour] = face;
                front.push_back(neighbour);
            });
        }
    }
    renumber(mesh);
}

void make_faces_of_triangles(Mesh& mesh) {
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.face = all_indices(count);
    mesh.faces.clear();
    mesh.faces.reserve(count);
    for (std::uint32_t t = 0; t < count; ++t)
        mesh.faces.push_back(plane_of(mesh, t, area_vector(canonical_corners(mesh, t))));
}

}  // namespace obscura
