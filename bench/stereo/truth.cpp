#include "bench/stereo/truth.h"

#include <algorithm>
#include <cmath>

#include "stereo/solver/solver.h"

namespace obscura {
namespace {

std::vector<double> by_ourselves(const DisparitySystem& system) {
    SolverParams params;
    params.tolerance_max_px = params.tolerance_rms_px = 1e-5;
    params.verify = false;
    SolverCache cache;
    DisparityMap x;
    for (int restart = 0; restart < 5; ++restart)
        x = solve(system, params, Exec{}, x, &cache).disparity;
    return {x.pixels.begin(), x.pixels.end()};
}

template <class Value>
MapError error_of(const DisparitySystem& system, const Value* x, const std::vector<double>& truth) {
    MapError error;
    double squares = 0, pixels = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (system.valid.pixels[i] == 0) continue;
        const double off = std::abs(static_cast<double>(x[i]) - truth[i]);
        if (!std::isfinite(off)) return {INFINITY, INFINITY};
        error.max_px = std::max(error.max_px, off);
        squares += off * off;
        pixels += 1;
    }
    error.rms_px = std::sqrt(squares / std::max(1.0, pixels));
    return error;
}

}  // namespace

StereoTruth stereo_truth(const DisparitySystem& system, const StereoMatrix& matrix) {
    StereoTruth truth;
    truth.direct = solve_by_cholmod(matrix);
    const bool solved = truth.direct.problem.empty();
    truth.x = solved ? std::move(truth.direct.x) : by_ourselves(system);
    truth.by = solved ? cholmod_name : "ours, restarted";
    for (const double r : matrix_residual(matrix, truth.x))
        truth.residual = std::max(truth.residual, std::abs(r));
    return truth;
}

StereoTruth stereo_truth(const DisparitySystem& system) {
    return stereo_truth(system, stereo_matrix(system));
}

MapError map_error(const DisparitySystem& system, const DisparityMap& x, const std::vector<double>& truth) {
    CHECK(x.pixels.size() == truth.size());
    return error_of(system, x.pixels.data(), truth);
}

MapError map_error(const DisparitySystem& system, const double* x, const std::vector<double>& truth) {
    return error_of(system, x, truth);
}

}  // namespace obscura
