#pragma once
// Conjugate gradients preconditioned by a V-cycle, and the V-cycle alone, in the same loop.
//
// Hestenes and Stiefel, "Methods of Conjugate Gradients for Solving Linear Systems", 1952; Tatebe 1993.
// Unknown is the difference to where the solve starts, so that single precision is spent on what changes. An
// iteration is three passes over memory: down and up the V-cycle's finest level (v_cycle.h), then the new
// direction, its product with the matrix, the solution's update and all sums.

#include "stereo/solver/solver.h"
#include "stereo/solver/v_cycle.h"

namespace obscura {

/// The vectors of the iteration. Those that a pass reads at neighbours and writes are doubled.
struct IterationVectors {
    GridVector x, z, r[2], p[2], q;
    int newest_r = 0, newest_p = 0;
    explicit IterationVectors(const GridHierarchy& hierarchy);
    /// As made anew, in the same memory; the hierarchy is of the same size.
    void reset(const GridHierarchy& hierarchy);
};

/// r = b - A x of the system, in double, rounded once; per unknown of the hierarchy.
void start_residual(const DisparitySystem& system, const GridHierarchy& hierarchy, const DisparityMap& x,
                    const Exec& exec, GridVector& r);

/// |b - A x|, Euclidean, in double.
double residual_norm(const DisparitySystem& system, const DisparityMap& x, const Exec& exec);

/// Adds to `x` what lies between it and the minimiser, until the estimated error is within the tolerances:
/// with SolverMethod::multigrid by conjugate gradients, else by V-cycles alone. Appends to report.steps and
/// fills its estimates, iterations and converged.
void iterate(const DisparitySystem& system, GridHierarchy& hierarchy, const SolverParams& params,
             const Exec& exec, IterationVectors& vectors, DisparityMap& x, SolveReport& report,
             LevelSeconds& seconds);

}  // namespace obscura
