#include "bench/raster/raster_bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/harness/recipes.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/raster/charts.h"
#include "bench/raster/report.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr BenchSize full_size{4096, 1920, 1080};
constexpr BenchSize quick_size{512, 320, 180};

/// One line per scene and workload: ours beside the best peer with most threads.
void say_headline(const std::vector<BenchRow>& rows, const std::string& scene, const BenchOptions& options) {
    const int threads = *std::max_element(options.threads.begin(), options.threads.end());
    for (const Workload workload : all_workloads) {
        const BenchRow* our = fastest(rows, scene, workload, threads,
                                      [](const BenchRow& row) { return row.contestant == our_name; });
        const BenchRow* peer = fastest(rows, scene, workload, threads,
                                       [](const BenchRow& row) { return row.contestant != our_name; });
        if (our == nullptr || peer == nullptr) continue;
        options.say(
            fmt::format("{}, {}, {} threads: {:.1f} ms; best peer {} ({}) {:.1f} ms, {:.2f} times ours",
                        scene, workload_name(workload), threads, median(our->runs_ms), peer->contestant,
                        peer->method, median(peer->runs_ms), *ratio_to_ours(rows, *peer)));
    }
}

/// Says every problem once. Returns whether one of them is ours.
bool say_problems(const std::vector<BenchRow>& rows, const BenchOptions& options) {
    std::vector<std::string> said;
    bool ours = false;
    for (const BenchRow& row : rows) {
        if (row.problem.empty()) continue;
        ours = ours || row.contestant == our_name;
        const std::string text = fmt::format("{}: {}", row.contestant, row.problem);
        if (std::find(said.begin(), said.end(), text) == said.end()) said.push_back(text);
    }
    for (const std::string& text : said)
        options.say(text);
    return ours;
}

}  // namespace

int bench_raster(const BenchOptions& options) {
    if (options.runs < 1) throw UsageError("a bench needs at least one run");
    if (options.threads.empty()) throw UsageError("a bench needs at least one thread count");
    const std::vector<Contestant> contestants = all_contestants();
    std::vector<BenchRow> rows;
    for (const BenchRecipe& recipe : bench_recipes(options.data, options.quick)) {
        if (recipe.name.find(options.scene) == std::string::npos) continue;
        options.say(fmt::format("{}: making the scene", recipe.name));
        const BenchScene scene =
            stage_scene(recipe.name, recipe.make(), options.quick ? quick_size : full_size);
        for (BenchRow& row : measure_scene(contestants, scene, options))
            rows.push_back(std::move(row));
        say_headline(rows, recipe.name, options);
    }
    check_chosen(!rows.empty(), options);
    if (!options.data) options.say("no folder of test data: scenes from scanned meshes are left out");
    const bool ours_failed = say_problems(rows, options);
    write_report(rows, options);
    draw_charts(rows, options);
    options.say(fmt::format("written to {}", options.out.string()));
    return static_cast<int>(ours_failed ? ExitCode::internal : ExitCode::ok);
}

}  // namespace obscura
