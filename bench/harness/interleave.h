#pragma once
// Times of several jobs that take turns, so that what disturbs the machine disturbs them all.

#include <functional>
#include <string>
#include <vector>

namespace obscura {

struct TimedJob {
    std::string name;
    std::function<void()> run;
};

struct TimingPlan {
    int rounds = 5;          ///< turns of each job
    double turn_ms = 2;      ///< a turn of a short job: calls until this is spent, one at least
    double budget_ms = 150;  ///< a job that has spent this rests; every job gets two turns
};

struct Timing {
    double least_ms = 0, median_ms = 0;
    int calls = 0;  ///< that were timed
};

/// One Timing per job. Every job runs once to warm up, then in turns, in reversed order every other round; in
/// a turn the first call of a job shorter than turn_ms is not timed, since its data left the caches
/// meanwhile.
std::vector<Timing> time_interleaved(const std::vector<TimedJob>& jobs, const TimingPlan& plan);

}  // namespace obscura
