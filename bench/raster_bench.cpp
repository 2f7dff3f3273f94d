#include "bench/raster_bench.h"

#include <fmt/format.h>

#include "bench/charts.h"
#include "bench/report.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr BenchSize full_size{4096, 1920, 1080};
constexpr BenchSize quick_size{512, 320, 180};

void say_absent(const std::vector<Contestant>& contestants, const BenchOptions& options) {
    for (const Contestant& contestant : contestants) {
        if (!contestant.absent.empty())
            options.say(fmt::format("{}: absent, {}", contestant.name, contestant.absent));
    }
}

}  // namespace

int bench_raster(const BenchOptions& options) {
    const std::vector<Contestant> contestants = all_contestants();
    say_absent(contestants, options);
    const BenchSize size = options.quick ? quick_size : full_size;
    std::vector<BenchRow> rows;
    for (const BenchRecipe& recipe : bench_recipes(options)) {
        if (recipe.name.find(options.scene) == std::string::npos) continue;
        const BenchScene scene = stage_scene(recipe.name, recipe.make(), size);
        for (BenchRow& row : measure_scene(contestants, scene, options))
            rows.push_back(std::move(row));
    }
    if (rows.empty()) throw UsageError(fmt::format("no bench scene has \"{}\" in its name", options.scene));
    write_report(rows, options);
    draw_charts(rows, options);
    return has_problem(rows, "Obscura") ? static_cast<int>(ExitCode::internal)
                                        : static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
