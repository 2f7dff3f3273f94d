// G. Thurmer and C. A. Wuthrich, Computing vertex normals from polygonal facets, Journal of Graphics Tools 3
// (1998): each facet counts by the angle it spans at the vertex, so that the result does not depend on how
// flat regions are cut into triangles. Creases as usual: neighbours across an edge smooth together or not.
#include <algorithm>
#include <array>
#include <tuple>

#include "core/edges.h"
#include "core/error.h"
#include "core/num.h"
#include "core/topology.h"
#include "core/union_find.h"

namespace obscura {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr std::size_t most_triangles_smoothed = 16;  ///< at one edge; more is foliage, not a surface

/// What a triangle brings to its corners.
struct Facet {
    Vec3d normal;  ///< unit, zero if degenerate
    std::array<double, 3> angle{};
};

double angle_between(Vec3d a, Vec3d b) {
    return num::acos(std::clamp(dot(normalize(a, {0, 0, 0}), normalize(b, {0, 0, 0})), -1.0, 1.0));
}

Facet facet_of(const Mesh& mesh, const Triangle& t) {
    const Vec3f a = mesh.positions[t.v[0]], b = mesh.positions[t.v[1]], c = mesh.positions[t.v[2]];
    if (is_degenerate(a, b, c)) return {};
    const std::array<Vec3d, 3> p = {to_double(a), to_double(b), to_double(c)};
    Facet facet;
    facet.normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
    for (std::size_t k = 0; k < 3; ++k)
        facet.angle[k] = angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
    return facet;
}

std::uint32_t corner_id(std::uint32_t triangle, std::uint32_t corner) {
    return 3 * triangle + corner % 3;
}

/// Whether two triangles that share an edge look like one surface there.
struct SmoothRule {
    double cos_crease;
    std::span<const std::uint32_t> groups;

    bool operator()(std::uint32_t a, std::uint32_t b, const std::vector<Facet>& facets) const {
        const std::uint32_t group_a = groups.empty() ? smooth_by_angle : groups[a];
        const std::uint32_t group_b = groups.empty() ? smooth_by_angle : groups[b];
        if (facets[a].normal == Vec3d{} || facets[b].normal == Vec3d{}) return false;
        if (group_a != group_b || group_a == smooth_none) return false;
        return group_a != smooth_by_angle || dot(facets[a].normal, facets[b].normal) >= cos_crease;
    }
};

/// Corners (3 * triangle + corner) that share one normal.
UnionFind smooth_corners(const Mesh& mesh, std::span<const Triangle> welded, const std::vector<Facet>& facets,
                         const SmoothRule& smooth) {
    UnionFind corners(3 * mesh.triangles.size());
    const auto component = mesh.component.size() == mesh.triangles.size()
                               ? std::span<const std::uint32_t>(mesh.component)
                               : std::span<const std::uint32_t>();
    const std::vector<std::uint32_t> all = all_indices(mesh.triangles.size());
    const auto uses = edge_uses(welded, static_cast<std::uint32_t>(mesh.positions.size()), all, component);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() > most_triangles_smoothed) return;
        for (const EdgeUse& a : edge) {
            for (const EdgeUse& b : edge) {
                if (!a.forward || b.forward || !smooth(a.triangle, b.triangle, facets)) continue;
                // a walks from lo to hi and b back: a's start meets b's end.
                corners.unite(corner_id(a.triangle, a.corner), corner_id(b.triangle, b.corner + 1u));
                corners.unite(corner_id(a.triangle, a.corner + 1u), corner_id(b.triangle, b.corner));
            }
        }
    });
    return corners;
}

/// For every corner the sum over its set. Corners of triangles without area borrow a sum at their position.
std::vector<Vec3d> summed_normals(std::span<const Triangle> welded, std::size_t vertices,
                                  const std::vector<Facet>& facets, UnionFind& corners) {
    std::vector<Vec3d> sum(corners.parent.size()), at_position(vertices);
    for (std::uint32_t c = 0; c < sum.size(); ++c) {
        const Facet& facet = facets[c / 3];
        Vec3d& total = sum[corners.root(c)];
        total = total + facet.normal * facet.angle[c % 3];
    }
    std::vector<Vec3d> result(sum.size());
    for (std::uint32_t c = 0; c < sum.size(); ++c) {
        result[c] = sum[corners.root(c)];
        Vec3d& any = at_position[welded[c / 3].v[c % 3]];
        if (any == Vec3d{}) any = result[c];
    }
    for (std::uint32_t c = 0; c < sum.size(); ++c) {
        if (facets[c / 3].normal == Vec3d{}) result[c] = at_position[welded[c / 3].v[c % 3]];
    }
    return result;
}

/// Gives each corner's vertex its normal; a vertex asked for a second one is copied.
void assign_normals(Mesh& mesh, const std::vector<Vec3f>& wanted, const std::vector<bool>& keep) {
    constexpr std::uint32_t none = UINT32_MAX;
    std::vector<std::uint32_t> next(mesh.positions.size(), none);  // further copies of a vertex
    std::vector<bool> taken(mesh.positions.size(), false);
    for (std::uint32_t c = 0; c < wanted.size(); ++c) {
        std::uint32_t& v = mesh.triangles[c / 3].v[c % 3];
        if (keep[v]) continue;
        if (!taken[v]) {
            taken[v] = true;
            mesh.normals[v] = wanted[c];
        }
        std::uint32_t copy = v;
        while (mesh.normals[copy] != wanted[c] && next[copy] != none)
            copy = next[copy];
        if (mesh.normals[copy] != wanted[c]) {
            const auto added = static_cast<std::uint32_t>(mesh.positions.size());
            CHECK(added != none);
            next[copy] = added;
            next.push_back(none);
            mesh.positions.push_back(mesh.positions[v]);
            mesh.normals.push_back(wanted[c]);
            if (!mesh.uvs.empty()) mesh.uvs.push_back(mesh.uvs[v]);
            copy = added;
        }
        v = copy;
    }
}

}  // namespace

void compute_normals(Mesh& mesh, double crease_angle_deg, std::span<const std::uint32_t> smoothing_groups) {
    CHECK(crease_angle_deg >= 0 && crease_angle_deg <= 180);
    CHECK(smoothing_groups.empty() || smoothing_groups.size() == mesh.triangles.size());
    CHECK(mesh.triangles.size() < UINT32_MAX / 3);
    mesh.normals.resize(mesh.positions.size());
    std::vector<bool> keep(mesh.positions.size());
    for (std::size_t v = 0; v < keep.size(); ++v)
        keep[v] = mesh.normals[v] != Vec3f{};
    if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;

    std::vector<Facet> facets;
    facets.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        facets.push_back(facet_of(mesh, t));
    const std::vector<Triangle> welded = relabel(mesh.triangles, weld_positions(mesh.positions));
    // Half a millionth of slack: facets of one crease angle stay together whatever their rounding.
    const SmoothRule smooth{num::cos(crease_angle_deg * degree) - 5e-7, smoothing_groups};
    UnionFind corners = smooth_corners(mesh, welded, facets, smooth);

    std::vector<Vec3f> wanted;
    wanted.reserve(corners.parent.size());
    for (const Vec3d& sum : summed_normals(welded, mesh.positions.size(), facets, corners)) {
        wanted.push_back(to_float(normalize(sum)));
    }
    assign_normals(mesh, wanted, keep);
    for (std::size_t v = 0; v < keep.size(); ++v) {
        if (mesh.normals[v] == Vec3f{}) mesh.normals[v] = {0, 1, 0};  // a vertex that nobody uses
    }
}

}  // namespace obscura
