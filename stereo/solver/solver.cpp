#include "stereo/solver/solver.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "stereo/solver/conjugate_gradients.h"
#include "stereo/solver/full_multigrid.h"
#include "stereo/solver/system_parts.h"
#include "stereo/solver/thin_trees.h"

namespace obscura {
namespace {

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

/// A system all of whose pixels hang together: x becomes its minimiser.
void solve_connected(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
                     SolverCache& use, DisparityMap& x, SolveReport& report) {
    const Stopwatch clock;
    if (use.levels.levels.empty() || !same_matrix(use.matrix_of, system)) {
        use.levels = grid_hierarchy(system, exec);
        use.matrix_of = matrix_part(system);
    }
    if (use.vectors != nullptr && use.vectors->x.cells.width() == system.width() &&
        use.vectors->x.cells.height() == system.height()) {
        use.vectors->reset(use.levels);
    } else {
        use.vectors = std::make_shared<IterationVectors>(use.levels);
    }
    LevelSeconds seconds(use.levels.levels.size(), 0.0);
    report.setup_s = clock.seconds();
    if (params.method == SolverMethod::fmg) add_first_solution(system, use.levels, exec, x, seconds);
    iterate(system, use.levels, params, exec, *use.vectors, x, report, seconds);
    for (std::size_t l = 0; l < seconds.size(); ++l)
        report.levels.push_back({use.levels.levels[l].width, use.levels.levels[l].height, seconds[l]});
}

/// The same of one part of a larger system; other pixels of x stay.
SolveReport solve_part(const DisparitySystem& system, const SystemParts& parts, const SystemPart& part,
                       const SolverParams& params, const Exec& exec, SolverCache& use, DisparityMap& x) {
    const DisparitySystem own = part_system(system, parts, part);
    DisparityMap window(own.width(), own.height());
    for (int y = 0; y < own.height(); ++y)
        std::copy_n(x.row(part.y0 + y) + part.x0, own.width(), window.row(y));
    SolveReport report;
    solve_connected(own, params, exec, use, window, report);
    for (int y = 0; y < own.height(); ++y) {
        for (int i = 0; i < own.width(); ++i) {
            if (own.valid(i, y) != 0) x(part.x0 + i, part.y0 + y) = window(i, y);
        }
    }
    return report;
}

/// Each part by itself: the largest on all threads and with the cache, the others side by side. The report is
/// the largest part's, with the worst estimates of all.
void solve_parts(const DisparitySystem& system, const SystemParts& parts, const SolverParams& params,
                 const Exec& exec, SolverCache& use, DisparityMap& x, SolveReport& report) {
    const std::size_t count = parts.parts.size();
    report.converged = true;
    if (count == 0) return;
    report = solve_part(system, parts, parts.parts[0], params, exec, use, x);
    std::vector<SolveReport> others(count - 1);
    // Parts are disjoint, so are their pixels of x; inside of a task there is one thread.
    parallel_for(count - 1, exec, [&](std::size_t i) {
        const SystemPart& part = parts.parts[i + 1];
        if (part.pixels <= small_part) {
            minimise_part(system, parts, part, x);
            others[i].converged = true;
        } else {
            SolverCache none;
            others[i] = solve_part(system, parts, part, params, {exec.isa, 1}, none, x);
        }
    });
    for (const SolveReport& other : others) {
        report.converged = report.converged && other.converged;
        report.iterations = std::max(report.iterations, other.iterations);
        report.error_max_px = std::max(report.error_max_px, other.error_max_px);
        report.error_rms_px = std::max(report.error_rms_px, other.error_rms_px);
    }
}

}  // namespace

void judge(const DisparitySystem& s, const Exec& exec, Solution& solution) {
    const double before = residual_norm(s, s.start, exec);
    const double after = residual_norm(s, solution.disparity, exec);
    solution.report.residual = before > 0 ? after / before : after;
    solution.report.unsatisfied = unsatisfied(s, solution.disparity);
}

Solution solve(const DisparitySystem& system, const SolverParams& params, const Exec& exec,
               const DisparityMap& initial, SolverCache* cache) {
    CHECK(system.gradient_weight > 0 && system.epsilon > 0 && params.max_iterations > 0);
    CHECK(params.method != SolverMethod::cascade, "stereo/thesis solves by cascade");
    CHECK(initial.pixels.empty() || (initial.width == system.width() && initial.height == system.height()));
    const Stopwatch clock;
    Solution solution;
    SolveReport& report = solution.report;
    solution.disparity = initial.pixels.empty() ? system.start : initial;
    // Pixels outside of the system keep what they have without edits.
    for (std::size_t i = 0; i < solution.disparity.pixels.size(); ++i) {
        if (system.valid.pixels[i] == 0) solution.disparity.pixels[i] = system.start.pixels[i];
    }
    SolverCache own;
    SolverCache& use = cache != nullptr ? *cache : own;
    const std::optional<WithoutTrees> thin = without_trees(system);
    const DisparitySystem& rest = thin ? thin->rest : system;
    const SystemParts parts = system_parts(rest);
    if (parts.parts.size() == 1 &&
        parts.parts[0].pixels == static_cast<std::int64_t>(rest.valid.pixels.size())) {
        solve_connected(rest, params, exec, use, solution.disparity, report);
    } else {
        solve_parts(rest, parts, params, exec, use, solution.disparity, report);
    }
    if (thin) put_trees_back(thin->pixels, solution.disparity);
    report.solve_s = clock.seconds() - report.setup_s;
    if (params.verify) judge(system, exec, solution);
    return solution;
}

}  // namespace obscura
