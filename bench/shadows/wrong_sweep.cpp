#include "bench/shadows/wrong_sweep.h"

#include <fmt/format.h>

#include "app/frame/shadows.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/shadows/sweep_scenes.h"
#include "core/error.h"
#include "core/stopwatch.h"

namespace obscura {

SweepStage::SweepStage(const ShadowRecipe& recipe, const PictureSize& picture)
    : scene(stage_shadows(recipe, picture)),
      points(visible_points(scene, exec)),
      rays(scene.mesh),
      truth(true_shadows_of(scene, points, rays, exec)) {}

SweepResult sweep_shadow(SweepStage& stage, const ShadowSettings& settings) {
    Scene& scene = stage.scene;
    scene.lights[0].shadow = settings;
    scene.render.receivers = settings.receivers;
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, stage.exec, cache, stats);
    TileScene tiles = prepare_tiles(scene, stage.exec, cache);
    const Stopwatch watch;
    CHECK(prepare_shadows(scene, 0, stage.exec, cache, tiles, stats));
    SweepResult result;
    result.build_s = watch.seconds();
    const LightShadow& shadow = cache.shadows.at(0);
    const PcfLight& pcf = *tiles.lights.at(0).pcf;
    const auto lookup = [&](const SurfaceBlock& surface, float* visibility) {
        OBSCURA_DISPATCH(stage.exec.isa, pcf_block, surface, pcf, visibility);
    };
    const auto shown = shown_shadows(stage.points, lookup, stage.exec);
    result.found = shadow.stats.found;
    result.bytes = shadow.stats.bytes;
    result.wrong = wrong_pixels(stage.truth, shown, shadow.view(0), stage.exec);
    return result;
}

std::vector<SweepRow> measure_sweep(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                    const BenchOptions& options) {
    std::vector<SweepRow> rows;
    for (const double elevation : {40.0, 8.0}) {
        SweepStage stage(with_sun_at(recipe, elevation), plan.picture);
        for (const int size : {auto_resolution, most_map_resolution}) {
            SweepRow row{recipe.name, stage.scene.mesh.triangles.size(), elevation, size, 0, 0, 0, {}, {}};
            ShadowSettings settings;
            settings.filter_px = 1;
            settings.resolution = size;
            try {
                const SweepResult result = sweep_shadow(stage, settings);
                row.found = result.found ? result.found->resolution : size;
                row.bytes = result.bytes;
                row.build_s = result.build_s;
                row.wrong = result.wrong;
            } catch (const LimitError& error) {
                row.problem = error.what();
            }
            options.say(fmt::format(
                "{}, sun at {} degrees, {}: {}", row.scene, elevation,
                size == auto_resolution ? fmt::format("auto, {}", row.found) : fmt::format("{}", size),
                row.problem.empty()
                    ? fmt::format("{:.4f} % wrong ({} of {}, {} lit; {}), {:.1f} MB, {:.2f} s",
                                  100 * row.wrong.fraction(), row.wrong.wrong, row.wrong.covered,
                                  row.wrong.leaks, kinds_text(row.wrong),
                                  1e-6 * static_cast<double>(row.bytes), row.build_s)
                    : row.problem));
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

}  // namespace obscura
