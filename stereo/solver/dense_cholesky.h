#pragma once
// Small symmetric positive definite systems, exactly: the bottom of a V-cycle.

#include <vector>

namespace obscura {

/// Replaces the lower triangle of the n x n row-major matrix by its Cholesky factor L, A = L L^T. A pivot
/// that rounding has made too small or negative is taken for infinite: its unknown is then held at 0.
void factor_cholesky(int n, std::vector<double>& a);
/// Replaces b by the solution of L L^T x = b.
void solve_cholesky(int n, const std::vector<double>& factor, std::vector<double>& b);

}  // namespace obscura
