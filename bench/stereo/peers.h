#pragma once
// Sparse solvers of others. Absent ones say so in `problem`.

#include <functional>
#include <string>
#include <vector>

#include "bench/stereo/matrix.h"

namespace obscura {

struct DirectSolution {
    std::vector<double> x;
    double ms = 0;        ///< all of: ordering, factorising, solving, one step of refinement
    double solve_ms = 0;  ///< of that, what another right side would take
    double factor_mib = 0;
    std::string problem;
};

/// Supernodal Cholesky with a step of iterative refinement (SuiteSparse).
DirectSolution solve_by_cholmod(const StereoMatrix& matrix);
/// Version and the BLAS it runs on; empty: absent.
std::string version_of_cholmod();

/// Eigen's simplicial factorisation.
DirectSolution solve_by_ldlt(const StereoMatrix& matrix);
std::string version_of_eigen();

enum class CgPreconditioner { diagonal, incomplete_cholesky };

/// Looks at a solution under way: `ms` so far, looking not counted. True stops the solve.
using LookAtSolution = std::function<bool(int iteration, double ms, const double* x)>;

/// Eigen's conjugate gradients from `start`, in double. `look` is asked before the first iteration, after
/// making the preconditioner, and after every one. Returns what is wrong, if anything.
std::string solve_by_cg(const StereoMatrix& matrix, CgPreconditioner preconditioner,
                        const std::vector<float>& start, const LookAtSolution& look);

}  // namespace obscura
