#include "stereo/thesis/methods.h"

#include "stereo/thesis/cascade.h"

namespace obscura {

Solution solve_by_method(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
                         const DisparityMap& initial, SolverCache* cache) {
    if (params.method == SolverMethod::cascade) return solve_cascade(system, params, exec);
    return solve(system, params, exec, initial, cache);
}

}  // namespace obscura
