#include "stereo/surface_points.h"

#include <bit>

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
    LabelWelder(const std::vector<std::uint32_t>& weld, const std::vector<std::uint8_t>& split,
                std::size_t uses, UnionFind& sets)
        : weld_(weld), split_(split), sets_(sets), slots_(std::bit_ceil(2 * uses + 1)) {}

    void add(std::uint32_t vertex, std::uint32_t label) {
        const std::uint32_t at = weld_[vertex];
        if (split_[at] == 0) return;
        std::uint64_t h = (std::uint64_t{at} << 32 | label) * 0xff51afd7ed558ccdu;
        h ^= h >> 32;
        for (std::size_t slot = h;; ++slot) {
            Slot& s = slots_[slot & (slots_.size() - 1)];
            if (s.vertex == none) {
                s = {vertex, label};
                return;
            }
            if (weld_[s.vertex] == at && s.label == label) {
                sets_.unite(s.vertex, vertex);
                return;
            }
        }
    }

  private:
    struct Slot {
        std::uint32_t vertex = none, label = 0;
    };
    const std::vector<std::uint32_t>& weld_;
    const std::vector<std::uint8_t>& split_;
    UnionFind& sets_;
    std::vector<Slot> slots_;
};

/// Sets of vertices that are one point.
UnionFind one_point(const Mesh& mesh) {
    UnionFind sets(mesh.positions.size());
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    // Only where several vertices stand at one place is there anything to decide.
    std::vector<std::uint8_t> split(weld.size(), 0);
    for (std::uint32_t v = 0; v < weld.size(); ++v) {
        if (weld[v] != v) split[weld[v]] = 1;
    }
    std::size_t uses = 0;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t.v)
            uses += split[weld[v]];
    }
    if (uses == 0) return sets;
    for (const std::vector<std::uint32_t>* labels : {&mesh.object, &mesh.component}) {
        if (labels->empty()) continue;
        LabelWelder welder(weld, split, uses, sets);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (const std::uint32_t v : mesh.triangles[t].v)
                welder.add(v, (*labels)[t]);
        }
    }
    return sets;
}

}  // namespace

SurfacePoints surface_points(const Mesh& mesh, const MapProjection& projection, const Exec& exec) {
    CHECK(mesh.component.size() == mesh.triangles.size(), "moving a mesh needs its topology");
    CHECK(mesh.object.empty() || mesh.object.size() == mesh.triangles.size());
    UnionFind sets = one_point(mesh);
    SurfacePoints s;
    s.of_vertex.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < s.of_vertex.size(); ++v) {
        const std::uint32_t root = sets.root(v);
        if (root == v) {
            s.of_vertex[v] = static_cast<std::uint32_t>(s.points.size());
            SurfacePoint& p = s.points.emplace_back();
            p.position = mesh.positions[v];
            p.object = p.component = nothing_seen;
        } else {
            s.of_vertex[v] = s.of_vertex[root];
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t].v) {
            SurfacePoint& p = s.points[s.of_vertex[v]];
            if (p.component != nothing_seen) continue;
            p.object = mesh.object.empty() ? 0 : mesh.object[t];
            p.component = mesh.component[t];
        }
    }
    parallel_blocks(s.points.size(), 4096, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            s.points[i].map = projection.project(s.points[i].position);
    });
    return s;
}

}  // namespace obscura
