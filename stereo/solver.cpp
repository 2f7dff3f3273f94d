#include "stereo/solver.h"

#include "core/error.h"
#include "stereo/conjugate_gradients.h"

namespace obscura {

Solution solve(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
               const DisparityMap& initial) {
    Solution solution;
    solution.disparity = initial.pixels.empty() ? system.start : initial;
    GridHierarchy h = grid_hierarchy(system, exec);
    LevelSeconds seconds;
    iterate(system, h, params, params.method == SolverMethod::vcycle, exec, solution.disparity, solution.report, seconds);
    return solution;
}

}  // namespace obscura
