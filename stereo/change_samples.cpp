// Local linear models of a change; see change_samples.h.

#include "stereo/change_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

/// A change that differs by no more around a sample, pixels, needs no model: it is as good as constant.
constexpr float constant_px = 0.02f;

/// The 3 x 3 samples around (x, y), less what lies beyond the borders.
struct Window {
    int x0, y0, x1, y1;  ///< inclusive
};

class Fitter {
  public:
    Fitter(const MiddleView& full, const MiddleView& low, const Image<float>& change, double steepest_change)
        : low_(low), change_(change), steepest_(steepest_change) {
        for (int x = 0; x < low.width(); ++x)
            columns_.push_back(sampled_pixel(x, low.reduction, full.width()));
        for (int y = 0; y < low.height(); ++y)
            rows_.push_back(sampled_pixel(y, low.reduction, full.height()));
    }

    ChangeSample operator()(int x, int y) const {
        ChangeSample s;
        s.change = change_(x, y);
        s.disparity = low_.disparity(x, y);
        s.object = low_.object(x, y);
        if (!low_.normal.pixels.empty()) s.normal = low_.normal(x, y);
        if (s.object == nothing_seen) return s;
        const Window window{std::max(x - 1, 0), std::max(y - 1, 0), std::min(x + 1, low_.width() - 1),
                            std::min(y + 1, low_.height() - 1)};
        if (!constant(window, s)) fit(window, x, y, s);
        return s;
    }

  private:
    bool constant(const Window& w, const ChangeSample& s) const {
        bool all = true;
        for (int j = w.y0; j <= w.y1; ++j)
            for (int i = w.x0; i <= w.x1; ++i)
                all = all &&
                      (low_.object(i, j) != s.object || std::abs(change_(i, j) - s.change) <= constant_px);
        return all;
    }

    void fit(const Window& w, int x, int y, ChangeSample& s) const {
        const double scale = place_pull * low_.reduction * low_.reduction;
        Normal3 equations{.a00 = disparity_pull, .a11 = scale, .a22 = scale};
        for (int j = w.y0; j <= w.y1; ++j) {
            const double rows = rows_[static_cast<std::size_t>(j)] - rows_[static_cast<std::size_t>(y)];
            for (int i = w.x0; i <= w.x1; ++i) {
                if (low_.object(i, j) != s.object) continue;
                const double columns =
                    columns_[static_cast<std::size_t>(i)] - columns_[static_cast<std::size_t>(x)];
                const auto difference = static_cast<double>(change_(i, j) - s.change);
                const auto d = static_cast<double>(low_.disparity(i, j) - s.disparity);
                double weight = 1 / (1 + d * d / (apart * apart));
                if (!low_.normal.pixels.empty()) weight *= facing(s.normal, low_.normal(i, j));
                equations.add(weight * d, weight * columns, weight * rows, weight * difference);
            }
        }
        const auto [disparity, column, row] = equations.solved();
        s.per_disparity = static_cast<float>(std::clamp(disparity, -steepest_, steepest_));
        s.per_column = static_cast<float>(column);
        s.per_row = static_cast<float>(row);
    }

    const MiddleView& low_;
    const Image<float>& change_;
    double steepest_;
    std::vector<int> columns_, rows_;  ///< of full resolution, per sample
};

}  // namespace

Image<ChangeSample> change_samples(const MiddleView& full, const MiddleView& low, const Image<float>& change,
                                   double steepest_change, const Exec& exec) {
    Image<ChangeSample> samples(low.width(), low.height());
    const Fitter fit(full, low, change, steepest_change);
    parallel_blocks(static_cast<std::size_t>(low.height()), 8, exec, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < low.width(); ++x)
                samples(x, y) = fit(x, y);
    });
    return samples;
}

}  // namespace obscura
