// Last frame's change in this frame's map; see warm_start.h.

#include "stereo/warm_start.h"

#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "core/scene.h"
#include "raster/view.h"
#include "stereo/map_columns.h"
#include "stereo/upsample.h"

namespace obscura {
namespace {

/// Between pixels of a middle view and the world.
class PixelRays {
  public:
    explicit PixelRays(const SeenFrame& frame)
        : basis_(look_basis(frame.camera.look_at - frame.camera.eye, frame.camera.up)),
          eye_(frame.camera.eye),
          view_(frame.view) {
        CHECK(frame.camera.kind == CameraKind::perspective);
        const double half = frame.camera.vfov_deg / 360 * num::pi;
        focal_px_ = 0.5 * view_.picture_height / num::tan(half);
    }

    /// The point at `depth_m` in pixel (x, y) of the map.
    Vec3d point(int x, int y, double depth_m) const {
        const double u = (picture_x(view_, x) - 0.5 * view_.picture_width) / focal_px_;
        const double v = (picture_y(view_, y) - 0.5 * view_.picture_height) / focal_px_;
        return eye_ + (basis_.forward + basis_.right * u - basis_.up * v) * depth_m;
    }

    /// Where the map sees a point: x, y in its pixels, centres at whole numbers; z the depth. Nothing when it
    /// lies behind. (The last, narrower block of a reduced map samples up to a few pixels nearer; a start
    /// need not know.)
    std::optional<Vec3d> place(const Vec3d& world) const {
        const Vec3d d = world - eye_;
        const double z = dot(d, basis_.forward);
        if (!(z > 0)) return std::nullopt;
        const double x = dot(d, basis_.right) / z * focal_px_ + 0.5 * view_.picture_width + view_.margin_px;
        const double y = -dot(d, basis_.up) / z * focal_px_ + 0.5 * view_.picture_height;
        const int n = view_.reduction;
        const double first = 0.5 + sampled_pixel(0, n, n);  // centre of the first sample
        return Vec3d{(x - first) / n, (y - first) / n, z};
    }

  private:
    Basis basis_;
    Vec3d eye_;
    const MiddleView& view_;
    double focal_px_ = 0;
};

/// Bilinear over the samples that show `object` at depth `at.z`; nothing when there are none.
std::optional<float> sample(const MiddleView& view, const Image<float>& change, std::uint32_t object,
                            const Vec3d& at, double tolerance) {
    if (!(at.x > -1 && at.x < view.width() && at.y > -1 && at.y < view.height())) return std::nullopt;
    const int x0 = static_cast<int>(std::floor(at.x)), y0 = static_cast<int>(std::floor(at.y));
    const double u = at.x - x0, v = at.y - y0;
    double sum = 0, weight = 0;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const int x = x0 + i, y = y0 + j;
            if (x < 0 || y < 0 || x >= view.width() || y >= view.height()) continue;
            if (view.object(x, y) != object) continue;
            if (!(std::abs(static_cast<double>(view.depth_m(x, y)) - at.z) <= tolerance * at.z)) continue;
            // A little for all, so that a lone sample counts wherever the place lies.
            const double w = (i == 0 ? 1 - u : u) * (j == 0 ? 1 - v : v) + 1e-6;
            sum += w * static_cast<double>(change(x, y));
            weight += w;
        }
    }
    if (weight == 0) return std::nullopt;
    return static_cast<float>(sum / weight);
}

}  // namespace

Image<float> carried_change(const SeenFrame& previous, const Image<float>& change, const SeenFrame& current,
                            const WarmStartParams& params, const Exec& exec) {
    const MiddleView& view = current.view;
    CHECK(change.width == previous.view.width() && change.height == previous.view.height());
    const PixelRays before(previous), now(current);
    const std::vector<std::optional<float>> means = mean_change_per_object(previous.view, change);
    Image<float> carried(view.width(), view.height());
    const auto at = [&](int x, int y) -> float {
        const std::uint32_t object = view.object(x, y);
        const auto z = static_cast<double>(view.depth_m(x, y));
        if (object == nothing_seen || !std::isfinite(z)) return 0;
        if (const std::optional<Vec3d> place = before.place(now.point(x, y, z))) {
            const auto found = sample(previous.view, change, object, *place, params.depth_tolerance);
            if (found) return *found;
        }
        return object < means.size() ? means[object].value_or(0) : 0;
    };
    parallel_blocks(static_cast<std::size_t>(view.height()), 8, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                            for (int x = 0; x < view.width(); ++x)
                                carried(x, y) = at(x, y);
                    });
    return carried;
}

DisparityMap carried_map(const SeenFrame& previous, const DisparityMap& solution, const SeenFrame& current,
                         const WarmStartParams& params, const Exec& exec) {
    CHECK(solution.width == previous.view.width() && solution.height == previous.view.height());
    Image<float> change = solution;
    for (std::size_t i = 0; i < change.pixels.size(); ++i)
        change.pixels[i] -= previous.view.disparity.pixels[i];
    DisparityMap map = carried_change(previous, change, current, params, exec);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const float c = map.pixels[i], d = current.view.disparity.pixels[i];
        map.pixels[i] = c == 0 ? d : d + c;
    }
    return map;
}

}  // namespace obscura
