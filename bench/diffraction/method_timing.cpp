#include "bench/diffraction/method_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

/// Of the time of a direct sum over quads when the size doubles: four times the pixels, twice the quads.
constexpr double growth = 8;

const MethodPast* last_run(const std::vector<MethodPast>& past, const DiffractionRow& row) {
    const auto same = std::find_if(past.rbegin(), past.rend(), [&](const MethodPast& p) {
        return p.aperture == row.aperture && p.method == row.method && p.size <= row.size;
    });
    return same != past.rend() ? &*same : nullptr;
}

/// Why a job is left out, empty when it is not.
std::string left_out(const DiffractionRow& row, const DiffractionBenchPlan& plan,
                     const std::vector<MethodPast>& past) {
    const MethodPast* last = row.peer ? nullptr : last_run(past, row);
    if (last == nullptr) return {};
    const double doublings = std::log2(static_cast<double>(row.size) / last->size);
    const double expected = last->ms * std::pow(growth, doublings);
    return expected > plan.longest_ms ? fmt::format("left out: {:.0f} ms at {}", last->ms, last->size) : "";
}

/// One run, compared. Fills in error or problem.
void examine(MethodJob& job) {
    try {
        const FieldError error = job.examine();
        job.row.error = error.amplitude;
        job.row.log_psnr_db = error.log_psnr_db;
    } catch (const InputError& problem) {
        job.row.problem = problem.what();
    }
}

/// Rows of the jobs of one number of threads.
std::vector<DiffractionRow> time_once(std::vector<MethodJob> jobs, const DiffractionBenchPlan& plan,
                                      std::vector<MethodPast>& past) {
    std::vector<TimedJob> timed;
    for (MethodJob& job : jobs) {
        if (job.row.problem.empty()) job.row.problem = left_out(job.row, plan, past);
        if (job.row.problem.empty() && job.examine) examine(job);
        if (job.row.problem.empty()) timed.push_back({job.row.method, job.run});
    }
    const std::vector<Timing> timings = time_interleaved(timed, plan.timing);
    std::vector<DiffractionRow> rows;
    std::size_t next = 0;
    for (MethodJob& job : jobs) {
        if (job.row.problem.empty()) {
            job.row.time = timings[next++];
            past.push_back({job.row.aperture, job.row.method, job.row.size, job.row.time.least_ms});
        }
        rows.push_back(std::move(job.row));
    }
    return rows;
}

}  // namespace

std::vector<DiffractionRow> time_methods(const std::vector<int>& threads,
                                         const std::function<std::vector<MethodJob>(std::size_t t)>& jobs_of,
                                         const DiffractionBenchPlan& plan, std::vector<MethodPast>& past) {
    std::vector<DiffractionRow> all;
    for (std::size_t t = 0; t < threads.size(); ++t) {
        std::vector<MethodJob> jobs = jobs_of(t);
        for (std::size_t i = 0; t > 0 && i < jobs.size(); ++i) {
            CHECK(jobs[i].row.method == all[i].method);
            jobs[i].examine = {};
            jobs[i].row.error = all[i].error;
            jobs[i].row.log_psnr_db = all[i].log_psnr_db;
            jobs[i].row.problem = all[i].problem;
        }
        const std::vector<DiffractionRow> rows = time_once(std::move(jobs), plan, past);
        all.insert(all.end(), rows.begin(), rows.end());
    }
    return all;
}

}  // namespace obscura
