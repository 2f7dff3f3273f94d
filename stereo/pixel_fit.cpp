#include "stereo/pixel_fit.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stereo/screen_weights.h"

namespace obscura {
namespace {

ScreenWeights weights_of(const Bisection& surface, const FineTriangle& t) {
    return {surface.points[t.point[0]].map, surface.points[t.point[1]].map, surface.points[t.point[2]].map};
}

/// Calls fn(weights, miss) for every pixel of the triangle: what is lacking to the map there.
template <class Fn>
void for_each_pixel(const SeenChange& seen, const Bisection& surface, const FineTriangle& t, Fn&& fn) {
    const ScreenWeights weights = weights_of(surface, t);
    double corner[3];
    for (int k = 0; k < 3; ++k)
        corner[k] = static_cast<double>(surface.points[t.point[k]].change_px);
    const auto width = static_cast<std::uint32_t>(seen.view.width());
    for (const std::uint32_t pixel : surface.pixels_of(t)) {
        double w[3];
        weights.at(pixel % width + 0.5, pixel / width + 0.5, w);
        const auto wanted = static_cast<double>(seen.at(pixel));
        fn(w, wanted, wanted - (w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2]));
    }
}

/// One triangle's part in the least squares of its corners.
struct CornerSums {
    double pull[3] = {}, weight[3] = {};  ///< sums of w miss, w w
    double low = 1e300, high = -1e300;    ///< of the map there
};

}  // namespace

std::uint32_t missed_pixels(const SeenChange& seen, const Bisection& surface, std::uint32_t triangle,
                            double tolerance_px) {
    std::uint32_t missed = 0;
    for_each_pixel(seen, surface, surface.triangles[triangle], [&](const double(&)[3], double, double miss) {
        missed += std::fabs(miss) > tolerance_px ? 1 : 0;
    });
    return missed;
}

void fit_points(const SeenChange& seen, std::span<const std::uint32_t> triangles,
                std::span<const std::uint8_t> free, const Exec& exec, Bisection& surface) {
    // Half the least possible diagonal of one pixel in the middle of a triangle: some trust in what was
    // there.
    constexpr double trust = 0.05, damping = 0.7;
    std::vector<CornerSums> sums(triangles.size());
    parallel_blocks(triangles.size(), 128, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            CornerSums& s = sums[i];
            for_each_pixel(seen, surface, surface.triangles[triangles[i]],
                           [&](const double(&w)[3], double wanted, double miss) {
                               for (int k = 0; k < 3; ++k) {
                                   s.pull[k] += w[k] * miss;
                                   s.weight[k] += w[k] * w[k];
                               }
                               s.low = std::min(s.low, wanted);
                               s.high = std::max(s.high, wanted);
                           });
        }
    });
    // Added up in the order of triangles, whoever worked on them.
    struct PointSums {
        double pull = 0, weight = 0, low = 1e300, high = -1e300;
    };
    std::vector<std::uint32_t> list;
    std::vector<PointSums> at(surface.points.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const FineTriangle& t = surface.triangles[triangles[i]];
        for (int k = 0; k < 3; ++k) {
            if (free[t.point[k]] == 0) continue;
            PointSums& p = at[t.point[k]];
            if (p.weight == 0) list.push_back(t.point[k]);
            p.pull += sums[i].pull[k];
            p.weight += sums[i].weight[k];
            p.low = std::min(p.low, sums[i].low);
            p.high = std::max(p.high, sums[i].high);
        }
    }
    for (const std::uint32_t p : list) {
        const PointSums& s = at[p];
        const double reach = seen.slack(surface.points[p].map) * (s.high - s.low);
        const double change =
            static_cast<double>(surface.points[p].change_px) + damping * s.pull / (s.weight + trust);
        surface.points[p].change_px = static_cast<float>(std::clamp(change, s.low - reach, s.high + reach));
    }
}

}  // namespace obscura
