// What the peers are asked to do.

#include "bench/stereo/peers.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/stereo/stereo_bench.h"

namespace obscura {
namespace {

StereoRow peer_row(const StereoSubject& subject, const char* method) {
    StereoRow row;
    row.width = subject.size.width;
    row.height = subject.size.height;
    row.method = method;
    row.peer = true;
    return row;
}

StereoRow direct_row(const StereoSubject& subject, const char* method, const DirectSolution& solution) {
    StereoRow row = peer_row(subject, method);
    row.problem = solution.problem;
    if (!row.problem.empty()) return row;
    row.whole_ms = solution.ms;
    row.kept_ms = solution.solve_ms;
    row.error = map_error(subject.system, solution.x.data(), subject.truth.x);
    row.curve.push_back({1, row.whole_ms, row.error});
    if (solution.factor_mib > 0) row.note = fmt::format("factor of {:.0f} MiB", solution.factor_mib);
    return row;
}

/// The truth's solve was one; where it is short, two more.
StereoRow cholmod_row(const StereoSubject& subject, const StereoBenchPlan& plan) {
    DirectSolution best = subject.truth.direct;
    best.x = subject.truth.x;
    for (int i = 0; i < 2 && best.problem.empty() && subject.matrix.size <= plan.largest_repeated; ++i) {
        DirectSolution again = solve_by_cholmod(subject.matrix);
        if (again.ms < best.ms) best = std::move(again);
    }
    return direct_row(subject, cholmod_name, best);
}

StereoRow cg_row(const StereoSubject& subject, const char* method, CgPreconditioner preconditioner,
                 double longest_ms) {
    StereoRow row = peer_row(subject, method);
    bool reached = false;
    const auto look = [&](int iteration, double ms, const double* x) {
        row.iterations = iteration;
        row.whole_ms = ms;
        row.error = map_error(subject.system, x, subject.truth.x);
        reached = row.error.within_goal();
        const bool enough = reached || ms > longest_ms;
        if (iteration == 0) row.setup_ms = ms;
        if (row.curve.empty() || ms > 1.2 * row.curve.back().ms || enough)
            row.curve.push_back({iteration, ms, row.error});
        return enough;
    };
    row.problem = solve_by_cg(subject.matrix, preconditioner, subject.system.start.pixels, look);
    row.iterate_ms = row.whole_ms - row.setup_ms;
    if (row.problem.empty() && !reached)
        row.problem = fmt::format("stopped after {:.0f} s, not at the goal yet", row.whole_ms / 1e3);
    return row;
}

}  // namespace

std::vector<StereoRow> measure_peers(const StereoSubject& subject, const StereoBenchPlan& plan,
                                     const BenchOptions& options) {
    const auto say = [&](const char* method) {
        options.say(fmt::format("{} x {}: {}", subject.size.width, subject.size.height, method));
    };
    std::vector<StereoRow> rows;
    say(cholmod_name);
    rows.push_back(cholmod_row(subject, plan));
    if (subject.matrix.size <= plan.largest_ldlt) {
        say(ldlt_name);
        rows.push_back(direct_row(subject, ldlt_name, solve_by_ldlt(subject.matrix)));
    }
    say(cg_name);
    rows.push_back(cg_row(subject, cg_name, CgPreconditioner::diagonal, plan.longest_cg_ms));
    say(cg_ic_name);
    rows.push_back(cg_row(subject, cg_ic_name, CgPreconditioner::incomplete_cholesky, plan.longest_cg_ic_ms));
    return rows;
}

}  // namespace obscura
