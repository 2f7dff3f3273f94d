#pragma once
// What a solver says of its work. Non-convergence is data.

#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

/// One iteration (or, for the cascade, one level).
struct SolveStep {
    double residual = 0;  ///< before the step: sqrt(r . V r), V one V-cycle, against the first iteration's
    double error_max_px = 0;  ///< estimate of the largest error of x
    double error_rms_px = 0;  ///< estimate of the root mean square error
    double seconds = 0;       ///< since the solve began
};

struct LevelTime {
    int width = 0, height = 0;
    double seconds = 0;  ///< spent on this level, all threads' wall time
};

/// What an edit asked for and did not get.
struct Unsatisfied {
    std::string name;         ///< of the edit; empty: gradients, those of the picture as edited
    double wanted_px = 0;     ///< mean of what was asked for: disparity, or difference to the source
    double reached_px = 0;    ///< mean of what came out
    double worst_px = 0;      ///< largest |reached - wanted| of a pixel
    std::int64_t pixels = 0;  ///< that miss by more than unsatisfied_px
    std::string against;      ///< the edit that asks most of the same pixels for something else; empty: what
                              ///< is around them
};

/// What is missed by less is no contradiction, nor is what no more than this share of an edit's pixels
/// misses: borders give a little.
constexpr double unsatisfied_px = 0.5, unsatisfied_share = 0.01;

struct SolveReport {
    bool converged = false;
    int iterations = 0;
    double residual = 0;      ///< |b - A x| / |b - A start| at the end, Euclidean, in double
    double error_max_px = 0;  ///< estimates at the end
    double error_rms_px = 0;
    double setup_s = 0, solve_s = 0;
    std::vector<SolveStep> steps;
    std::vector<LevelTime> levels;
    std::vector<Unsatisfied> unsatisfied;  ///< worst first
};

}  // namespace obscura
