#include "stereo/surface_points.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "core/edges.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/union_find.h"
#include "stereo/middle_view.h"

namespace obscura {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

/// Unites vertices of equal position whose triangles have equal labels. The smallest vertex of a set is its
/// root, so the order of triangles does not matter.
class LabelWelder {
  public:
    LabelWelder(const std::vector<std::uint32_t>& weld, UnionFind& sets)
        : weld_(weld), sets_(sets), first_(weld.size(), none) {}

    void add(std::uint32_t vertex, std::uint32_t label) {
        std::uint32_t* at = &first_[weld_[vertex]];
        while (*at != none && entries_[*at].label != label)
            at = &entries_[*at].next;
        if (*at != none) {
            sets_.unite(entries_[*at].vertex, vertex);
            return;
        }
        *at = static_cast<std::uint32_t>(entries_.size());
        entries_.push_back({label, vertex, none});
    }

  private:
    struct Entry {
        std::uint32_t label, vertex, next;
    };
    const std::vector<std::uint32_t>& weld_;
    UnionFind& sets_;
    std::vector<std::uint32_t> first_;  ///< per position: its list of labels
    std::vector<Entry> entries_;
};

/// Sets of vertices that are one point.
UnionFind one_point(const Mesh& mesh) {
    UnionFind sets(mesh.positions.size());
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    std::vector<std::uint8_t> apart(weld.size());
    for (const std::vector<std::uint32_t>* labels : {&mesh.object, &mesh.component}) {
        if (labels->empty()) continue;
        // Only where several vertices at one place are not yet one is there anything to decide.
        std::fill(apart.begin(), apart.end(), std::uint8_t{0});
        for (std::uint32_t v = 0; v < weld.size(); ++v) {
            if (sets.root(v) != sets.root(weld[v])) apart[weld[v]] = 1;
        }
        for (std::uint32_t v = 0; v < weld.size(); ++v)
            apart[v] = apart[weld[v]];
        LabelWelder welder(weld, sets);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (const std::uint32_t v : mesh.triangles[t].v) {
                if (apart[v] != 0) welder.add(v, (*labels)[t]);
            }
        }
    }
    return sets;
}

/// Several points at one position, in order of their changes.
class Touching {
  public:
    explicit Touching(std::vector<SurfacePoint>& points) : points_(points) {}

    /// Unites the points of `group` whose changes are within reach of the lowest of them, then of the lowest
    /// of the others, and so on.
    void join(std::vector<std::uint32_t>& group, double within_px, UnionFind& sets) {
        std::sort(group.begin(), group.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tuple(points_[a].change_px, a) < std::tuple(points_[b].change_px, b);
        });
        for (std::size_t first = 0; first < group.size();) {
            std::size_t end = first + 1;
            while (end < group.size() && change(group[end]) - change(group[first]) <= within_px)
                ++end;
            if (end - first > 1) unite({group.data() + first, end - first}, sets);
            first = end;
        }
    }

  private:
    double change(std::uint32_t p) const { return static_cast<double>(points_[p].change_px); }

    void unite(std::span<const std::uint32_t> group, UnionFind& sets) {
        const bool seen = std::any_of(group.begin(), group.end(), [&](auto p) { return points_[p].seen; });
        double sum = 0;
        int count = 0;
        for (const std::uint32_t p : group) {
            sets.unite(group[0], p);
            if (points_[p].seen != seen) continue;
            sum += change(p);
            ++count;
        }
        for (const std::uint32_t p : group) {
            points_[p].change_px = static_cast<float>(sum / count);
            points_[p].seen = seen;
        }
    }

    std::vector<SurfacePoint>& points_;
};

}  // namespace

SurfacePoints surface_points(const Mesh& mesh, const MapProjection& projection, const Exec& exec) {
    CHECK(mesh.component.size() == mesh.triangles.size(), "moving a mesh needs its topology");
    CHECK(mesh.object.empty() || mesh.object.size() == mesh.triangles.size());
    UnionFind sets = one_point(mesh);
    SurfacePoints s;
    s.of_vertex.resize(mesh.positions.size());
    std::vector<std::uint32_t> first_vertex, first_triangle;
    for (std::uint32_t v = 0; v < s.of_vertex.size(); ++v) {
        const std::uint32_t root = sets.root(v);
        s.of_vertex[v] = root == v ? static_cast<std::uint32_t>(first_vertex.size()) : s.of_vertex[root];
        if (root == v) first_vertex.push_back(v);
    }
    first_triangle.assign(first_vertex.size(), none);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t].v) {
            std::uint32_t& first = first_triangle[s.of_vertex[v]];
            if (first == none) first = t;
        }
    }
    s.points.resize(first_vertex.size());
    parallel_blocks(s.points.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            SurfacePoint& p = s.points[i];
            const std::uint32_t t = first_triangle[i];
            p.position = mesh.positions[first_vertex[i]];
            p.component = t == none ? nothing_seen : mesh.component[t];
            p.object = t == none ? nothing_seen : mesh.object.empty() ? 0 : mesh.object[t];
            p.map = projection.project(p.position);
        }
    });
    return s;
}

void join_touching(const Mesh& mesh, double within_px, SurfacePoints& surface) {
    // Points by position: of each the first vertex, its position's first vertex, and the points met there.
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    std::vector<std::uint32_t> first_point(weld.size(), none), next(surface.points.size(), none);
    UnionFind sets(surface.points.size());
    std::vector<std::uint8_t> met(surface.points.size(), 0);
    for (std::uint32_t v = 0; v < weld.size(); ++v) {
        const std::uint32_t p = surface.of_vertex[v];
        if (met[p] != 0) continue;
        met[p] = 1;
        next[p] = first_point[weld[v]];
        first_point[weld[v]] = p;
    }
    Touching touching(surface.points);
    std::vector<std::uint32_t> group;
    for (const std::uint32_t first : first_point) {
        if (first == none || next[first] == none) continue;
        group.clear();
        for (std::uint32_t p = first; p != none; p = next[p])
            group.push_back(p);
        touching.join(group, within_px, sets);
    }

    // The first of a set stays; numbers close up.
    std::vector<std::uint32_t> kept(surface.points.size());
    std::uint32_t count = 0;
    for (std::uint32_t p = 0; p < kept.size(); ++p) {
        const std::uint32_t root = sets.root(p);
        kept[p] = root == p ? count++ : kept[root];
        if (root == p) surface.points[kept[p]] = surface.points[p];
    }
    surface.points.resize(count);
    for (std::uint32_t& p : surface.of_vertex)
        p = kept[p];
}

}  // namespace obscura
