// Our solvers at one size: how long until their own estimate stops them, and error against time.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/harness/interleave.h"
#include "bench/harness/run_times.h"
#include "bench/stereo/memory_pass.h"
#include "bench/stereo/stereo_bench.h"
#include "stereo/thesis/methods.h"

namespace obscura {
namespace {

constexpr int most_stationary = 20;  // cycles of the methods that may never get there

SolverParams params_of(SolverMethod method) {
    SolverParams params;
    params.method = method;
    params.verify = false;
    if (method == SolverMethod::fmg || method == SolverMethod::vcycle)
        params.max_iterations = most_stationary;
    return params;
}

/// Exactly so many iterations.
SolverParams cut(SolverParams params, int iterations) {
    params.tolerance_max_px = params.tolerance_rms_px = 0;
    params.max_iterations = iterations;
    return params;
}

/// A timed solve, and what its fastest run reported.
struct SolveJob {
    const DisparitySystem* system = nullptr;
    SolverParams params;
    Exec exec;
    bool keep = false;  ///< levels of the matrix
    SolverCache cache = {};
    Solution best = {};
    double best_ms = 0;

    void run() {
        Solution solution;
        const double ms = milliseconds_of(
            [&] { solution = solve_by_method(*system, params, exec, {}, keep ? &cache : nullptr); });
        // The first run of a kept cache fills it.
        const bool filled = !keep || runs_++ > 0;
        if (filled && (best_ms == 0 || ms < best_ms)) best = std::move(solution), best_ms = ms;
    }

  private:
    int runs_ = 0;
};

/// The jobs of one method and thread count.
struct MethodJobs {
    const char* method = "";
    int threads = 1;
    std::unique_ptr<SolveJob> whole, kept, curve;   // the last two: iterative methods only
    std::vector<std::unique_ptr<SolveJob>> sweeps;  // cascade only
};

std::unique_ptr<SolveJob> job_of(const DisparitySystem& system, const SolverParams& params, int threads,
                                 bool keep = false) {
    auto job = std::make_unique<SolveJob>();
    job->system = &system;
    job->params = params;
    job->exec.threads = threads;
    job->keep = keep;
    return job;
}

std::vector<MethodJobs> jobs_of(const DisparitySystem& system, const StereoBenchPlan& plan, int threads) {
    std::vector<MethodJobs> all;
    const std::pair<const char*, SolverMethod> iterative[] = {{multigrid_name, SolverMethod::multigrid},
                                                              {fmg_name, SolverMethod::fmg},
                                                              {vcycle_name, SolverMethod::vcycle}};
    for (const auto& [name, method] : iterative) {
        const SolverParams params = params_of(method);
        MethodJobs jobs{name,
                        threads,
                        job_of(system, params, threads),
                        job_of(system, params, threads, true),
                        job_of(system, cut(params, plan.curve_iterations), threads),
                        {}};
        all.push_back(std::move(jobs));
    }
    for (const char* name : {cascade_name, printed_name, half_name}) {
        SolverParams params = params_of(SolverMethod::cascade);
        params.printed_sign = name == printed_name;
        params.half_storage = name == half_name;
        MethodJobs jobs{name, threads, job_of(system, params, threads), {}, {}, {}};
        for (const int sweeps :
             name == cascade_name ? plan.cascade_sweeps : std::vector<int>{params.sweeps}) {
            params.sweeps = sweeps;
            jobs.sweeps.push_back(job_of(system, params, threads));
        }
        all.push_back(std::move(jobs));
    }
    return all;
}

/// Times of one long run's iterations; errors by runs cut short, which are the same for any threads.
std::vector<CurvePoint> iteration_curve(const SolveJob& job, const std::vector<MapError>& errors) {
    std::vector<CurvePoint> curve;
    const std::vector<SolveStep>& steps = job.best.report.steps;
    for (std::size_t i = 0; i < steps.size() && i < errors.size(); ++i) {
        const double rest_s = steps.back().seconds - steps[i].seconds;
        curve.push_back({static_cast<int>(i) + 1, job.best_ms - 1e3 * rest_s, errors[i]});
    }
    return curve;
}

std::vector<MapError> errors_of(const StereoSubject& subject, const SolverParams& params, int iterations) {
    std::vector<MapError> errors;
    SolverCache cache;
    for (int i = 1; i <= iterations; ++i) {
        const Solution solution = solve(subject.system, cut(params, i), Exec{}, {}, &cache);
        errors.push_back(map_error(subject.system, solution.disparity, subject.truth.x));
        if (solution.report.iterations < i) break;
    }
    return errors;
}

StereoRow row_of(const StereoSubject& subject, const MethodJobs& jobs, const std::vector<MapError>& errors) {
    StereoRow row;
    row.width = subject.size.width;
    row.height = subject.size.height;
    row.method = jobs.method;
    row.threads = jobs.threads;
    const SolveReport& report = jobs.whole->best.report;
    row.whole_ms = jobs.whole->best_ms;
    row.setup_ms = 1e3 * report.setup_s;
    row.iterate_ms = 1e3 * report.solve_s;
    row.iterations = report.iterations;
    row.error = map_error(subject.system, jobs.whole->best.disparity, subject.truth.x);
    if (jobs.curve != nullptr) {
        row.kept_ms = jobs.kept->best_ms;
        row.estimate_max_px = report.error_max_px;
        row.estimate_rms_px = report.error_rms_px;
        row.curve = iteration_curve(*jobs.curve, errors);
        if (!report.converged) row.note = fmt::format("stopped after {} cycles", report.iterations);
    }
    for (const auto& job : jobs.sweeps)
        row.curve.push_back({job->params.sweeps, job->best_ms,
                             map_error(subject.system, job->best.disparity, subject.truth.x)});
    return row;
}

/// Adds jobs that pass over memory, with and without streaming stores.
void add_passes(const std::vector<int>& threads, MemoryPass& pass, std::vector<TimedJob>& timed) {
    for (const int count : threads) {
        Exec exec;
        exec.threads = count;
        for (const bool streaming : {false, true})
            timed.push_back({"pass", [&pass, streaming, exec] { pass.run(streaming, exec); }});
    }
}

}  // namespace

void measure_methods(const StereoSubject& subject, const StereoBenchPlan& plan, const BenchOptions& options,
                     StereoResults& results) {
    MemoryPass pass(subject.system.original.pixels.size());
    std::vector<MethodJobs> all;
    std::vector<TimedJob> timed;
    add_passes(options.threads, pass, timed);
    for (const int threads : options.threads) {
        for (MethodJobs& jobs : jobs_of(subject.system, plan, threads))
            all.push_back(std::move(jobs));
    }
    for (const MethodJobs& jobs : all) {
        std::vector<SolveJob*> parts = {jobs.whole.get(), jobs.kept.get(), jobs.curve.get()};
        for (const auto& job : jobs.sweeps)
            parts.push_back(job.get());
        for (SolveJob* job : parts) {
            if (job != nullptr) timed.push_back({jobs.method, [job] { job->run(); }});
        }
    }
    TimingPlan timing;
    timing.rounds = plan.rounds;
    timing.budget_ms = plan.budget_ms;
    const std::vector<Timing> timings = time_interleaved(timed, timing);
    for (std::size_t t = 0; t < options.threads.size(); ++t)
        results.passes.push_back({subject.size.width, subject.size.height, options.threads[t],
                                  std::min(timings[2 * t].least_ms, timings[2 * t + 1].least_ms)});
    std::vector<std::pair<std::string, std::vector<MapError>>> errors;
    for (const MethodJobs& jobs : all) {
        auto known = std::find_if(errors.begin(), errors.end(),
                                  [&](const auto& pair) { return pair.first == jobs.method; });
        if (known == errors.end()) {
            known = errors.insert(known, {jobs.method, {}});
            if (jobs.curve != nullptr)
                known->second = errors_of(subject, jobs.whole->params, plan.curve_iterations);
        }
        results.rows.push_back(row_of(subject, jobs, known->second));
    }
}

}  // namespace obscura
