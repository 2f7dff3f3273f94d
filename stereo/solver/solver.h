#pragma once
// From a system of edits to the disparity map that minimises its energy (thesis 4.5, 4.6).

#include <memory>

#include "core/isa.h"
#include "stereo/disparity_system.h"
#include "stereo/solver/grid_hierarchy.h"
#include "stereo/solver/solve_report.h"

namespace obscura {

enum class SolverMethod {
    cascade,    ///< the paper's single pass from coarse to fine, not by solve(): see stereo/thesis/methods.h
    vcycle,     ///< stationary V-cycles; for teaching: area anchors and matching sets stall it
    fmg,        ///< full multigrid, then V-cycles
    multigrid,  ///< conjugate gradients preconditioned by a V-cycle: the one to use
};

struct SolverParams {
    SolverMethod method = SolverMethod::multigrid;
    double tolerance_max_px = 0.05;  ///< stop when both error estimates are below; multigrid, fmg, vcycle
    double tolerance_rms_px = 0.02;
    int max_iterations = 60;
    int sweeps = 10;            ///< cascade: Jacobi sweeps per level
    bool verify = true;         ///< judge() when done, of a cascade its errors as well
    bool half_storage = false;  ///< cascade: maps as 16-bit floats between sweeps, as the paper keeps them
    bool printed_sign = false;  ///< cascade: the upsampling formula with the sign as printed
};

struct IterationVectors;

struct Solution {
    DisparityMap disparity;
    SolveReport report;
};

/// What a later solve can use again: the levels of the matrix, for as long as only what edits ask for changes
/// and not which pixels or weights; and memory.
struct SolverCache {
    DisparitySystem matrix_of;  ///< whose matrix the levels are of; without maps and values
    GridHierarchy levels;
    std::shared_ptr<IterationVectors> vectors;
};

/// Minimises the system's energy. `initial`: where to start from (last frame's map, or the one before an
/// edit); empty: system.start. `cache`: of earlier solves of one size, or null. The same bits for any exec,
/// with or without a cache. Not for SolverMethod::cascade.
Solution solve(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
               const DisparityMap& initial = {}, SolverCache* cache = nullptr);

/// Fills in report.residual and report.unsatisfied of a finished map, whichever method it is of.
void judge(const DisparitySystem& system, const Exec& exec, Solution& solution);

/// Edits that `x` leaves unsatisfied by more than unsatisfied_px at more than unsatisfied_share of their
/// pixels, worst first.
std::vector<Unsatisfied> unsatisfied(const DisparitySystem& system, const DisparityMap& x);

}  // namespace obscura
