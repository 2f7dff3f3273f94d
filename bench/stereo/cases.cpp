// Hard systems: how many iterations they take, and whether the estimate can be believed.

#include <fmt/format.h>

#include "bench/harness/run_times.h"
#include "bench/stereo/stereo_bench.h"
#include "stereo/solver/solver.h"
#include "stereo/thesis/cascade.h"

namespace obscura {
namespace {

/// The least number of iterations from which on the error stays within the goal; -1: more than were tried.
int needed_iterations(const StereoSubject& subject, int most) {
    SolverParams params;
    params.verify = false;
    params.tolerance_max_px = params.tolerance_rms_px = 0;
    SolverCache cache;
    int needed = -1;
    for (int i = 1; i <= most; ++i) {
        params.max_iterations = i;
        const Solution solution = solve(subject.system, params, Exec{}, {}, &cache);
        const bool within = map_error(subject.system, solution.disparity, subject.truth.x).within_goal();
        if (!within) needed = -1;
        if (within && needed < 0) needed = i;
        if (solution.report.iterations < i) break;
    }
    return needed;
}

CaseRow measure_case(StereoCase stereo_case, StereoSize size, const StereoBenchPlan& plan,
                     StereoResults& results) {
    const StereoSubject subject = stereo_subject(stereo_case, size);
    results.truths.push_back(
        {stereo_case_name(stereo_case), size.width, size.height, subject.truth.by, subject.truth.residual});
    CaseRow row;
    row.stereo_case = stereo_case_name(stereo_case);
    row.width = size.width;
    row.height = size.height;
    row.sets = static_cast<int>(subject.system.sets.size());
    SolverParams params;
    params.verify = false;
    Solution solution;
    for (int run = 0; run < plan.rounds; ++run) {
        const double ms =
            milliseconds_of([&] { solution = solve(subject.system, params, Exec{.threads = 1}); });
        if (run == 0 || ms < row.ms) row.ms = ms;
    }
    row.iterations = solution.report.iterations;
    row.estimate_max_px = solution.report.error_max_px;
    row.estimate_rms_px = solution.report.error_rms_px;
    row.start = map_error(subject.system, subject.system.start, subject.truth.x);
    row.error = map_error(subject.system, solution.disparity, subject.truth.x);
    row.needed = needed_iterations(subject, plan.case_iterations);
    row.cascade =
        map_error(subject.system, solve_cascade(subject.system, params, Exec{}).disparity, subject.truth.x);
    return row;
}

}  // namespace

void measure_cases(const StereoBenchPlan& plan, const BenchOptions& options, StereoResults& results) {
    for (const StereoSize size : plan.case_sizes) {
        for (const StereoCase stereo_case : stereo_cases()) {
            const std::string name = stereo_case_name(stereo_case);
            if (name.find(options.scene) == std::string::npos) continue;
            options.say(fmt::format("{} x {}: {}", size.width, size.height, name));
            results.cases.push_back(measure_case(stereo_case, size, plan, results));
        }
    }
}

}  // namespace obscura
