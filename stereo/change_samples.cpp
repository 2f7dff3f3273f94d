// Local linear models of a change; see change_samples.h.

#include "stereo/change_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace obscura {
namespace {

/// Three equations, the symmetric matrix by its upper triangle.
struct Normal3 {
    double a00 = 0, a01 = 0, a02 = 0, a11 = 0, a12 = 0, a22 = 0, b0 = 0, b1 = 0, b2 = 0;

    void add(double x0, double x1, double x2, double y) {
        a00 += x0 * x0;
        a01 += x0 * x1;
        a02 += x0 * x2;
        a11 += x1 * x1;
        a12 += x1 * x2;
        a22 += x2 * x2;
        b0 += x0 * y;
        b1 += x1 * y;
        b2 += x2 * y;
    }
    /// By elimination; positive definite.
    std::array<double, 3> solved() const {
        const double l1 = a01 / a00, l2 = a02 / a00;
        const double c11 = a11 - l1 * a01, c12 = a12 - l1 * a02, c22 = a22 - l2 * a02;
        const double d1 = b1 - l1 * b0, d2 = b2 - l2 * b0;
        const double m = c12 / c11;
        const double x2 = (d2 - m * d1) / (c22 - m * c12);
        const double x1 = (d1 - c12 * x2) / c11;
        return {(b0 - a01 * x1 - a02 * x2) / a00, x1, x2};
    }
};

/// Towards 0: squared pixels of disparity, squared reduced pixels of place. Disparity explains what it can.
constexpr double disparity_pull = 1e-4, place_pull = 0.05;

/// A neighbour this much nearer or farther, pixels, counts half: it may be of another surface.
constexpr double apart = 4;

/// Across an edge of the surface the change may bend, too.
double facing(Vec3f a, Vec3f b) {
    const auto cosine = static_cast<double>(std::max(dot(a, b), 0.0f));
    return 0.02 + cosine * cosine;
}

}  // namespace

Image<ChangeSample> change_samples(const MiddleView& full, const MiddleView& low, const Image<float>& change,
                                   double steepest_change, const Exec& exec) {
    Image<ChangeSample> samples(low.width(), low.height());
    const int n = low.reduction;
    const auto fit = [&](int x, int y) {
        ChangeSample s;
        s.change = change(x, y);
        s.disparity = low.disparity(x, y);
        s.object = low.object(x, y);
        if (!low.normal.pixels.empty()) s.normal = low.normal(x, y);
        if (s.object == nothing_seen) return s;
        const double scale = place_pull * n * n;
        Normal3 equations{.a00 = disparity_pull, .a11 = scale, .a22 = scale};
        bool flat = true;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, low.height() - 1); ++j) {
            const int rows = sampled_pixel(j, n, full.height()) - sampled_pixel(y, n, full.height());
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, low.width() - 1); ++i) {
                if (low.object(i, j) != s.object) continue;
                const auto difference = static_cast<double>(change(i, j) - s.change);
                flat = flat && change(i, j) == s.change;
                const int columns = sampled_pixel(i, n, full.width()) - sampled_pixel(x, n, full.width());
                const auto d = static_cast<double>(low.disparity(i, j) - s.disparity);
                double weight = 1 / (1 + d * d / (apart * apart));
                if (!low.normal.pixels.empty()) weight *= facing(s.normal, low.normal(i, j));
                equations.add(weight * d, weight * columns, weight * rows, weight * difference);
            }
        }
        if (flat) return s;
        const auto [d, column, row] = equations.solved();
        s.per_disparity = static_cast<float>(std::clamp(d, -steepest_change, steepest_change));
        s.per_column = static_cast<float>(column);
        s.per_row = static_cast<float>(row);
        return s;
    };
    parallel_blocks(static_cast<std::size_t>(low.height()), 8, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < low.width(); ++x)
                samples(x, static_cast<int>(y)) = fit(x, static_cast<int>(y));
    });
    return samples;
}

}  // namespace obscura
