// Wrong pixels against the size of the map. Built only with Embree, which supplies the truth.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/shadows/methods.h"
#include "bench/shadows/shadow_bench.h"
#include "bench/shadows/shadow_rays.h"
#include "bench/shadows/wrong_picture.h"
#include "core/file_output.h"
#include "core/image_io.h"
#include "core/parallel.h"
#include "filters/shadow_lookup.h"

namespace obscura {
namespace {

/// One scene with its truth and, per size, what the dense maps got wrong.
struct Judge {
    const ShadowRecipe& recipe;
    const BenchOptions& options;
    Exec exec;
    Scene scene;
    VisiblePoints points;
    ExactRays rays;
    TrueShadows truth;
    std::vector<std::pair<int, std::vector<std::uint8_t>>> dense_kinds;

    Judge(const ShadowRecipe& recipe_, const ShadowBenchPlan& plan, const BenchOptions& options_)
        : recipe(recipe_),
          options(options_),
          exec{best_isa(), hardware_threads()},
          scene(stage_shadows(recipe_, plan.picture)),
          points(visible_points(scene, exec)),
          rays(scene.mesh),
          truth(true_shadows_of(scene, points, rays, exec)) {}
};

AccuracyRow judge_map(Judge& judge, const char* method, int size, const BuiltShadow& built,
                      std::vector<std::uint8_t>& kinds) {
    AccuracyRow row;
    row.scene = judge.recipe.name;
    row.triangles = judge.scene.mesh.triangles.size();
    row.method = method;
    row.size = size;
    row.bytes = built.bytes;
    row.build_s = built.build_s;
    const auto shown = shown_shadows(judge.points, built.lookups(judge.exec.isa)[0].block, judge.exec);
    row.wrong = wrong_pixels(judge.truth, shown, built.view, judge.exec, &kinds);
    judge.options.say(fmt::format("{}, {} {}: {:.4f} % wrong ({} of {}; {})", row.scene, method, size,
                                  100 * row.wrong.fraction(), row.wrong.wrong, row.wrong.covered,
                                  kinds_text(row.wrong)));
    return row;
}

/// Nodes that kernels of 5 x 5 visit, over every seventh sample that faces the light.
void count_steps(const Judge& judge, const BuiltShadow& built, AccuracyRow& row) {
    PcfLight light = built.light;
    light.side = 5;
    std::vector<ref::PcfSteps> sums(judge.points.blocks.size());
    std::vector<int> counts(sums.size(), 0);
    parallel_for(sums.size(), judge.exec, [&](std::size_t b) {
        for (int at = static_cast<int>(b % 7); at < block_samples; at += 7) {
            const ref::PcfSteps steps = ref::pcf_steps(judge.points.blocks[b], light, at);
            if (steps.naive == 0) continue;
            sums[b].naive += steps.naive;
            sums[b].shared += steps.shared;
            ++counts[b];
        }
    });
    double count = 0;
    for (std::size_t b = 0; b < sums.size(); ++b) {
        row.naive_steps += sums[b].naive;
        row.shared_steps += sums[b].shared;
        count += counts[b];
    }
    row.naive_steps /= std::max(count, 1.0);
    row.shared_steps /= std::max(count, 1.0);
}

/// Against the dense map of the same size, if there is one.
void compare_with_dense(const Judge& judge, const std::vector<std::uint8_t>& kinds, AccuracyRow& row) {
    for (const auto& [size, dense] : judge.dense_kinds) {
        if (size != row.size) continue;
        row.has_dense = true;
        for (std::size_t p = 0; p < kinds.size(); ++p) {
            row.worse += kinds[p] != 0 && dense[p] == 0 ? 1 : 0;
            row.better += kinds[p] == 0 && dense[p] != 0 ? 1 : 0;
        }
        judge.options.say(
            fmt::format("{}, {}: compressed is wrong at {} pixels where dense is right, right at "
                        "{} where dense is wrong",
                        row.scene, size, row.worse, row.better));
    }
}

/// The rays that are timed: they start a little off the surface, and are not the truth either.
AccuracyRow judge_rays(Judge& judge) {
    AccuracyRow row;
    row.scene = judge.recipe.name;
    row.triangles = judge.scene.mesh.triangles.size();
    row.method = embree_name;
    std::vector<std::uint8_t> shown(judge.truth.truth.size());
    const Session session =
        open_shadow_rays(judge.scene.mesh, judge.points, judge.truth.to_light, shown, judge.exec);
    session.jobs[0].run();
    row.bytes = std::llround(session.prepare_mib * (1 << 20));
    row.build_s = 1e-3 * session.prepare_ms;
    row.wrong.covered = judge.points.covered;
    for (std::size_t p = 0; p < shown.size(); ++p) {
        const Truth truth = judge.truth.truth[p];
        if (truth != Truth::lit && truth != Truth::dark) continue;
        ++row.wrong.facing;
        const bool differs = (shown[p] != 0) != (truth == Truth::lit);
        row.wrong.wrong += differs ? 1 : 0;
        row.wrong.leaks += differs && shown[p] != 0 ? 1 : 0;
    }
    judge.options.say(fmt::format("{}, Embree's timed rays: {:.4f} % wrong ({} of {})", row.scene,
                                  100 * row.wrong.fraction(), row.wrong.wrong, row.wrong.covered));
    return row;
}

void paint(const Judge& judge, const std::vector<std::uint8_t>& kinds) {
    const Image<Rgb8> picture = wrong_picture(judge.truth, kinds);
    write_file_atomically(judge.options.out / fmt::format("shadows_{}.png", judge.recipe.name),
                          encode_png(picture.view()), Existing::replace);
}

}  // namespace

std::vector<AccuracyRow> measure_accuracy(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                          const BenchOptions& options) {
    options.say(fmt::format("{}: exact shadow rays", recipe.name));
    Judge judge(recipe, plan, options);
    std::vector<AccuracyRow> rows;
    for (const int size : plan.dense_sizes) {
        std::vector<std::uint8_t> kinds;
        rows.push_back(judge_map(judge, dense_name, size, build_dense(judge.scene, size, judge.exec), kinds));
        if (size == plan.picture_size) paint(judge, kinds);
        judge.dense_kinds.emplace_back(size, std::move(kinds));
    }
    double last_s = 0;
    std::int64_t last_bytes = 0;
    for (const int size : plan.compressed_sizes) {
        if (!left_out(plan, recipe.name, size, last_s, last_bytes).empty()) break;
        std::vector<std::uint8_t> kinds;
        const BuiltShadow built = build_compressed(judge.scene, size, judge.exec);
        rows.push_back(judge_map(judge, compressed_name, size, built, kinds));
        last_s = built.build_s;
        last_bytes = built.bytes;
        count_steps(judge, built, rows.back());
        compare_with_dense(judge, kinds, rows.back());
    }
    rows.push_back(judge_rays(judge));
    return rows;
}

}  // namespace obscura
