#include "stereo/vertex_gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/affine_fit.h"

namespace obscura {
namespace {

/// Weight in [0, 1] of the sample at pixel (x, y) for a point `place` pixels from the map's corner and `at`
/// metres from the eye; 0: not its surface.
double sample_weight(const SeenChange& seen, int x, int y, const Vec2d& place, const Vec3d& at, double z) {
    const double dx = x + 0.5 - place.x, dy = y + 0.5 - place.y;
    const double reach = seen.radius_px + 0.5, distance2 = dx * dx + dy * dy;
    const double near_by = 1.0 - distance2 / (reach * reach);
    if (!(near_by > 0)) return 0;

    // How far the surface may turn away from the sample's tangent plane before it is another one: as far as
    // the two are apart on the screen. Precisely that is the distance of a ball's outline from the tangent
    // plane of any sample inside it.
    const auto sample_z = static_cast<double>(seen.view.depth_m(x, y));
    const double pixel_m = std::max(z, sample_z) / seen.projection.focal_px;
    const double apart_m = (std::sqrt(distance2) + 0.5) * pixel_m;
    const Vec3d ray = seen.projection.ray(x + 0.5, y + 0.5);
    const Vec3d n = to_double(seen.view.normal(x, y));
    const double off_plane = std::fabs(dot(n, at - ray * sample_z)) / apart_m;
    if (!(off_plane < 1.0)) return 0;

    // A plane goes on behind what hides it. Depth may not differ by much more than the slope asks for.
    const double towards = std::max(-dot(n, ray) / length(ray), 0.02);
    const double slope = std::sqrt(std::max(1.0 - towards * towards, 0.0)) / towards;
    const double off_depth = std::fabs(z - sample_z) / (apart_m * (2.0 + 2.0 * slope));
    if (!(off_depth < 1.0)) return 0;
    return near_by * near_by * (1.0 - off_plane * off_plane) * (1.0 - off_depth * off_depth);
}

/// The scale of the law that made the view's disparity, from its nearest and farthest pixel.
double disparity_scale(const MiddleView& view) {
    std::size_t nearest = 0, farthest = 0;
    bool any = false;
    const std::vector<float>& z = view.depth_m.pixels;
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (view.triangle.pixels[i] == nothing_seen) continue;
        if (!any || z[i] < z[nearest]) nearest = i;
        if (!any || z[i] > z[farthest]) farthest = i;
        any = true;
    }
    if (!any || !(z[farthest] > z[nearest])) return 0;
    const auto inverse = [&](std::size_t i) { return 1.0 / static_cast<double>(z[i]); };
    const auto disparity = [&](std::size_t i) { return static_cast<double>(view.disparity.pixels[i]); };
    return (disparity(nearest) - disparity(farthest)) / (inverse(nearest) - inverse(farthest));
}

}  // namespace

SeenChange seen_change(const Mesh& mesh, const Camera& camera, const MiddleView& view,
                       const DisparityMap& optimised, int radius_px, const Exec& exec) {
    const auto fits = [&](const auto& image) {
        return image.width == view.width() && image.height == view.height();
    };
    CHECK(fits(optimised) && fits(view.depth_m) && fits(view.normal) && fits(view.object) &&
          fits(view.triangle));
    CHECK(radius_px >= 0);
    SeenChange seen{view,      map_projection(camera, view),
                    optimised, Image<std::uint32_t>(view.width(), view.height()),
                    radius_px, disparity_scale(view)};
    parallel_for(static_cast<std::size_t>(view.height()), exec, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < view.width(); ++x) {
            const std::uint32_t t = view.triangle(x, y);
            CHECK(t == nothing_seen || t < mesh.triangles.size());
            seen.change_px(x, y) -= view.disparity(x, y);
            CHECK(t == nothing_seen || std::isfinite(seen.change_px(x, y)),
                  fmt::format("the map at {}, {} is {}", x, y, optimised(x, y)));
            seen.component(x, y) = t == nothing_seen ? nothing_seen : mesh.component[t];
        }
    });
    return seen;
}

std::optional<float> gather_change(const SeenChange& seen, const SurfacePoint& point) {
    const MapProjection& projection = seen.projection;
    if (!projection.in_front(point.map) || point.component == nothing_seen) return std::nullopt;
    const Vec2d place{point.map.column(), point.map.row()};
    const double reach = seen.radius_px + 0.5;
    // Written so that numbers too large for an int stay outside.
    if (!(place.x > -reach && place.x < seen.view.width() + reach && place.y > -reach &&
          place.y < seen.view.height() + reach))
        return std::nullopt;
    const int x0 = std::max(static_cast<int>(std::floor(place.x - reach)), 0),
              y0 = std::max(static_cast<int>(std::floor(place.y - reach)), 0);
    const int x1 = std::min(static_cast<int>(std::floor(place.x + reach)), seen.view.width() - 1),
              y1 = std::min(static_cast<int>(std::floor(place.y + reach)), seen.view.height() - 1);
    const Vec3d at = to_double(point.position) - projection.eye;
    const double own = seen.scale / point.map.z;
    AffineFit fit;
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            if (seen.view.triangle(x, y) == nothing_seen) continue;
            if (seen.component(x, y) != point.component && seen.view.object(x, y) != point.object) continue;
            const double weight = sample_weight(seen, x, y, place, at, point.map.z);
            if (!(weight > 0)) continue;
            const auto sample_z = static_cast<double>(seen.view.depth_m(x, y));
            fit.add({x + 0.5 - place.x, y + 0.5 - place.y, seen.scale / sample_z - own},
                    static_cast<double>(seen.change_px(x, y)), weight);
        }
    }
    if (fit.empty()) return std::nullopt;
    return static_cast<float>(fit.at({}, 1.0));
}

float change_at_place(const SeenChange& seen, const MapPoint& place) {
    // Behind the camera there is no place; the middle is as good as any.
    const bool ahead = seen.projection.in_front(place);
    const double column = ahead ? place.column() : 0.5 * seen.view.width();
    const double row = ahead ? place.row() : 0.5 * seen.view.height();
    const double x = std::clamp(std::floor(column), 0.0, seen.view.width() - 1.0);
    const double y = std::clamp(std::floor(row), 0.0, seen.view.height() - 1.0);
    return seen.change_px(static_cast<int>(x), static_cast<int>(y));
}

}  // namespace obscura
