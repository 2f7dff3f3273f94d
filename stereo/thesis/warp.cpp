// Image warping with hole filling; see warp.h.

#include "stereo/thesis/warp.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/row_spans.h"

namespace obscura {
namespace {

/// Linear between the centres of one surface's pixels.
Vec3f colour_at(const Vec3f* row, int width, float column) {
    const int x = static_cast<int>(column);
    const float t = column - static_cast<float>(x);
    const Vec3f a = row[x];
    if (t == 0 || x + 1 >= width) return a;
    return a + (row[x + 1] - a) * t;
}

/// Holes first to end - 1 of a row: the farther of both neighbours.
void fill(const std::vector<RowHit>& hits, std::size_t first, std::size_t end, Vec3f* out) {
    const bool left = first > 0, right = end < hits.size();
    Vec3f colour;
    if (left && (!right || hits[first - 1].original <= hits[end].original)) {
        colour = out[first - 1];
    } else if (right) {
        colour = out[end];
    }
    std::fill(out + first, out + end, colour);
}

}  // namespace

WarpedPicture warped(const Image<Vec3f>& middle, const MiddleView& view, const DisparityMap& disparity,
                     const WarpParams& params, const Exec& exec) {
    CHECK(view.reduction == 1 && view.width() == view.picture_width + 2 * view.margin_px &&
          middle.width == view.width() && middle.height == view.height() && disparity.width == view.width() &&
          disparity.height == view.height());
    const auto width = static_cast<std::size_t>(view.picture_width);
    WarpedPicture out;
    out.picture = Image<Vec3f>(view.picture_width, view.picture_height);
    out.hole = Image<std::uint8_t>(view.picture_width, view.picture_height);
    std::vector<std::int64_t> holes(static_cast<std::size_t>(view.picture_height));
    const auto warp_row = [&](int y) {
        std::vector<RowHit> hits(width);
        draw_spans({disparity.row(y), view.disparity.row(y),
                    view.object.pixels.empty() ? nullptr : view.object.row(y), view.width(), view.margin_px},
                   params.shift, params.join_px, hits);
        Vec3f* colour = out.picture.row(y);
        for (std::size_t x = 0; x < width; ++x)
            if (hits[x].found()) colour[x] = colour_at(middle.row(y), middle.width, hits[x].column);
        for (std::size_t x = 0; x < width;) {
            std::size_t end = x;
            while (end < width && !hits[end].found())
                ++end;
            if (end > x) fill(hits, x, end, colour);
            std::fill(out.hole.row(y) + x, out.hole.row(y) + end, std::uint8_t{255});
            holes[static_cast<std::size_t>(y)] += static_cast<std::int64_t>(end - x);
            x = end + 1;
        }
    };
    parallel_blocks(holes.size(), 16, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            warp_row(static_cast<int>(y));
    });
    out.holes = std::accumulate(holes.begin(), holes.end(), std::int64_t{0});
    return out;
}

}  // namespace obscura
