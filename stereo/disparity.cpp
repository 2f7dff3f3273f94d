// Disparity of the middle view and of both eyes; see disparity.h.

#include "stereo/disparity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "stereo/grid_tasks.h"
#include "stereo/row_spans.h"

namespace obscura {
namespace {

EyeDisparity drawn(const MiddleView& view, const DisparityMap& disparity, double shift, double join_px,
                   const Exec& exec) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EyeDisparity eye;
    eye.disparity = eye.original = Image<float>(view.picture_width, view.picture_height, nan);
    for_rows(view.picture_height, exec, [&](int y) {
        std::vector<RowHit> hits(static_cast<std::size_t>(view.picture_width));
        const SpanRow row{disparity.row(y), view.disparity.row(y),
                          view.object.pixels.empty() ? nullptr : view.object.row(y), view.width(),
                          view.margin_px};
        draw_spans(row, shift, join_px, hits);
        for (int x = 0; x < view.picture_width; ++x) {
            const RowHit& hit = hits[static_cast<std::size_t>(x)];
            if (!hit.found()) continue;
            eye.disparity(x, y) = hit.disparity;
            eye.original(x, y) = hit.original;
        }
    });
    return eye;
}

/// How much a pixel's half changes the disparity of the surface in it: half the gentler of both slopes, for
/// the other one may be a silhouette.
float half_slope(const float* row, int width, int x) {
    float slope = std::numeric_limits<float>::infinity();
    if (x > 0) slope = std::min(slope, std::abs(row[x] - row[x - 1]));  // NaN is not less
    if (x + 1 < width) slope = std::min(slope, std::abs(row[x + 1] - row[x]));
    return std::isfinite(slope) ? slope / 2 : 0;
}

/// Looks every pixel of `eye` up in the other's map, at x + towards * disparity.
void mark_sight(EyeDisparity& eye, const EyeDisparity& other, float towards, double hidden_px,
                const Exec& exec) {
    const int width = eye.disparity.width;
    eye.sight = Image<Sight>(width, eye.disparity.height, Sight::unknown);
    for_rows(eye.disparity.height, exec, [&](int y) {
        const float* there = other.original.row(y);
        for (int x = 0; x < width; ++x) {
            const float d = eye.disparity(x, y);
            if (!std::isfinite(d)) continue;
            const double place = std::floor(x + static_cast<double>(towards * d) + 0.5);
            if (!(place >= 0 && place < width)) {
                eye.sight(x, y) = Sight::outside;
                continue;
            }
            const int c = static_cast<int>(place);
            const auto nearer = static_cast<double>(there[c] - eye.original(x, y));  // NaN hides nothing
            const double rounding = hidden_px + static_cast<double>(half_slope(there, width, c));
            eye.sight(x, y) = nearer > rounding ? Sight::hidden : Sight::both;
        }
    });
}

}  // namespace

DisparityMap disparity_map(const Image<float>& depth_m, const DisparityLaw& law, const Exec& exec) {
    DisparityMap map(depth_m.width, depth_m.height);
    for_rows(depth_m.height, exec, [&](int y) {
        const float* z = depth_m.row(y);
        for (int x = 0; x < depth_m.width; ++x) {
            CHECK(z[x] > 0, fmt::format("depth {} at ({}, {})", z[x], x, y));
            map(x, y) = law.at(static_cast<double>(z[x]));
        }
    });
    return map;
}

TwoWayDisparity cross_checked(EyeDisparity left, EyeDisparity right, const TwoWayParams& params,
                              const Exec& exec) {
    const auto size_of = [](const Image<float>& i) { return std::pair(i.width, i.height); };
    CHECK(size_of(left.disparity) == size_of(right.disparity) &&
          size_of(left.original) == size_of(left.disparity) &&
          size_of(right.original) == size_of(right.disparity));
    TwoWayDisparity two{std::move(left), std::move(right)};
    mark_sight(two.left, two.right, -1, params.hidden_px, exec);
    mark_sight(two.right, two.left, 1, params.hidden_px, exec);
    return two;
}

TwoWayDisparity two_way_disparity(const MiddleView& view, const DisparityMap& disparity,
                                  const TwoWayParams& params, const Exec& exec) {
    CHECK(view.reduction == 1 && view.width() == view.picture_width + 2 * view.margin_px &&
          disparity.width == view.width() && disparity.height == view.height());
    return cross_checked(drawn(view, disparity, params.shift.left, params.join_px, exec),
                         drawn(view, disparity, params.shift.right, params.join_px, exec), params, exec);
}

Image<std::uint8_t> occlusion_mask(const EyeDisparity& eye) {
    Image<std::uint8_t> mask(eye.sight.width, eye.sight.height);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        const Sight sight = eye.sight.pixels[i];
        mask.pixels[i] = sight == Sight::both ? 0 : sight == Sight::unknown ? 128 : 255;
    }
    return mask;
}

}  // namespace obscura
