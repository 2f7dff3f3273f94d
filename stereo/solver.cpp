#include "stereo/solver.h"

#include <chrono>

#include "core/error.h"
#include "stereo/cascade.h"
#include "stereo/conjugate_gradients.h"
#include "stereo/full_multigrid.h"

namespace obscura {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What same_matrix() compares, without the rest.
DisparitySystem matrix_part(const DisparitySystem& s) {
    DisparitySystem part;
    part.anchor_weight = s.anchor_weight;
    part.valid = s.valid;
    part.sets = s.sets;
    part.gradient_weight = s.gradient_weight;
    part.epsilon = s.epsilon;
    return part;
}

/// Full multigrid's first solution, added to x.
void add_first_solution(const DisparitySystem& s, GridHierarchy& h, const Exec& exec, DisparityMap& x,
                        LevelSeconds& seconds) {
    GridVector r = grid_vector(h);
    start_residual(s, h, x, exec, r);
    const GridVector first = full_multigrid(h, r, exec, seconds);
    for (int y = 0; y < x.height; ++y) {
        for (int i = 0; i < x.width; ++i)
            x(i, y) += first.cells.row(y)[i];
    }
    for (std::size_t k = 0; k < h.hubs.size(); ++k)
        x(h.hubs[k].x, h.hubs[k].y) += static_cast<float>(first.hubs[k]);
}

/// Fills in what is known of a finished solution.
void judge(const DisparitySystem& s, const SolverParams& params, const Exec& exec, Solution& solution) {
    if (!params.verify) return;
    const double before = residual_norm(s, s.start, exec);
    const double after = residual_norm(s, solution.disparity, exec);
    solution.report.residual = before > 0 ? after / before : after;
    solution.report.unsatisfied = unsatisfied(s, solution.disparity);
}

}  // namespace

Solution solve(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
               const DisparityMap& initial, SolverCache* cache) {
    CHECK(system.gradient_weight > 0 && system.epsilon > 0 && params.max_iterations > 0);
    CHECK(initial.pixels.empty() || (initial.width == system.width() && initial.height == system.height()));
    const Clock::time_point start = Clock::now();
    if (params.method == SolverMethod::cascade) {
        Solution solution = solve_cascade(system, params, exec);
        judge(system, params, exec, solution);
        return solution;
    }
    SolverCache own;
    SolverCache& use = cache != nullptr ? *cache : own;
    if (use.levels.levels.empty() || !same_matrix(use.matrix_of, system)) {
        use.levels = grid_hierarchy(system, exec);
        if (cache != nullptr) use.matrix_of = matrix_part(system);
    }
    if (use.vectors != nullptr && use.vectors->x.cells.width() == system.width() &&
        use.vectors->x.cells.height() == system.height()) {
        use.vectors->reset(use.levels);
    } else {
        use.vectors = std::make_shared<IterationVectors>(use.levels);
    }
    Solution solution;
    SolveReport& report = solution.report;
    solution.disparity = initial.pixels.empty() ? system.start : initial;
    // Pixels outside of the system keep what they have without edits.
    for (std::size_t i = 0; i < solution.disparity.pixels.size(); ++i) {
        if (system.valid.pixels[i] == 0) solution.disparity.pixels[i] = system.start.pixels[i];
    }
    LevelSeconds seconds(use.levels.levels.size(), 0.0);
    report.setup_s = since(start);
    if (params.method == SolverMethod::fmg)
        add_first_solution(system, use.levels, exec, solution.disparity, seconds);
    iterate(system, use.levels, params, exec, *use.vectors, solution.disparity, report, seconds);
    report.solve_s = since(start) - report.setup_s;
    for (std::size_t l = 0; l < seconds.size(); ++l)
        report.levels.push_back({use.levels.levels[l].width, use.levels.levels[l].height, seconds[l]});
    judge(system, params, exec, solution);
    return solution;
}

}  // namespace obscura
