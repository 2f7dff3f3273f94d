#include "bench/shadows/wrong_sweep.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/shadows.h"
#include "bench/shadows/exact_wrong.h"
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
    const TileLight& light = tiles.lights.at(0);
    result.found = shadow.stats.found;
    result.bytes = shadow.stats.bytes;
    if (light.exact) {
        const ExactPicture picture{&stage.truth, &*light.exact, tiles.rays};
        const auto kind_of = [&](std::size_t block, int at, Truth shown) {
            return kind_of_exact(picture, block, at, shown);
        };
        const BlockLookup lookup = exact_lookup(scene.mesh, *light.exact, stage.exec.isa);
        result.wrong =
            count_wrong(stage.truth, shown_shadows(stage.points, lookup, stage.exec), kind_of, stage.exec);
        return result;
    }
    const BlockLookup lookup = [&](const SurfaceBlock& surface, float* visibility) {
        OBSCURA_DISPATCH(stage.exec.isa, pcf_block, surface, *light.pcf, visibility);
    };
    const Stopwatch first;
    std::vector<std::uint8_t> shown = shown_shadows(stage.points, lookup, stage.exec);
    result.lookup_s = first.seconds();
    const Stopwatch second;
    shown = shown_shadows(stage.points, lookup, stage.exec);
    result.lookup_s = std::min(result.lookup_s, second.seconds());
    result.wrong = wrong_pixels(stage.truth, shown, shadow.view(0), stage.exec);
    return result;
}

namespace {

std::string what_was_asked(const SweepRow& row) {
    if (row.method == exact_name) return exact_name;
    if (row.asked != auto_resolution) return fmt::format("{}", row.asked);
    return row.magnification == 1
               ? fmt::format("auto, {}", row.found)
               : fmt::format("auto of 1/{:.0f} pixel, {}", 1 / row.magnification, row.found);
}

SweepRow sweep_row(SweepStage& stage, SweepRow row, const ShadowSettings& settings,
                   const BenchOptions& options) {
    try {
        const SweepResult result = sweep_shadow(stage, settings);
        row.found = result.found ? result.found->resolution : row.asked;
        row.bytes = result.bytes;
        row.build_s = result.build_s;
        row.wrong = result.wrong;
    } catch (const LimitError& error) {
        row.problem = error.what();
    }
    options.say(fmt::format(
        "{}, sun at {} degrees, {}: {}", row.scene, row.elevation_deg, what_was_asked(row),
        row.problem.empty()
            ? fmt::format("{:.4f} % wrong ({} of {}, {} lit; {}), {:.1f} MB, {:.2f} s",
                          100 * row.wrong.fraction(), row.wrong.wrong, row.wrong.covered, row.wrong.leaks,
                          kinds_text(row.wrong), 1e-6 * static_cast<double>(row.bytes), row.build_s)
            : row.problem));
    return row;
}

}  // namespace

std::vector<SweepRow> measure_sweep(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                    const BenchOptions& options) {
    std::vector<SweepRow> rows;
    for (const double elevation : {40.0, 8.0, 1.0}) {
        SweepStage stage(with_sun_at(recipe, elevation), plan.picture);
        SweepRow row;
        row.scene = recipe.name;
        row.triangles = stage.scene.mesh.triangles.size();
        row.elevation_deg = elevation;
        row.method = exact_name;
        ShadowSettings settings;
        settings.filter_px = 1;
        settings.method = ShadowMethod::exact;
        rows.push_back(sweep_row(stage, row, settings, options));
        row.method = compressed_name;
        settings.method = ShadowMethod::compressed;
        for (const double magnification : {1.0, 1.0 / 4, 1.0 / 16, frame_magnification}) {
            row.magnification = settings.max_magnification = magnification;
            rows.push_back(sweep_row(stage, row, settings, options));
        }
        row.asked = settings.resolution = most_map_resolution;
        row.magnification = 1;
        rows.push_back(sweep_row(stage, row, settings, options));
    }
    return rows;
}

}  // namespace obscura
