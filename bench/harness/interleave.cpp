#include "bench/harness/interleave.h"

#include <algorithm>

#include "bench/harness/run_times.h"

namespace obscura {
namespace {

/// What a job has taken so far.
struct Clock {
    std::vector<double> runs_ms;
    double warm_up_ms = 0, spent_ms = 0;
};

void take_turn(const TimedJob& job, const TimingPlan& plan, Clock& clock) {
    const bool is_short = clock.warm_up_ms < plan.turn_ms;
    if (is_short) job.run();
    double turn_ms = 0;
    do {
        clock.runs_ms.push_back(milliseconds_of(job.run));
        turn_ms += clock.runs_ms.back();
    } while (is_short && turn_ms < plan.turn_ms);
    clock.spent_ms += turn_ms;
}

}  // namespace

std::vector<Timing> time_interleaved(const std::vector<TimedJob>& jobs, const TimingPlan& plan) {
    std::vector<Clock> clocks(jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i)
        clocks[i].warm_up_ms = milliseconds_of(jobs[i].run);
    for (int round = 0; round < plan.rounds; ++round) {
        for (std::size_t turn = 0; turn < jobs.size(); ++turn) {
            const std::size_t i = round % 2 == 0 ? turn : jobs.size() - 1 - turn;
            if (round < 2 || clocks[i].spent_ms < plan.budget_ms) take_turn(jobs[i], plan, clocks[i]);
        }
    }
    std::vector<Timing> timings;
    for (Clock& clock : clocks) {
        std::sort(clock.runs_ms.begin(), clock.runs_ms.end());
        timings.push_back({clock.runs_ms.front(), clock.runs_ms[clock.runs_ms.size() / 2],
                           static_cast<int>(clock.runs_ms.size())});
    }
    return timings;
}

}  // namespace obscura
