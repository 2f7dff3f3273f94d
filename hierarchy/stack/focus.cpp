#include "hierarchy/stack/focus.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// Light that falls on a plane falls by at least this a metre of its way.
constexpr double least_fall = 0.02;

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
    bool empty() const { return low > high; }
};

/// A sample in metres: where a point (u, v) at height h is seen on the plane is (u + s h) / (1 - tau h), and
/// so for v.
struct MetricView {
    double s = 0, t = 0, tau = 0;
};

/// The plane's own coordinates.
struct PlaneFrame {
    Basis basis;  ///< forward: away from the light
    Vec3d origin;

    explicit PlaneFrame(const FocusParams& params)
        : basis(look_basis(-params.plane_normal, {0, 1, 0})), origin(params.plane_point) {}
    Vec3d operator()(Vec3d p) const {
        const Vec3d d = p - origin;
        return {dot(basis.right, d), -dot(basis.up, d), -dot(basis.forward, d)};
    }
    MetricView view(Vec3d sample, bool directional) const {
        if (directional) {
            const double fall = dot(basis.forward, sample);
            return {dot(basis.right, sample) / fall, -dot(basis.up, sample) / fall, 0};
        }
        const Vec3d p = (*this)(sample);
        return {-p.x / p.z, -p.y / p.z, 1 / p.z};
    }
};

/// What the casters of a scene take up below the near plane.
struct CasterReach {
    Range height;
    Range u, v;  ///< of their shadows on the plane, from all samples
};

class Reach {
  public:
    Reach(const std::vector<MetricView>& views, double near_h) : near_h_(near_h) {
        for (const MetricView& view : views) {
            s_.add(view.s);
            t_.add(view.t);
            tau_.add(view.tau);
        }
    }
    CasterReach found;

    void add(Vec3d p) {
        found.height.add(p.z);
        for (const double tau : {tau_.low, tau_.high}) {
            const double scale = 1 / (1 - tau * p.z);
            for (const double s : {s_.low, s_.high})
                found.u.add((p.x + s * p.z) * scale);
            for (const double t : {t_.low, t_.high})
                found.v.add((p.y + t * p.z) * scale);
        }
    }

    /// Corners below the near plane, and where edges meet it.
    void add(const Vec3d (&corner)[3]) {
        for (int i = 0; i < 3; ++i) {
            const Vec3d p = corner[i], q = corner[(i + 1) % 3];
            if (p.z <= near_h_) add(p);
            if ((p.z <= near_h_) != (q.z <= near_h_)) {
                Vec3d cut = p + (q - p) * ((near_h_ - p.z) / (q.z - p.z));
                cut.z = near_h_;
                add(cut);
            }
        }
    }

  private:
    double near_h_;
    Range s_, t_, tau_;
};

bool casts(const Mesh& mesh, std::size_t triangle) {
    return mesh.objects.empty() || mesh.objects[mesh.object[triangle]].casts_shadow;
}

CasterReach reach_of(const Mesh& mesh, const PlaneFrame& plane, const std::vector<MetricView>& views,
                     double near_h) {
    Reach reach(views, near_h);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!casts(mesh, t)) continue;
        Vec3d corner[3];
        for (int i = 0; i < 3; ++i)
            corner[i] = plane(to_double(mesh.positions[mesh.triangles[t].v[i]]));
        reach.add(corner);
    }
    if (reach.found.height.empty()) reach.add(Vec3d{0, 0, 0});
    return reach.found;
}

/// Texels along one axis of the plane: scale and offset.
struct Axis {
    double per_m, offset;
};
Axis axis_of(Range range, double least_extent, int resolution) {
    // One texel of margin on every side.
    const double extent = std::max(range.high - range.low, least_extent);
    const double per_m = (resolution - 2) / extent;
    return {per_m, 0.5 * resolution - 0.5 * (range.low + range.high) * per_m};
}

void set_row(double (&row)[4], Vec3d axis, Vec3d origin, double scale, double offset) {
    row[0] = axis.x * scale;
    row[1] = axis.y * scale;
    row[2] = axis.z * scale;
    row[3] = offset - dot(axis, origin) * scale;
}

double projective_height(double h, double tau) {
    return h / (1 - tau * h);
}

}  // namespace

LightView FocusedViews::view(int k) const {
    CHECK(k >= 0 && static_cast<std::size_t>(k) < slices.size());
    const SliceView& s = slices[static_cast<std::size_t>(k)];
    const auto sx = static_cast<double>(s.sigma_x), sy = static_cast<double>(s.sigma_y),
               tau = static_cast<double>(s.tau);
    LightView view;
    view.width = view.height = resolution;
    view.perspective = s.tau != 0;
    for (int i = 0; i < 4; ++i) {
        const double one = i == 3 ? 1 : 0, w = one - tau * frame.h[i];
        view.to_map.m[0][i] = frame.a[i] + sx * frame.h[i];
        view.to_map.m[1][i] = frame.b[i] + sy * frame.h[i];
        view.to_map.m[2][i] = frame.depth_top * w - frame.depth_per_m * frame.h[i];
        view.to_map.m[3][i] = w;
    }
    if (view.perspective) view.near_w = 1 - tau * frame.near_h;
    return view;
}

bool can_focus(const LightSamples& samples, const FocusParams& params) {
    const PlaneFrame plane(params);
    return std::all_of(samples.at.begin(), samples.at.end(), [&](Vec3d sample) {
        return samples.directional ? dot(plane.basis.forward, sample) > least_fall : plane(sample).z > 0;
    });
}

FocusedViews focused_views(const Mesh& mesh, const LightSamples& samples, const FocusParams& params) {
    CHECK(std::has_single_bit(static_cast<unsigned>(params.resolution)) && params.resolution >= 4 &&
          params.resolution <= 1 << 16);
    CHECK(!samples.at.empty() && params.near_share > 0 && params.near_share < 1);
    CHECK(can_focus(samples, params), "a sample of the light is not above the plane of focus");
    const PlaneFrame plane(params);
    std::vector<MetricView> metric;
    double tau = 0, least_tau = std::numeric_limits<double>::infinity();
    for (const Vec3d& sample : samples.at) {
        metric.push_back(plane.view(sample, samples.directional));
        tau = std::max(tau, metric.back().tau);
        least_tau = std::min(least_tau, metric.back().tau);
    }

    // The near plane lies above all casters, or where the light begins.
    FocusedViews views;
    views.resolution = params.resolution;
    double near_h = tau > 0 ? (1 - params.near_share) / tau : 3e38;
    const CasterReach reach = reach_of(mesh, plane, metric, near_h);
    const double height = std::max(reach.height.high - reach.height.low, 1e-6);
    near_h = std::min(near_h, reach.height.high + 1e-3 * height);
    views.frame.near_h = near_h;

    const double extent = std::max({reach.u.high - reach.u.low, reach.v.high - reach.v.low, 1e-6});
    constexpr double longest_texel = 16;
    const Axis x = axis_of(reach.u, extent / longest_texel, params.resolution);
    const Axis y = axis_of(reach.v, extent / longest_texel, params.resolution);
    set_row(views.frame.a, plane.basis.right, plane.origin, x.per_m, x.offset);
    set_row(views.frame.b, -plane.basis.up, plane.origin, y.per_m, y.offset);
    set_row(views.frame.h, -plane.basis.forward, plane.origin, 1, 0);

    // Depth falls with g, from 0 at the near plane to 1 below everything, the same for all samples.
    const double low_h = reach.height.low - 1e-3 * height;
    const double top = std::max(projective_height(near_h, tau), projective_height(near_h, least_tau));
    const double bottom = std::min(projective_height(low_h, tau), projective_height(low_h, least_tau));
    views.frame.depth_per_m = 1 / (top - bottom);
    views.frame.depth_top = top * views.frame.depth_per_m;

    for (const MetricView& m : metric) {
        // In texels the origin of the plane's coordinates is at `offset`, and moves with tau.
        views.slices.push_back({static_cast<float>(m.s * x.per_m - x.offset * m.tau),
                                static_cast<float>(m.t * y.per_m - y.offset * m.tau),
                                static_cast<float>(m.tau)});
    }
    return views;
}

Vec3d median_plane_point(const Mesh& mesh, Vec3d normal, double below) {
    const Vec3d n = normalize(normal);
    std::vector<std::pair<double, double>> areas;  // height, area
    double all = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d p = to_double(mesh.positions[t.v[0]]), q = to_double(mesh.positions[t.v[1]]),
                    r = to_double(mesh.positions[t.v[2]]);
        const double area = 0.5 * dot(cross(q - p, r - p), n);
        const double height = dot(n, p + q + r) / 3;
        if (!(area > 0) || !(height < below)) continue;
        areas.emplace_back(height, area);
        all += area;
    }
    std::sort(areas.begin(), areas.end());
    double lower = 0;
    for (const auto& [height, area] : areas) {
        lower += area;
        if (lower >= 0.5 * all) return n * height;
    }
    return {0, 0, 0};
}

double parallax_texels(const Mesh& mesh, const FocusedViews& views) {
    double longest = 0;
    for (const Vec3f& v : mesh.positions) {
        const Vec3d p = to_double(v);
        const auto along = [&](const double(&m)[4]) { return m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3]; };
        const double a = along(views.frame.a), b = along(views.frame.b), h = along(views.frame.h);
        if (h >= views.frame.near_h) continue;
        Vec2d last;
        for (std::size_t k = 0; k < views.slices.size(); ++k) {
            const SliceView& s = views.slices[k];
            const double scale = 1 / (1 - static_cast<double>(s.tau) * h);
            const Vec2d at{(a + static_cast<double>(s.sigma_x) * h) * scale,
                           (b + static_cast<double>(s.sigma_y) * h) * scale};
            if (k > 0)
                longest = std::max(longest, std::max(std::fabs(at.x - last.x), std::fabs(at.y - last.y)));
            last = at;
        }
    }
    return longest;
}

}  // namespace obscura
