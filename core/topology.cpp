#include "core/topology.h"

#include <algorithm>
#include <string>

#include "core/edges.h"
#include "core/error.h"
#include "core/planar_faces.h"
#include "core/union_find.h"

namespace obscura {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

struct Walk {
    std::uint32_t part = 0;
    int balance = 0;
};

/// Joins, at an edge of more than two triangles, those parts that do not balance there by themselves.
void join_unbalanced_parts(std::span<const EdgeUse> edge, UnionFind& before, UnionFind& after,
                           std::vector<Walk>& walks) {
    walks.clear();
    for (const EdgeUse& use : edge)
        walks.push_back({before.root(use.triangle), use.forward ? 1 : -1});
    std::sort(walks.begin(), walks.end(), [](const Walk& a, const Walk& b) { return a.part < b.part; });
    std::uint32_t joined = none;
    for (std::size_t i = 0; i < walks.size();) {
        const std::uint32_t part = walks[i].part;
        int sum = 0;
        for (; i < walks.size() && walks[i].part == part; ++i)
            sum += walks[i].balance;
        if (sum == 0) continue;
        if (joined != none) after.unite(joined, part);
        joined = part;
    }
}

/// A triangle that repeats a corner has one edge left at most: it joins whoever walks there.
void attach_collapsed(std::span<const Triangle> triangles, std::span<const std::uint32_t> subset,
                      std::span<const EdgeUse> uses, UnionFind& parts) {
    for (const std::uint32_t t : subset) {
        const auto& v = triangles[t].v;
        if (!repeats_corner(triangles[t])) continue;
        const std::uint32_t lo = std::min({v[0], v[1], v[2]}), hi = std::max({v[0], v[1], v[2]});
        const auto at =
            std::lower_bound(uses.begin(), uses.end(), lo, [&](const EdgeUse& use, std::uint32_t id) {
                return use.lo < id || (use.lo == id && use.hi < hi);
            });
        if (at != uses.end() && at->lo == lo && at->hi == hi) parts.unite(t, at->triangle);
    }
}

/// Parts of `subset` that hang together by edges.
UnionFind connect(std::span<const Triangle> triangles, std::span<const std::uint32_t> subset,
                  std::span<const EdgeUse> uses) {
    UnionFind parts(triangles.size());
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2) parts.unite(edge[0].triangle, edge[1].triangle);
    });
    UnionFind before = parts;
    std::vector<Walk> walks;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() > 2) join_unbalanced_parts(edge, before, parts, walks);
    });
    attach_collapsed(triangles, subset, uses, parts);
    return parts;
}

/// Judges each part by its own edges: the entry of a part's root tells open edges and multi-edges.
std::vector<Component> judge(std::span<const EdgeUse> uses, UnionFind& parts) {
    std::vector<Component> verdict(parts.parent.size());
    std::vector<Walk> walks;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        if (edge.size() == 2 && edge[0].forward != edge[1].forward) return;  // one part, and it balances
        walks.clear();
        for (const EdgeUse& use : edge)
            walks.push_back({parts.root(use.triangle), use.forward ? 1 : -1});
        std::sort(walks.begin(), walks.end(), [](const Walk& a, const Walk& b) { return a.part < b.part; });
        for (std::size_t i = 0; i < walks.size();) {
            const std::size_t first = i;
            int sum = 0;
            for (; i < walks.size() && walks[i].part == walks[first].part; ++i)
                sum += walks[i].balance;
            Component& component = verdict[walks[first].part];
            component.open_edges += static_cast<std::uint32_t>(sum < 0 ? -sum : sum);
            if (i - first > 2) component.balanced_multi_edges = true;
        }
    });
    return verdict;
}

/// One step of the policy: closed parts of `remaining` get their component, the others are returned. The last
/// step gives every part one.
std::vector<std::uint32_t> settle(Mesh& mesh, std::span<const Triangle> triangles,
                                  std::span<const std::uint32_t> remaining,
                                  std::span<const std::uint32_t> group, bool last) {
    const auto id_count = static_cast<std::uint32_t>(mesh.positions.size());
    const std::vector<EdgeUse> uses = edge_uses(triangles, id_count, remaining, group);
    UnionFind parts = connect(triangles, remaining, uses);
    std::vector<Component> verdict = judge(uses, parts);

    std::vector<std::uint32_t> open, number(triangles.size(), none);
    for (const std::uint32_t t : remaining) {
        const std::uint32_t root = parts.root(t);
        Component& part = verdict[root];
        part.closed = part.open_edges == 0;
        if (!part.closed && !last) {
            open.push_back(t);
            continue;
        }
        if (number[root] == none) {
            number[root] = static_cast<std::uint32_t>(mesh.components.size());
            part.balanced_multi_edges = part.balanced_multi_edges && part.closed;
            mesh.components.push_back(part);
        }
        mesh.component[t] = number[root];
        ++mesh.components[number[root]].triangles;
    }
    return open;
}

void number_components_by_first_triangle(Mesh& mesh) {
    std::vector<std::uint32_t> number(mesh.components.size(), none);
    std::vector<Component> ordered;
    ordered.reserve(mesh.components.size());
    for (std::uint32_t& component : mesh.component) {
        if (number[component] == none) {
            number[component] = static_cast<std::uint32_t>(ordered.size());
            ordered.push_back(mesh.components[component]);
        }
        component = number[component];
    }
    mesh.components = std::move(ordered);
}

TopologyReport::Edges count_edges(std::span<const EdgeUse> uses) {
    TopologyReport::Edges count;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
        count.open += balance(edge) != 0;
        count.multi += edge.size() > 2;
    });
    return count;
}

/// Vertex ids as numbers below the vertex count: the first vertex that carries the id.
std::vector<std::uint32_t> compact_ids(std::span<const std::uint32_t> ids, std::size_t vertices) {
    if (ids.empty()) return all_indices(vertices);
    std::vector<std::uint32_t> by_id = all_indices(vertices), first(vertices);
    std::sort(by_id.begin(), by_id.end(),
              [&](std::uint32_t a, std::uint32_t b) { return ids[a] != ids[b] ? ids[a] < ids[b] : a < b; });
    for (std::size_t i = 0; i < vertices; ++i) {
        const bool same = i > 0 && ids[by_id[i]] == ids[by_id[i - 1]];
        first[by_id[i]] = same ? first[by_id[i - 1]] : by_id[i];
    }
    return first;
}

}  // namespace

TopologyReport analyse_topology(Mesh& mesh, std::span<const std::uint32_t> vertex_ids) {
    const std::size_t vertices = mesh.positions.size(), count = mesh.triangles.size();
    CHECK(vertices < none && count < none);
    CHECK(vertex_ids.empty() || vertex_ids.size() == vertices);
    for (const Triangle& t : mesh.triangles) {
        CHECK(t.v[0] < vertices && t.v[1] < vertices && t.v[2] < vertices);
    }
    const std::vector<Triangle> indexed = relabel(mesh.triangles, compact_ids(vertex_ids, vertices));
    const std::vector<Triangle> welded = relabel(mesh.triangles, weld_positions(mesh.positions));
    const std::vector<std::uint32_t> all = all_indices(count);

    mesh.component.assign(count, none);
    mesh.components.clear();
    std::vector<std::uint32_t> open = settle(mesh, indexed, all, {}, false);
    if (!open.empty() && mesh.objects.size() > 1 && mesh.object.size() == count) {
        open = settle(mesh, welded, open, mesh.object, false);
    }
    if (!open.empty()) settle(mesh, welded, open, {}, true);
    number_components_by_first_triangle(mesh);
    find_planar_faces(mesh, welded);

    TopologyReport report;
    const auto id_count = static_cast<std::uint32_t>(vertices);
    report.by_index = count_edges(edge_uses(indexed, id_count, all));
    report.welded = count_edges(edge_uses(welded, id_count, all));
    for (const Triangle& t : mesh.triangles) {
        const auto& p = mesh.positions;
        report.degenerate_triangles += is_degenerate(p[t.v[0]], p[t.v[1]], p[t.v[2]]);
    }
    return report;
}

std::vector<double> signed_volumes(const Mesh& mesh) {
    CHECK(mesh.component.size() == mesh.triangles.size());
    // Each component is measured from one of its own corners, so that places far away lose no digits.
    std::vector<double> volume(mesh.components.size(), 0.0);
    std::vector<std::uint32_t> origin(mesh.components.size(), none);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t].v;
        const std::uint32_t component = mesh.component[t];
        if (origin[component] == none) origin[component] = v[0];
        const Vec3d o = to_double(mesh.positions[origin[component]]);
        const Vec3d a = to_double(mesh.positions[v[0]]) - o, b = to_double(mesh.positions[v[1]]) - o,
                    c = to_double(mesh.positions[v[2]]) - o;
        volume[component] += dot(a, cross(b, c)) / 6.0;
    }
    return volume;
}

namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& part) {
    to.insert(to.end(), part.begin(), part.end());
}

template <class T>
void append_shifted(std::vector<T>& to, const std::vector<T>& part, std::size_t count, std::size_t shift) {
    CHECK(part.empty() || part.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        to.push_back((part.empty() ? 0 : part[i]) + static_cast<T>(shift));
    }
}

/// Vertex arrays that one of two meshes may lack.
template <class T>
void append_optional(std::vector<T>& to, std::size_t to_count, const std::vector<T>& part,
                     std::size_t part_count) {
    CHECK(to.empty() || to.size() == to_count);
    CHECK(part.empty() || part.size() == part_count);
    if (to.empty() && part.empty()) return;
    to.resize(to_count);
    append(to, part);
    to.resize(to_count + part_count);
}

}  // namespace

void append_mesh(Mesh& to, const Mesh& part) {
    const std::size_t vertices = to.positions.size(), triangles = to.triangles.size();
    CHECK(vertices + part.positions.size() < none && triangles + part.triangles.size() < none);
    append_optional(to.normals, vertices, part.normals, part.positions.size());
    append_optional(to.uvs, vertices, part.uvs, part.positions.size());
    append(to.positions, part.positions);

    const std::size_t count = part.triangles.size();
    for (Triangle t : part.triangles) {
        for (std::uint32_t& v : t.v)
            v += static_cast<std::uint32_t>(vertices);
        to.triangles.push_back(t);
    }
    to.material.resize(triangles);
    to.object.resize(triangles);
    if (to.objects.empty() && triangles > 0) to.objects.emplace_back();
    append_shifted(to.material, part.material, count, 0);
    append_shifted(to.object, part.object, count, to.objects.size());
    append(to.objects, part.objects);
    if (part.objects.empty() && count > 0) to.objects.emplace_back();

    // What topology has found travels along only when both sides have it.
    const bool part_analysed = part.component.size() == count && part.face.size() == count;
    const bool to_analysed = to.component.size() == triangles && to.face.size() == triangles;
    CHECK(count == 0 || triangles == 0 || part_analysed == to_analysed,
          std::string("one mesh has been analysed, the other has not"));
    if (!part_analysed || !to_analysed) return;
    append_shifted(to.component, part.component, count, to.components.size());
    append_shifted(to.face, part.face, count, to.faces.size());
    append(to.components, part.components);
    append(to.faces, part.faces);
}

}  // namespace obscura
