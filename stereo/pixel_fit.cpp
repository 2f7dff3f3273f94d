#include "stereo/pixel_fit.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "raster/record.h"
#include "stereo/screen_weights.h"

namespace obscura {
namespace {

ScreenWeights weights_of(const Bisection& surface, const FineTriangle& t) {
    return {surface.points[t.point[0]].map, surface.points[t.point[1]].map, surface.points[t.point[2]].map};
}

/// Calls fn(weights, wanted, miss) for every step-th pixel of the triangle: the map, and what is lacking to
/// it.
template <class Fn>
void for_each_pixel(const SeenChange& seen, const Bisection& surface, const FineTriangle& t, std::size_t step,
                    Fn&& fn) {
    const ScreenWeights weights = weights_of(surface, t);
    double corner[3];
    for (int k = 0; k < 3; ++k)
        corner[k] = static_cast<double>(surface.points[t.point[k]].change_px);
    const auto width = static_cast<std::uint32_t>(seen.view.width());
    const std::span<const std::uint32_t> pixels = surface.pixels_of(t);
    std::uint32_t row = 0, row_begin = 0;
    for (std::size_t i = step / 2; i < pixels.size(); i += step) {
        // Pixels come row by row: a division is seldom needed.
        if (pixels[i] - row_begin >= width) {
            row = pixels[i] / width;
            row_begin = row * width;
        }
        double w[3];
        weights.at(pixels[i] - row_begin + 0.5, row + 0.5, w);
        const auto wanted = static_cast<double>(seen.at(pixels[i]));
        fn(w, wanted, wanted - (w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2]));
    }
}

/// One triangle's part in the least squares of its corners.
struct CornerSums {
    double pull[3] = {}, weight[3] = {};  ///< sums of w miss, w w
    double low = 1e300, high = -1e300;    ///< of the map there
};

CornerSums corner_sums(const SeenChange& seen, const Bisection& surface, const FineTriangle& t) {
    constexpr std::size_t enough = 100;
    const std::size_t step = std::max<std::size_t>(t.pixels / enough, 1) | 1;
    CornerSums s;
    for_each_pixel(seen, surface, t, step, [&](const double(&w)[3], double wanted, double miss) {
        for (int k = 0; k < 3; ++k) {
            s.pull[k] += w[k] * miss;
            s.weight[k] += w[k] * w[k];
        }
        s.low = std::min(s.low, wanted);
        s.high = std::max(s.high, wanted);
    });
    for (int k = 0; k < 3; ++k) {
        s.pull[k] *= static_cast<double>(step);
        s.weight[k] *= static_cast<double>(step);
    }
    return s;
}

}  // namespace

Miss miss_of(const SeenChange& seen, const Bisection& surface, std::uint32_t triangle, double tolerance_px) {
    Miss m;
    double worst = 0;
    for_each_pixel(seen, surface, surface.triangles[triangle], 1,
                   [&](const double(&)[3], double, double miss) {
                       m.pixels += std::fabs(miss) > tolerance_px ? 1 : 0;
                       worst = std::max(worst, std::fabs(miss));
                   });
    const FineTriangle& t = surface.triangles[triangle];
    double corner[3];
    for (int k = 0; k < 3; ++k)
        corner[k] = static_cast<double>(surface.points[t.point[k]].change_px);
    m.worst_px = static_cast<float>(worst - weights_of(surface, t).slope(corner) / subtexel_one);
    return m;
}

std::vector<PointMove> fit_points(const SeenChange& seen, std::span<const std::uint32_t> triangles,
                                  std::span<const Follow> follow, const Exec& exec, Bisection& surface) {
    constexpr int sweeps = 3;
    // Some trust in what was there: half the weight that one pixel in the middle of a triangle has.
    constexpr double trust = 0.05, damping = 0.7;
    // Points that move, numbered in the order of triangles.
    struct PointSums {
        std::uint32_t point = 0;
        double pull = 0, weight = 0, low = 1e300, high = -1e300;
    };
    constexpr std::uint32_t none = UINT32_MAX;
    std::vector<std::uint32_t> number(surface.points.size(), none);
    std::vector<PointSums> points;
    std::vector<PointMove> moves;
    for (const std::uint32_t t : triangles) {
        for (const std::uint32_t p : surface.triangles[t].point) {
            if (follow[p] != Follow::moving || number[p] != none) continue;
            number[p] = static_cast<std::uint32_t>(points.size());
            points.push_back({p});
            moves.push_back({p, -static_cast<double>(surface.points[p].change_px)});
        }
    }
    std::vector<CornerSums> sums(triangles.size());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        parallel_blocks(triangles.size(), 128, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                sums[i] = corner_sums(seen, surface, surface.triangles[triangles[i]]);
        });
        // Added up in the order of triangles, whoever worked on them.
        for (PointSums& p : points)
            p = {p.point};
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t n = number[surface.triangles[triangles[i]].point[k]];
                if (n == none) continue;
                PointSums& p = points[n];
                p.pull += sums[i].pull[k];
                p.weight += sums[i].weight[k];
                p.low = std::min(p.low, sums[i].low);
                p.high = std::max(p.high, sums[i].high);
            }
        }
        for (const PointSums& s : points) {
            SurfacePoint& p = surface.points[s.point];
            const double reach = seen.slack(p.map) * (s.high - s.low);
            const double change = static_cast<double>(p.change_px) + damping * s.pull / (s.weight + trust);
            p.change_px = static_cast<float>(std::clamp(change, s.low - reach, s.high + reach));
        }
    }
    for (PointMove& move : moves)
        move.moved_px += static_cast<double>(surface.points[move.point].change_px);
    return moves;
}

}  // namespace obscura
