#include "bench/stereo/stereo_bench.h"

#include <fmt/format.h>

#include "bench/harness/report.h"
#include "bench/stereo/peers.h"
#include "bench/stereo/report.h"
#include "core/stopwatch.h"

namespace obscura {

StereoBenchPlan stereo_bench_plan(bool quick, int rounds) {
    StereoBenchPlan plan;
    plan.rounds = rounds;
    if (quick) {
        plan.sizes = {{64, 36}, {96, 54}};
        plan.case_sizes = {{96, 54}};
        plan.rounds = 1;
        plan.budget_ms = 20;
        plan.curve_iterations = 6;
        plan.case_iterations = 12;
        plan.cascade_sweeps = {2, 10};
        plan.longest_cg_ms = plan.longest_cg_ic_ms = 2e3;
        return plan;
    }
    plan.sizes = {{480, 270}, {960, 540}, {1920, 1080}};
    plan.case_sizes = {{480, 270}, {960, 540}};
    return plan;
}

StereoSubject stereo_subject(StereoCase stereo_case, StereoSize size) {
    StereoSubject subject;
    subject.size = size;
    subject.system = stereo_bench_system(stereo_case, size.width, size.height);
    subject.matrix = stereo_matrix(subject.system);
    subject.truth = stereo_truth(subject.system, subject.matrix);
    return subject;
}

int bench_stereo(const BenchOptions& given) {
    // A run takes minutes: lines of progress say how many have passed.
    BenchOptions options = given;
    options.say = [&given, watch = Stopwatch()](const std::string& line) {
        given.say(fmt::format("{:5.0f} s  {}", watch.seconds(), line));
    };
    const StereoBenchPlan plan = stereo_bench_plan(options.quick, options.runs);
    make_output_folder(options);
    StereoResults results;
    results.cholmod = version_of_cholmod();
    results.eigen = version_of_eigen();
    for (const StereoSize size : plan.sizes) {
        options.say(fmt::format("{} x {}: truth", size.width, size.height));
        const StereoSubject subject = stereo_subject(StereoCase::base, size);
        results.truths.push_back({stereo_case_name(StereoCase::base), size.width, size.height,
                                  subject.truth.by, subject.truth.residual});
        options.say(fmt::format("{} x {}: our methods", size.width, size.height));
        measure_methods(subject, plan, options, results);
        for (PreviewRow& row : measure_previews(subject, plan, options))
            results.previews.push_back(row);
        for (StereoRow& row : measure_peers(subject, plan, options))
            results.rows.push_back(std::move(row));
    }
    measure_cases(plan, options, results);
    write_stereo_report(results, options);
    draw_stereo_chart(results, options);
    options.say(fmt::format("wrote {}", (options.out / "stereo.md").string()));
    return 0;
}

}  // namespace obscura
