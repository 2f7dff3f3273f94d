#pragma once
// What a solver says of its work. Non-convergence is data.

#include <string>
#include <vector>

namespace obscura {

/// One iteration (or, for the cascade, one level).
struct SolveStep {
    double residual = 0;      ///< |b - A x| / |b - A start|, Euclidean, as the recurrence has it
    double error_max_px = 0;  ///< estimate of the largest error of x
    double error_rms_px = 0;  ///< estimate of the root mean square error
    double seconds = 0;       ///< since the solve began
};

struct LevelTime {
    int width = 0, height = 0;
    double seconds = 0;  ///< spent on this level, all threads' wall time
};

/// A term that the solution could not satisfy.
struct Unsatisfied {
    std::string name;       ///< of the edit
    double wanted_px = 0;   ///< mean of what the term asks for: disparity, or difference to the source
    double reached_px = 0;  ///< mean of what it got
    double worst_px = 0;    ///< largest |reached - wanted|
    std::string against;    ///< name of the edit that pulls the other way hardest, or empty: the
                            ///< gradients around it
};

struct SolveReport {
    bool converged = false;
    int iterations = 0;
    double residual = 0;      ///< relative, of the true residual in double, at the end
    double error_max_px = 0;  ///< estimates at the end
    double error_rms_px = 0;
    double setup_s = 0, solve_s = 0;
    std::vector<SolveStep> steps;
    std::vector<LevelTime> levels;
    std::vector<Unsatisfied> unsatisfied;  ///< worst first
};

}  // namespace obscura
