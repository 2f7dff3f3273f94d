#pragma once
// The minimiser of a disparity system's energy in double, and errors against it.

#include <string>
#include <vector>

#include "bench/stereo/matrix.h"
#include "bench/stereo/peers.h"
#include "bench/stereo/results.h"
#include "stereo/disparity_system.h"

namespace obscura {

struct StereoTruth {
    std::vector<double> x;  ///< per pixel
    std::string by;         ///< who solved it
    double residual = 0;    ///< largest |rhs - A x|
    DirectSolution direct;  ///< CHOLMOD's times, without x; or its problem
};

/// By CHOLMOD with a step of refinement. Without it by our own solver, started again from its result until
/// nothing changes: the residual is made anew in double every time, so that this, too, is far better than
/// what is measured; but it is not independent.
StereoTruth stereo_truth(const DisparitySystem& system, const StereoMatrix& matrix);
StereoTruth stereo_truth(const DisparitySystem& system);

MapError map_error(const DisparitySystem& system, const DisparityMap& x, const std::vector<double>& truth);
/// The same of a solution in double, of `size` pixels.
MapError map_error(const DisparitySystem& system, const double* x, const std::vector<double>& truth);

}  // namespace obscura
