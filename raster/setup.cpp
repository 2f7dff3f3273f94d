#include "raster/setup.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "raster/clip.h"
#include "raster/transform.h"

namespace obscura {
namespace {

constexpr std::size_t block_triangles = 4096;
constexpr std::size_t block_vertices = 8192;

// Depths as integers of the same order, so that their minimum can be an integer minimum.
std::int32_t ordered(float z) {
    const auto bits = std::bit_cast<std::int32_t>(z);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}
float from_ordered(std::int32_t i) {
    return std::bit_cast<float>(i < 0 ? i ^ 0x7fffffff : i);
}

// Minima and maxima do not depend on the order they are taken in, so these atomics keep results
// deterministic.
void lower_to(std::int32_t& target, std::int32_t value) {
    const std::atomic_ref<std::int32_t> shared(target);
    std::int32_t seen = shared.load(std::memory_order_relaxed);
    while (value < seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
}
void raise_to(std::int32_t& target, std::int32_t value) {
    const std::atomic_ref<std::int32_t> shared(target);
    std::int32_t seen = shared.load(std::memory_order_relaxed);
    while (value > seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
}

VertexMap vertex_map(const View& view) {
    VertexMap map{};
    std::copy_n(&view.to_map.m[0][0], 16, &map.m[0][0]);
    map.near_w = view.near_w;
    map.low_x = map.low_y = -guard_band_texels;
    map.high_x = view.width + guard_band_texels;
    map.high_y = view.height + guard_band_texels;
    map.min_depth = view.min_depth;
    map.max_depth = view.max_depth;
    map.perspective = view.perspective;
    return map;
}

/// Whether any vertex must be clipped.
bool transform_all(const Mesh& mesh, const View& view, const Exec& exec, Buffer<MapVertex>& out) {
    out.reset(mesh.positions.size());
    const VertexMap map = vertex_map(view);
    const float* xyz = &mesh.positions.data()->x;
    std::vector<int> clipped((out.size() + block_vertices - 1) / block_vertices, 0);
    parallel_blocks(out.size(), block_vertices, exec, [&](std::size_t begin, std::size_t end) {
        OBSCURA_DISPATCH(exec.isa, transform_vertices, xyz, begin, end, map, out.data());
        int any = 0;
        for (std::size_t i = begin; i < end; ++i)
            any |= out[i].clip;
        clipped[begin / block_vertices] = any;
    });
    return std::any_of(clipped.begin(), clipped.end(), [](int clip) { return clip != 0; });
}

/// Depth range of one triangle, as ordered integers.
struct OrderedRange {
    std::int32_t low, high;
};
OrderedRange triangle_range(const Mesh& mesh, const View& view, const TriangleSetup& s, std::size_t t) {
    const Triangle& tri = mesh.triangles[t];
    const MapVertex &p = s.vertices[tri.v[0]], &q = s.vertices[tri.v[1]], &r = s.vertices[tri.v[2]];
    // Depth means nothing before the near plane: a face that reaches there may have any.
    if (((p.clip | q.clip | r.clip) & clip_near) != 0)
        return {ordered(view.min_depth), ordered(view.max_depth)};
    return {ordered(std::min({p.z, q.z, r.z})), ordered(std::max({p.z, q.z, r.z}))};
}

/// Planes of faces whose triangles stand one after the other, as meshes mostly come: one pass, each block of
/// triangles takes the faces that begin in it.
void planes_of_runs(const Mesh& mesh, const View& view, const Mat4& from_map, const Exec& exec,
                    TriangleSetup& s) {
    const std::size_t triangles = mesh.triangles.size();
    parallel_blocks(triangles, block_triangles, exec, [&](std::size_t begin, std::size_t end) {
        std::size_t t = begin;
        while (t < end && t > 0 && mesh.face[t] == mesh.face[t - 1])
            ++t;
        while (t < end) {
            const std::uint32_t face = mesh.face[t];
            OrderedRange range = triangle_range(mesh, view, s, t);
            for (++t; t < triangles && mesh.face[t] == face; ++t) {
                const OrderedRange next = triangle_range(mesh, view, s, t);
                range = {std::min(range.low, next.low), std::max(range.high, next.high)};
            }
            s.planes[face] =
                depth_plane(mesh.faces[face], from_map, from_ordered(range.low), from_ordered(range.high));
        }
    });
}

/// Planes of faces whose triangles are scattered over the mesh.
void planes_of_scattered(const Mesh& mesh, const View& view, const Mat4& from_map, const Exec& exec,
                         TriangleSetup& s) {
    const std::size_t faces = mesh.faces.size();
    s.face_low.reset(faces);
    s.face_high.reset(faces);
    std::fill(s.face_low.begin(), s.face_low.end(), ordered(view.max_depth));
    std::fill(s.face_high.begin(), s.face_high.end(), ordered(view.min_depth));
    parallel_blocks(mesh.triangles.size(), block_triangles, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const OrderedRange range = triangle_range(mesh, view, s, t);
            lower_to(s.face_low[mesh.face[t]], range.low);
            raise_to(s.face_high[mesh.face[t]], range.high);
        }
    });
    parallel_blocks(faces, block_triangles, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            s.planes[f] = depth_plane(mesh.faces[f], from_map, from_ordered(s.face_low[f]),
                                      from_ordered(s.face_high[f]));
        }
    });
}

/// One depth plane for each planar face, with the depth range of all its triangles.
void face_planes(const Mesh& mesh, const View& view, const Exec& exec, TriangleSetup& s) {
    s.planes.reset(mesh.faces.size());
    const Mat4 from_map = inverse(view.to_map);
    // Faces are numbered by their first triangle, so in a mesh of runs the numbers never fall.
    std::vector<int> falls((mesh.face.size() + block_triangles - 1) / block_triangles, 0);
    parallel_blocks(mesh.face.size(), block_triangles, exec, [&](std::size_t begin, std::size_t end) {
        const std::size_t last = std::min(end + 1, mesh.face.size());
        falls[begin / block_triangles] = !std::is_sorted(mesh.face.data() + begin, mesh.face.data() + last);
    });
    const bool runs = std::find(falls.begin(), falls.end(), 1) == falls.end();
    runs ? planes_of_runs(mesh, view, from_map, exec, s) : planes_of_scattered(mesh, view, from_map, exec, s);
}

struct SnappedVertex {
    std::int32_t x, y;
};

/// Whether no texel centre lies in [low, high], fixed point.
bool between_centres(std::int32_t low, std::int32_t high) {
    return ((low - 128 + 255) >> subtexel_bits) > ((high - 128) >> subtexel_bits);
}

/// Turns one block of triangles into records.
class BlockSetup {
  public:
    BlockSetup(const Mesh& mesh, const View& view, const SetupParams& params, TriangleSetup& setup)
        : mesh_(mesh),
          view_(view),
          params_(params),
          setup_(setup),
          only_casters_(params.only_casters && !mesh.objects.empty()) {
        const Region region = params.region.empty() ? Region{0, 0, view.width, view.height} : params.region;
        x_begin_ = region.x0 * subtexel_one;
        y_begin_ = region.y0 * subtexel_one;
        x_end_ = (region.x0 + region.width) * subtexel_one;
        y_end_ = (region.y0 + region.height) * subtexel_one;
    }

    void run(std::size_t begin, std::size_t end, RecordBlock& block) {
        out_ = begin_ = setup_.records.data() + block.begin;
        for (std::size_t t = begin; t < end; ++t) {
            if (only_casters_ && !mesh_.objects[mesh_.object[t]].casts_shadow) continue;
            const Triangle& tri = mesh_.triangles[t];
            const MapVertex &p = setup_.vertices[tri.v[0]], &q = setup_.vertices[tri.v[1]],
                            &r = setup_.vertices[tri.v[2]];
            const auto id = static_cast<std::uint32_t>(t);
            if ((p.clip & q.clip & r.clip & clip_near) != 0) continue;  // nothing of it is left
            if ((p.clip | q.clip | r.clip) == 0) {
                emit(id, {p.x, p.y}, {q.x, q.y}, {r.x, r.y});
            } else {
                emit_clipped(id, tri);
            }
        }
        block.count = static_cast<std::size_t>(out_ - begin_);
    }

  private:
    void emit(std::uint32_t t, SnappedVertex p, SnappedVertex q, SnappedVertex r) {
        const std::int32_t x_low = std::min(std::min(p.x, q.x), r.x),
                           x_high = std::max(std::max(p.x, q.x), r.x);
        const std::int32_t y_low = std::min(std::min(p.y, q.y), r.y),
                           y_high = std::max(std::max(p.y, q.y), r.y);
        // What reaches no sample gives no record.
        if (x_high < x_begin_ || y_high < y_begin_ || x_low >= x_end_ || y_low >= y_end_) return;
        if (params_.centre_samples_only &&
            (between_centres(x_low, x_high) || between_centres(y_low, y_high))) {
            return;
        }
        const std::int64_t area = static_cast<std::int64_t>(q.x - p.x) * (r.y - p.y) -
                                  static_cast<std::int64_t>(r.x - p.x) * (q.y - p.y);
        if (area == 0 && !params_.keep_flat) return;

        // Y points down in map space, so what is counter-clockwise for the viewer has a negative area.
        const bool front = area < 0;
        const bool closed = mesh_.components[mesh_.component[t]].closed;
        const Crossing crossing = !closed ? Crossing::open : (front ? Crossing::entry : Crossing::exit);
        if (params_.culling == Culling::back_faces && !front) return;
        if (front) std::swap(q, r);

        const DepthPlane plane = params_.depth_planes ? setup_.planes[mesh_.face[t]] : depth_range(t);
        *out_++ = {{p.x, q.x, r.x}, {p.y, q.y, r.y}, plane.a, plane.b, plane.c,
                   plane.zmin,      plane.zmax,      t,       crossing};
        if (params_.pair_faces) pair_with_last();
    }

    DepthPlane depth_range(std::uint32_t t) const {
        const OrderedRange range = triangle_range(mesh_, view_, setup_, t);
        DepthPlane plane;
        plane.zmin = from_ordered(range.low);
        plane.zmax = from_ordered(range.high);
        return plane;
    }

    /// Makes a pair of the last two records where they are the halves of a convex quadrilateral: one planar
    /// face, one crossing, an edge in common, and no corner that turns in.
    void pair_with_last() {
        if (out_ - begin_ < 2) return;
        TriangleRecord* const p = out_ - 2;
        TriangleRecord* const q = out_ - 1;
        if (p->second || q->crossing != p->crossing) return;
        if (mesh_.face[p->triangle] != mesh_.face[q->triangle]) return;
        for (int k = 0; k < 3; ++k) {
            for (int l = 0; l < 3; ++l) {
                // Corners k + 2 -> k of the one run as corners l + 2 -> l of the other, the other way.
                const int k2 = (k + 2) % 3, l2 = (l + 2) % 3;
                if (p->x[k] != q->x[l2] || p->y[k] != q->y[l2] || p->x[k2] != q->x[l] || p->y[k2] != q->y[l])
                    continue;
                turn(*p, k);
                turn(*q, l);
                p->paired = turns_out(*q, 1, *p, 0, *p, 1) && turns_out(*p, 1, *p, 2, *q, 1);
                q->second = p->paired;
                return;
            }
        }
    }

    /// Renumbers the corners so that corner k comes first.
    static void turn(TriangleRecord& t, int k) {
        std::rotate(t.x, t.x + k, t.x + 3);
        std::rotate(t.y, t.y + k, t.y + 3);
    }

    /// Whether the way over three corners turns to the inside or goes straight on.
    static bool turns_out(const TriangleRecord& a, int i, const TriangleRecord& b, int j,
                          const TriangleRecord& c, int k) {
        const std::int64_t ux = b.x[j] - std::int64_t{a.x[i]}, uy = b.y[j] - std::int64_t{a.y[i]};
        const std::int64_t vx = c.x[k] - std::int64_t{b.x[j]}, vy = c.y[k] - std::int64_t{b.y[j]};
        return ux * vy - uy * vx >= 0;
    }

    void emit_clipped(std::uint32_t t, const Triangle& tri) {
        std::vector<ClipVertex> corners(3);
        for (int k = 0; k < 3; ++k) {
            // The same operations in the same order as transform_vertices: an untouched corner must snap
            // alike.
            const Vec3d p = to_double(mesh_.positions[tri.v[k]]);
            corners[static_cast<std::size_t>(k)] = view_.to_map * Vec4d{p.x, p.y, p.z, 1.0};
        }
        corners = clip_polygon(std::move(corners), view_);
        const auto snapped = [&](const ClipVertex& v) {
            const double inv = view_.perspective ? 1.0 / v.w : 1.0;
            return SnappedVertex{static_cast<std::int32_t>(std::nearbyint(v.x * inv * subtexel_one)),
                                 static_cast<std::int32_t>(std::nearbyint(v.y * inv * subtexel_one))};
        };
        // A fan; should snapping turn one of its triangles over, that triangle counts with its own facing and
        // the balance of the whole stays right.
        for (std::size_t k = 2; k < corners.size(); ++k) {
            emit(t, snapped(corners[0]), snapped(corners[k - 1]), snapped(corners[k]));
        }
    }

    const Mesh& mesh_;
    const View& view_;
    const SetupParams& params_;
    TriangleSetup& setup_;
    std::int32_t x_begin_, y_begin_, x_end_, y_end_;  ///< the region, fixed point
    bool only_casters_;                               ///< a mesh without named objects casts as a whole
    TriangleRecord *begin_ = nullptr, *out_ = nullptr;
};

/// Room for each block: one record a triangle, but six where a triangle must be clipped (eight corners at
/// most).
void lay_out_blocks(const Mesh& mesh, bool clipping, const Exec& exec, TriangleSetup& s) {
    const std::size_t triangles = mesh.triangles.size();
    s.blocks.assign((triangles + block_triangles - 1) / block_triangles, {});
    std::vector<std::size_t> room(s.blocks.size());
    parallel_for(s.blocks.size(), exec, [&](std::size_t b) {
        const std::size_t begin = b * block_triangles, end = std::min(begin + block_triangles, triangles);
        room[b] = end - begin;
        if (!clipping) return;
        for (std::size_t t = begin; t < end; ++t) {
            const Triangle& tri = mesh.triangles[t];
            const MapVertex &p = s.vertices[tri.v[0]], &q = s.vertices[tri.v[1]], &r = s.vertices[tri.v[2]];
            const bool all_before = (p.clip & q.clip & r.clip & clip_near) != 0;
            if (!all_before && (p.clip | q.clip | r.clip) != 0) room[b] += 5;
        }
    });
    std::size_t next = 0;
    for (std::size_t b = 0; b < s.blocks.size(); ++b) {
        s.blocks[b].begin = next;
        next += room[b];
    }
    s.records.reset(next);
}

}  // namespace

DepthPlane depth_plane(const Plane& world, const Mat4& from_map, float zmin, float zmax) {
    // A plane is a row vector: with p = from_map * q, (n, d) . p = ((n, d) from_map) . q.
    const double row[4] = {world.n.x, world.n.y, world.n.z, world.d};
    double map[4];
    for (int j = 0; j < 4; ++j) {
        map[j] = (row[0] * from_map.m[0][j] + row[1] * from_map.m[1][j]) +
                 (row[2] * from_map.m[2][j] + row[3] * from_map.m[3][j]);
    }
    DepthPlane plane;
    plane.zmin = zmin;
    plane.zmax = zmax;
    const double inv = -1.0 / map[2];
    plane.a = map[0] * inv;
    plane.b = map[1] * inv;
    plane.c = map[3] * inv;
    // Slopes past 2^40 say nothing within one texel; and inf or NaN must not reach the sample loops.
    constexpr double steepest = 1099511627776.0;
    if (!(std::fabs(plane.a) < steepest && std::fabs(plane.b) < steepest &&
          std::fabs(plane.c) < steepest * 1e6)) {
        plane.a = plane.b = 0.0;
        plane.c = 0.5 * static_cast<double>(zmin) + 0.5 * static_cast<double>(zmax);
    }
    return plane;
}

void setup_triangles(const Mesh& mesh, const View& view, const SetupParams& params, const Exec& exec,
                     TriangleSetup& setup) {
    CHECK(mesh.component.size() == mesh.triangles.size() && mesh.face.size() == mesh.triangles.size(),
          "setup_triangles needs a mesh with topology");
    CHECK(mesh.objects.empty() || mesh.object.size() == mesh.triangles.size(),
          "every triangle needs its object");
    const Region& region = params.region;
    // Past the view it may reach as far as positions are kept, which the guard band is wider than by far.
    constexpr int most_past = 1 << 16;
    CHECK(region.empty() || (region.x0 >= -most_past && region.y0 >= -most_past &&
                             region.width <= view.width + most_past - region.x0 &&
                             region.height <= view.height + most_past - region.y0),
          "the region must lie about the view");
    CHECK(view.width <= (1 << 20) && view.height <= (1 << 20));
    setup.blocks.clear();
    if (mesh.triangles.empty()) return;
    const bool clipping = transform_all(mesh, view, exec, setup.vertices);
    if (params.depth_planes) face_planes(mesh, view, exec, setup);
    lay_out_blocks(mesh, clipping, exec, setup);
    parallel_for(setup.blocks.size(), exec, [&](std::size_t b) {
        const std::size_t begin = b * block_triangles;
        BlockSetup(mesh, view, params, setup)
            .run(begin, std::min(begin + block_triangles, mesh.triangles.size()), setup.blocks[b]);
    });
}

}  // namespace obscura
