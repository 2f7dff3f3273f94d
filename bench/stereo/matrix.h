#pragma once
// A disparity system written out as a sparse matrix in double, as libraries want it: not how ours works.

#include <vector>

#include "stereo/disparity_system.h"

namespace obscura {

/// Symmetric; all entries of a row, columns ascending. Unknown y * width + x; pixels that are not valid have
/// a row of their own that says x = start.
struct StereoMatrix {
    int size = 0;
    std::vector<int> starts;  ///< row i: entries starts[i] to starts[i + 1]
    std::vector<int> columns;
    std::vector<double> values;
    std::vector<double> rhs;
};

/// Half the energy's derivative: A x = rhs at its minimum. CHECKs that there are fewer than 2^31 entries.
StereoMatrix stereo_matrix(const DisparitySystem& system);

/// rhs - A x.
std::vector<double> matrix_residual(const StereoMatrix& matrix, const std::vector<double>& x);

}  // namespace obscura
