// Solves of lower resolution, brought up to full size: the picture that an artist waits for.

#include <fmt/format.h>

#include <memory>

#include "bench/harness/interleave.h"
#include "bench/stereo/stereo_bench.h"
#include "stereo/reduced_system.h"
#include "stereo/solver/solver.h"
#include "stereo/upsample.h"

namespace obscura {
namespace {

struct Preview {
    const DisparitySystem* full = nullptr;
    const MiddleView* view = nullptr;
    std::string way;
    int reduction = 1;
    Exec exec;
    MiddleView low = {};
    DisparitySystem system = {};
    DisparityMap solved = {}, upsampled = {};

    void build() { system = reduced_system(*full, *view, reduction, exec); }
    void solve_low() {
        SolverParams params;
        params.verify = false;
        solved = solve(way.empty() ? *full : system, params, exec).disparity;
    }
    void upsample() { upsampled = upsampled_solution(*view, low, solved, UpsampleParams{}, exec); }
};

using Previews = std::vector<std::unique_ptr<Preview>>;

Previews make_previews(const StereoSubject& subject, const MiddleView& view, int threads) {
    Previews previews;
    const auto add = [&](const char* way, int reduction) {
        previews.push_back(std::make_unique<Preview>(
            Preview{&subject.system, &view, way, reduction, Exec{.threads = threads}}));
        Preview& preview = *previews.back();
        if (preview.way.empty()) return;
        preview.low = reduced(view, reduction);
        preview.system = stereo_bench_system(StereoCase::base, preview.low);
    };
    add("", 1);
    for (const int reduction : {2, 4, 8}) {
        add(sampled_way, reduction);
        add(summed_way, reduction);
    }
    return previews;
}

}  // namespace

std::vector<PreviewRow> measure_previews(const StereoSubject& subject, const StereoBenchPlan& plan,
                                         const BenchOptions& options) {
    options.say(fmt::format("{} x {}: previews", subject.size.width, subject.size.height));
    const MiddleView view = stereo_bench_view(StereoCase::base, subject.size.width, subject.size.height);
    Previews previews;
    for (const int threads : options.threads) {
        for (auto& preview : make_previews(subject, view, threads))
            previews.push_back(std::move(preview));
    }
    std::vector<PreviewRow> rows;
    std::vector<TimedJob> timed;
    std::vector<double PreviewRow::*> where;
    std::vector<std::size_t> row_of;
    for (const auto& preview : previews) {
        const auto add = [&, p = preview.get()](double PreviewRow::*part, void (Preview::*run)()) {
            timed.push_back({p->way, [p, run] { (p->*run)(); }});
            where.push_back(part);
            row_of.push_back(rows.size());
        };
        if (preview->way == summed_way) add(&PreviewRow::build_ms, &Preview::build);
        add(&PreviewRow::solve_ms, &Preview::solve_low);
        if (!preview->way.empty()) add(&PreviewRow::upsample_ms, &Preview::upsample);
        rows.push_back({subject.size.width, subject.size.height, preview->reduction, preview->exec.threads,
                        preview->way});
    }
    TimingPlan timing;
    timing.rounds = plan.rounds;
    timing.budget_ms = plan.budget_ms;
    const std::vector<Timing> timings = time_interleaved(timed, timing);
    for (std::size_t i = 0; i < timed.size(); ++i)
        rows[row_of[i]].*where[i] = timings[i].least_ms;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        PreviewRow& row = rows[i];
        row.ms = row.build_ms + row.solve_ms + row.upsample_ms;
        const Preview& preview = *previews[i];
        row.error = map_error(subject.system, preview.way.empty() ? preview.solved : preview.upsampled,
                              subject.truth.x);
    }
    return rows;
}

}  // namespace obscura
