#pragma once
// Times a set of methods that compute the same field: who can, how wrong they are, how long they take.

#include <functional>
#include <string>
#include <vector>

#include "bench/diffraction/diffraction_bench.h"
#include "bench/diffraction/results.h"
#include "bench/diffraction/truth.h"

namespace obscura {

/// One method, ready to run.
struct MethodJob {
    DiffractionRow row;                        ///< everything but times and errors
    std::function<void()> run;                 ///< timed
    std::function<FieldError()> examine = {};  ///< runs once and compares; not timed
};

/// What is known of a method that was run before.
struct MethodPast {
    std::string aperture, method;
    int size = 0;
    double ms = 0;
};

/// Rows of the jobs, times filled in: first all with threads[0], and so on. `jobs_of` makes the jobs for
/// threads[t], the same ones for every t; results do not depend on threads, so they are compared once. Jobs
/// that cannot serve the grid (InputError), or that by their past would take longer than plan.longest_ms,
/// come out with a problem instead; jobs that have one already keep it.
std::vector<DiffractionRow> time_methods(const std::vector<int>& threads,
                                         const std::function<std::vector<MethodJob>(std::size_t t)>& jobs_of,
                                         const DiffractionBenchPlan& plan, std::vector<MethodPast>& past);

}  // namespace obscura
