#pragma once
// Weighted least squares of c = a + b . p over samples (p, c) in the plane.

#include <algorithm>

namespace obscura {

/// Slopes are drawn towards 0 by as much as samples spread over `ridge_px` would: a row of samples has no
/// slope across it, a single one none at all, and nothing is ever divided by 0.
class AffineFit {
  public:
    void add(double x, double y, double c, double weight) {
        weight_ += weight;
        x_ += weight * x;
        y_ += weight * y;
        c_ += weight * c;
        xx_ += weight * x * x;
        xy_ += weight * x * y;
        yy_ += weight * y * y;
        xc_ += weight * x * c;
        yc_ += weight * y * c;
        low_ = std::min(low_, c);
        high_ = std::max(high_, c);
    }
    bool empty() const { return !(weight_ > 0); }
    double low() const { return low_; }
    double high() const { return high_; }

    /// Value at (x, y), at most `slack` times the samples' range beyond it. Not for an empty fit.
    double at(double x, double y, double slack) const {
        constexpr double ridge_px = 0.03;
        const double inv = 1.0 / weight_;
        const double mx = x_ * inv, my = y_ * inv, mc = c_ * inv;
        // Moments about the mean; rounding may leave a little less than nothing.
        const double xx = std::max(xx_ * inv - mx * mx, 0.0) + ridge_px * ridge_px;
        const double yy = std::max(yy_ * inv - my * my, 0.0) + ridge_px * ridge_px;
        const double xy = xy_ * inv - mx * my, xc = xc_ * inv - mx * mc, yc = yc_ * inv - my * mc;
        const double det = std::max(xx * yy - xy * xy, 0.5 * ridge_px * ridge_px * (xx + yy));
        const double bx = (xc * yy - yc * xy) / det, by = (yc * xx - xc * xy) / det;
        const double reach = slack * (high_ - low_);
        return std::clamp(mc + bx * (x - mx) + by * (y - my), low_ - reach, high_ + reach);
    }

  private:
    double weight_ = 0, x_ = 0, y_ = 0, c_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xc_ = 0, yc_ = 0;
    double low_ = 1e300, high_ = -1e300;
};

}  // namespace obscura
