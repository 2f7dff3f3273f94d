#pragma once
// Every way to solve a system of edits behind one door: ours, and the paper's for comparison.

#include "stereo/solver/solver.h"

namespace obscura {

/// solve(), or solve_cascade() where params.method asks for it: that one starts from the edited map and has
/// no use for `initial` and `cache`.
Solution solve_by_method(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
                         const DisparityMap& initial = {}, SolverCache* cache = nullptr);

}  // namespace obscura
