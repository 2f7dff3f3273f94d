#pragma once
// Brute force for exact shadows, which shares nothing with raster/exact but what a sample and a mesh are:
// corners snapped in quadruple precision, coverage in integers of 128 bits, sides of planes in quadruple
// precision from the mesh's own floats.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "tests/raster/raster_oracle.h"

namespace obscura::oracle {

using Quad = __float128;

struct Vec3q {
    Quad x, y, z;
};
inline Vec3q quad(Vec3d v) {
    return {v.x, v.y, v.z};
}
inline Vec3q operator-(Vec3q a, Vec3q b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Quad dot(Vec3q a, Vec3q b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3q cross(Vec3q a, Vec3q b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Quad square_root(Quad v) {
    Quad r = std::sqrt(static_cast<double>(v));
    for (int k = 0; k < 3; ++k)
        r = r > 0 ? (r + v / r) / 2 : r;
    return r;
}

/// The definition at the top of raster/exact/exact.h, told once more.
class BruteForce {
  public:
    BruteForce(const Mesh& mesh, const Light& light, Vec3d eye, double snapping_per_m,
               const std::vector<Casters>& casters)
        : mesh_(mesh),
          light_(light),
          eye_(eye),
          snapping_(snapping_per_m),
          casters_(casters),
          snapped_(casters.size()) {
        for (std::size_t v = 0; v < casters.size(); ++v) {
            for (const Triangle& tri : mesh.triangles) {
                Snapped& s = snapped_[v].emplace_back();
                for (int k = 0; k < 3; ++k)
                    s.corners += snap(casters[v].view, mesh.positions[tri.v[k]], s.x[k], s.y[k], s.z_low);
            }
        }
    }

    /// 1 lit, 0 dark, -1 closer to the limit than quadruple precision of the planes' doubles can tell.
    int lit(Vec3d p, Vec3d g, const ref::ExactShadow& s, std::uint32_t own) const {
        const View& view = casters_[static_cast<std::size_t>(s.view)].view;
        bool unsure = false;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (mesh_.face[t] == mesh_.face[own]) continue;
            const Snapped& on_grid = snapped_[static_cast<std::size_t>(s.view)][t];
            const bool whole = on_grid.corners == 3;
            const int covered =
                whole ? oracle::covers(on_grid.x, on_grid.y, s.x, s.y) : meets_clipped(view, t, p);
            unsure |= covered < 0;
            if (covered <= 0) continue;
            const int side = behind(t, own, p, g, s);
            if (side < 0) unsure = true;
            if (side <= 0) continue;
            // Nearer to the light than the triangle's nearest corner: only where its plane is extrapolated.
            const Quad deeper = depth_of(view, p) - (on_grid.z_low - Quad(0x1p-22));
            if (!whole || deeper > 0x1p-23) return 0;
            unsure |= deeper > -0x1p-23;
        }
        return unsure ? -1 : 1;
    }

  private:
    /// A triangle on the grid of one view, as far as its corners need no clipping, and its nearest corner.
    struct Snapped {
        std::int32_t x[3] = {}, y[3] = {};
        int corners = 0;
        Quad z_low = 2;
    };
    /// Whether the light's ray through p meets a triangle that must be clipped, beyond the near plane: 1 yes,
    /// 0 no, -1 near an edge, whose cut corners are the clipper's to snap.
    int meets_clipped(const View& view, std::size_t t, Vec3d p) const {
        const Triangle& tri = mesh_.triangles[t];
        Vec3q corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = quad(to_double(mesh_.positions[tri.v[k]]));
        const Vec3q way = is_parallel(light_.kind) ? quad(light_.direction) : quad(p) - quad(light_.position);
        Quad volume[3], sum = 0;
        for (int k = 0; k < 3; ++k) {
            volume[k] = dot(way, cross(corner[(k + 1) % 3] - quad(p), corner[(k + 2) % 3] - quad(p)));
            sum += volume[k];
        }
        if (sum == 0) return -1;
        bool inside = true, clear = true;
        Quad w = 0;
        for (int k = 0; k < 3; ++k) {
            const Quad share = volume[k] / sum;
            inside = inside && share > 0;
            if (share < -1e-5) return 0;
            clear = clear && share > 1e-5;
            const Vec3f at = mesh_.positions[tri.v[k]];
            w += share * (view.perspective ? row(matrix_row(view, 3), to_double(at)) : Quad(1));
        }
        if (!clear) return -1;
        const Quad beyond = view.perspective ? w / view.near_w - 1 : Quad(1);
        if (beyond < -1e-6) return 0;
        return beyond > 1e-6 ? 1 : -1;
    }
    static Quad row(const Vec4d& m, Vec3d p) {
        return Quad(m.x) * p.x + Quad(m.y) * p.y + Quad(m.z) * p.z + Quad(m.w);
    }
    static Vec4d matrix_row(const View& view, int r) {
        const auto& m = view.to_map.m[r];
        return {m[0], m[1], m[2], m[3]};
    }
    static Quad depth_of(const View& view, Vec3d p) {
        const Quad w = view.perspective ? row(matrix_row(view, 3), p) : Quad(1);
        return row(matrix_row(view, 2), p) / w;
    }
    /// False when the corner must be clipped.
    static bool snap(const View& view, Vec3f corner, std::int32_t& x, std::int32_t& y, Quad& z_low) {
        const Vec3d p = to_double(corner);
        const Quad w = view.perspective ? row(matrix_row(view, 3), p) : Quad(1);
        if (view.perspective && w < Quad(view.near_w) * 1.000001) return false;
        const Quad X = row(matrix_row(view, 0), p) / w * 256, Y = row(matrix_row(view, 1), p) / w * 256;
        const Quad limit = Quad(1 << 20) * 256;
        if (X < -limit || Y < -limit || X > 2 * limit || Y > 2 * limit) return false;
        x = static_cast<std::int32_t>(std::nearbyint(static_cast<double>(X)));
        y = static_cast<std::int32_t>(std::nearbyint(static_cast<double>(Y)));
        z_low = std::min(z_low, row(matrix_row(view, 2), p) / w);
        return true;
    }
    /// Whether p lies behind the triangle's plane, seen from the light, by more than `uncertain`: 1 yes, 0
    /// no, -1 too close to tell.
    int behind(std::size_t t, std::size_t own, Vec3d p, Vec3d g, const ref::ExactShadow& s) const {
        const Triangle& tri = mesh_.triangles[t];
        const Vec3q a = quad(to_double(mesh_.positions[tri.v[0]])),
                    b = quad(to_double(mesh_.positions[tri.v[1]])),
                    c = quad(to_double(mesh_.positions[tri.v[2]]));
        const Vec3q n = cross(b - a, c - a);
        const Quad length = square_root(dot(n, n));
        if (length == 0) return -1;
        const Quad height = dot(n, quad(p) - a) / length;
        const Vec3q way = is_parallel(light_.kind) ? quad(-light_.direction) : quad(light_.position) - a;
        const Quad towards = dot(n, way) / length;
        // Triangles that the light sees edge on, and planes of slivers, are rounding alone.
        const Quad longest = square_root(std::max({dot(b - a, b - a), dot(c - a, c - a), dot(c - b, c - b)}));
        const Quad least_height = length / longest;
        // Triangles of one planar face have one plane, which passes by their corners (core/planar_faces.h).
        const Plane& plane = mesh_.faces[mesh_.face[t]];
        Quad off = 0;
        for (const std::uint32_t v : tri.v)
            off = std::max<Quad>(off, std::fabs(dot(plane.n, to_double(mesh_.positions[v])) + plane.d));
        const Quad doubt =
            2 * off + 1e-12 * (1 + std::fabs(static_cast<double>(a.x)) + longest) / (least_height / longest);
        const Quad signed_height = towards > 0 ? height : -height;
        if ((towards < 0 ? -towards : towards) <= doubt) return -1;
        const Quad behind = -signed_height - static_cast<double>(s.rounding_m);
        if ((behind < 0 ? -behind : behind) <= doubt) return -1;
        if (behind < 0) return 0;
        const int on = on_triangle(own, p);
        if (on > 0) return 1;
        // Beside its triangle, and camera and light see the same side: 1/256 pixel along the point's own
        // plane, across the other.
        const Quad eye_height = dot(n, quad(eye_) - a) / length;
        if ((eye_height > 0) != (towards > 0))
            return (eye_height < 0 ? -eye_height : eye_height) <= doubt ? -1 : 1;
        const Vec3d v = eye_ - p;
        const double reach = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z),
                     cosine = std::max(dot(g, v) / length_of(v), 1.0 / 16);
        const Vec3q sine = cross(quad(g), n);
        const Quad snap = snapping_ * reach / cosine * square_root(dot(sine, sine)) / length;
        const Quad beyond = behind - snap;
        if ((beyond < 0 ? -beyond : beyond) <= doubt + 1e-4 * snap + 1e-6 * snapping_ * reach) return -1;
        if (beyond > 0) return 1;
        return on < 0 ? -1 : 0;
    }
    /// Whether p is on the triangle, as far as edges go: 1 yes, 0 no, -1 too close to tell.
    int on_triangle(std::size_t t, Vec3d p) const {
        const Triangle& tri = mesh_.triangles[t];
        Vec3q c[3];
        for (int k = 0; k < 3; ++k)
            c[k] = quad(to_double(mesh_.positions[tri.v[k]]));
        const Vec3q n = cross(c[1] - c[0], c[2] - c[0]);
        bool inside = true, unsure = false;
        for (int k = 0; k < 3; ++k) {
            const Quad side = dot(n, cross(c[(k + 1) % 3] - c[k], quad(p) - c[k])) / dot(n, n);
            unsure = unsure || (side < 0 ? -side : side) < 1e-9;
            inside = inside && side > 0;
        }
        return unsure ? -1 : inside;
    }
    static double length_of(Vec3d v) { return std::sqrt(dot(v, v)); }

    const Mesh& mesh_;
    const Light& light_;
    Vec3d eye_;
    double snapping_;
    const std::vector<Casters>& casters_;
    std::vector<std::vector<Snapped>> snapped_;
};

}  // namespace obscura::oracle
