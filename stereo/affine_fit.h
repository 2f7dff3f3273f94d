#pragma once
// Weighted least squares of a change c = a + b . q over samples (q, c), where q is where the sample is on the
// map and its original disparity.

#include <algorithm>

namespace obscura {

/// Slopes are drawn towards 0 by as much as samples spread over `ridge_px` would: a row of samples has no
/// slope across it, a single one none at all, and nothing is ever divided by 0.
class AffineFit {
  public:
    struct Place {
        double column = 0, row = 0;
        double disparity = 0;  ///< the same everywhere: not used
    };
    void add(const Place& at, double change, double weight) {
        const double q[4] = {at.column, at.row, at.disparity, change};
        weight_ += weight;
        for (int i = 0; i < 4; ++i) {
            const double wq = weight * q[i];
            sum_[i] += wq;
            for (int j = 0; j <= i && j < 3; ++j)
                products_[i][j] += wq * q[j];
        }
        low_ = std::min(low_, change);
        high_ = std::max(high_, change);
    }
    bool empty() const { return !(weight_ > 0); }
    double low() const { return low_; }
    double high() const { return high_; }

    /// Value at a place, at most `slack` times the samples' range beyond it. Not for an empty fit.
    double at(const Place& place, double slack) const {
        constexpr double ridge_px = 0.03;
        const double inv = 1.0 / weight_;
        double mean[4], m[4][3];
        for (int i = 0; i < 4; ++i)
            mean[i] = sum_[i] * inv;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j <= i && j < 3; ++j)
                m[i][j] = products_[i][j] * inv - mean[i] * mean[j];
        }
        // Moments about the mean times slopes are the last row: solved by M = L D L^T. Pivots below the ridge
        // are rounding.
        constexpr double ridge = ridge_px * ridge_px;
        const double d0 = std::max(m[0][0], 0.0) + ridge;
        const double l10 = m[1][0] / d0, l20 = m[2][0] / d0;
        const double d1 = std::max(m[1][1] + ridge - l10 * m[1][0], ridge);
        const double l21 = (m[2][1] - l20 * m[1][0]) / d1;
        const double d2 = std::max(m[2][2] + ridge - l20 * m[2][0] - l21 * l21 * d1, ridge);
        const double y0 = m[3][0], y1 = m[3][1] - l10 * y0, y2 = m[3][2] - l20 * y0 - l21 * y1;
        const double b2 = y2 / d2, b1 = y1 / d1 - l21 * b2, b0 = y0 / d0 - l10 * b1 - l20 * b2;
        const double value = mean[3] + b0 * (place.column - mean[0]) + b1 * (place.row - mean[1]) +
                             b2 * (place.disparity - mean[2]);
        const double reach = slack * (high_ - low_);
        return std::clamp(value, low_ - reach, high_ + reach);
    }

  private:
    double weight_ = 0;
    double sum_[4] = {}, products_[4][3] = {};  ///< of column, row, disparity, change
    double low_ = 1e300, high_ = -1e300;
};

}  // namespace obscura
