// Error against time: what each way to make a picture's shadows takes, and what it gets wrong. Built only
// with Embree, which supplies the truth.

#include <fmt/format.h>

#include <algorithm>

#include "bench/harness/run_times.h"
#include "bench/shadows/exact_bench.h"
#include "bench/shadows/exact_wrong.h"
#include "bench/shadows/methods.h"
#include "bench/shadows/shadow_rays.h"
#include "bench/shadows/wrong_sweep.h"
#include "core/error.h"

namespace obscura {
namespace {

/// The faster of two runs.
double seconds_of(const std::function<void()>& run) {
    const double first = milliseconds_of(run), second = milliseconds_of(run);
    return 1e-3 * std::min(first, second);
}

std::size_t count_differing(const TrueShadows& truth, const std::vector<std::uint8_t>& shown,
                            const Exec& exec) {
    return count_wrong(
               truth, shown, [](std::size_t, int, Truth) { return Wrong::unexplained; }, exec)
        .wrong;
}

ErrorTimeRow of_dense(SweepStage& stage, ErrorTimeRow row) {
    const BuiltShadow built = build_dense(stage.scene, row.size, stage.exec);
    const BlockLookup lookup = built.lookups(stage.exec.isa)[0].block;
    std::vector<std::uint8_t> shown;
    row.build_s = built.build_s;
    row.lookup_s = seconds_of([&] { shown = shown_shadows(stage.points, lookup, stage.exec); });
    row.wrong = count_differing(stage.truth, shown, stage.exec);
    return row;
}

ErrorTimeRow of_tree(SweepStage& stage, ErrorTimeRow row) {
    ShadowSettings settings;
    settings.filter_px = 1;
    settings.resolution = row.size;
    const SweepResult result = sweep_shadow(stage, settings);
    row.found = result.found ? result.found->resolution : row.size;
    row.build_s = result.build_s;
    row.lookup_s = result.lookup_s;
    row.wrong = result.wrong.wrong;
    return row;
}

ErrorTimeRow of_exact(SweepStage& stage, ErrorTimeRow row) {
    ShadowSettings settings;
    settings.method = ShadowMethod::exact;
    row.wrong = sweep_shadow(stage, settings).wrong.wrong;
    const FrameSamples samples = frame_samples(stage.scene, stage.exec);
    const Session session = open_exact(stage.scene, samples, stage.exec);
    row.build_s = seconds_of(session.jobs[0].run);
    row.lookup_s = seconds_of(session.jobs[1].run);
    return row;
}

ErrorTimeRow of_rays(SweepStage& stage, ErrorTimeRow row) {
    std::vector<std::uint8_t> shown(stage.truth.truth.size());
    // Closer to the surface than the rays that the other parts time, as far as floats allow: they err less.
    const Session session =
        open_shadow_rays(stage.scene.mesh, stage.points, stage.truth.to_light, shown, stage.exec, 1e-6);
    row.build_s = 1e-3 * session.prepare_ms;
    row.lookup_s = seconds_of(session.jobs[0].run);
    row.wrong = count_differing(stage.truth, shown, stage.exec);
    return row;
}

}  // namespace

std::vector<ErrorTimeRow> measure_error_times(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                              const BenchOptions& options) {
    SweepStage stage(recipe, plan.picture);
    std::vector<ErrorTimeRow> rows;
    const auto add = [&](const char* method, int size, ErrorTimeRow (*measure)(SweepStage&, ErrorTimeRow)) {
        ErrorTimeRow row;
        row.scene = recipe.name;
        row.method = method;
        row.triangles = stage.scene.mesh.triangles.size();
        row.size = size;
        row.covered = stage.points.covered;
        try {
            row = measure(stage, row);
        } catch (const LimitError& error) {
            options.say(fmt::format("{}, {} {}: {}", row.scene, method, size, error.what()));
            return;
        }
        options.say(fmt::format("{}, {} {}: {} of {} wrong, {:.3f} s and {:.3f} s", row.scene, method, size,
                                row.wrong, row.covered, row.build_s, row.lookup_s));
        rows.push_back(row);
    };
    for (const int size : plan.dense_sizes)
        add(dense_name, size, of_dense);
    add(compressed_name, auto_resolution, of_tree);
    add(compressed_name, most_map_resolution, of_tree);
    add(exact_name, 0, of_exact);
    add(embree_name, 0, of_rays);
    return rows;
}

}  // namespace obscura
