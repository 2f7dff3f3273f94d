#include "bench/diffraction/diffraction_bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/diffraction/cases.h"
#include "bench/diffraction/report.h"
#include "bench/harness/report.h"
#include "core/error.h"

namespace obscura {

DiffractionBenchPlan diffraction_bench_plan(bool quick, int rounds) {
    DiffractionBenchPlan plan;
    plan.timing.rounds = rounds;
    if (quick) {
        plan.sizes = {64, 128};
        plan.window_sizes = {128};
        plan.window_px = 64;
        plan.near_sizes = {32, 64};
        plan.padded_sizes = {32};
        plan.control_size = 64;
        plan.quality_size = 128;
        plan.timing = {1, 0.5, 20};
        return plan;
    }
    plan.sizes = {256, 512, 1024, 2048, 4096};
    plan.window_sizes = {256, 512, 1024, 2048};
    plan.near_sizes = {512, 1024, 2048};
    plan.padded_sizes = {512};
    return plan;
}

std::vector<std::string> chosen_apertures(const BenchOptions& options) {
    std::vector<std::string> chosen;
    for (const std::string& name : aperture_names(options.data)) {
        if (name.find(options.scene) != std::string::npos) chosen.push_back(name);
    }
    check_chosen(!chosen.empty(), options, "aperture");
    return chosen;
}

int bench_diffraction(const BenchOptions& options) {
    const DiffractionBenchPlan plan = diffraction_bench_plan(options.quick, options.runs);
    make_output_folder(options);
    DiffractionResults results;
    for (const auto measure : {measure_far, measure_windows, measure_near}) {
        for (DiffractionRow& row : measure(plan, options))
            results.rows.push_back(std::move(row));
    }
    options.say("tables of the thesis");
    results.controls = measure_controls(plan, options);
    results.quads = measure_quads(plan);
    results.culling = measure_culling(plan);
    results.spectra = measure_spectra(plan);
    results.quality = measure_quality(plan, options);
    write_diffraction_report(results, options);
    draw_diffraction_charts(results, options);
    options.say(fmt::format("written to {}", options.out.string()));
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
