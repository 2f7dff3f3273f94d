#include "stereo/solver/dense_cholesky.h"

#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

std::size_t at(int n, int row, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column);
}

}  // namespace

void factor_cholesky(int n, std::vector<double>& a) {
    CHECK(a.size() == at(n, n, 0));
    constexpr double least = 1e-13, held = 1e150;
    for (int i = 0; i < n; ++i) {
        const double original = a[at(n, i, i)];
        for (int j = 0; j <= i; ++j) {
            double sum = a[at(n, i, j)];
            for (int k = 0; k < j; ++k)
                sum -= a[at(n, i, k)] * a[at(n, j, k)];
            if (j < i) {
                a[at(n, i, j)] = sum / a[at(n, j, j)];
            } else {
                a[at(n, i, i)] = sum > least * original ? std::sqrt(sum) : held;
            }
        }
    }
}

void solve_cholesky(int n, const std::vector<double>& factor, std::vector<double>& b) {
    for (int i = 0; i < n; ++i) {
        double sum = b[static_cast<std::size_t>(i)];
        for (int k = 0; k < i; ++k)
            sum -= factor[at(n, i, k)] * b[static_cast<std::size_t>(k)];
        b[static_cast<std::size_t>(i)] = sum / factor[at(n, i, i)];
    }
    for (int i = n - 1; i >= 0; --i) {
        double sum = b[static_cast<std::size_t>(i)];
        for (int k = i + 1; k < n; ++k)
            sum -= factor[at(n, k, i)] * b[static_cast<std::size_t>(k)];
        b[static_cast<std::size_t>(i)] = sum / factor[at(n, i, i)];
    }
}

}  // namespace obscura
