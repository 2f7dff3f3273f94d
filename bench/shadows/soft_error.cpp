#include "bench/shadows/soft_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/frame/stack_shadow.h"
#include "bench/harness/gnuplot.h"
#include "bench/harness/machine.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/shadows/exact_session.h"
#include "bench/shadows/report.h"
#include "bench/shadows/soft_bench.h"
#include "bench/shadows/soft_session.h"
#include "core/error.h"
#include "hierarchy/stack/visible_share.h"

namespace obscura {
namespace {

/// Of the covered samples, in the order of FrameSamples.
using Shares = std::vector<float>;

bool is_set(const std::vector<std::uint32_t>& words, std::size_t i) {
    return (words[i / 16] >> (i % 16) & 1u) != 0;
}

/// Calls visit(i) for each covered sample.
template <class Visit>
void for_each_covered(const FrameSamples& samples, Visit&& visit) {
    for (std::size_t i = 0; i < samples.tiles * samples.per_tile(); ++i) {
        if ((samples.covered_words[i / 16] >> (i % 16) & 1u) != 0) visit(i);
    }
}

Shares shares_of(const FrameSamples& samples, const LitOfPoints& lit) {
    Shares shares;
    for_each_covered(samples, [&](std::size_t i) {
        const auto count =
            std::count_if(lit.begin(), lit.end(), [&](const auto& words) { return is_set(words, i); });
        shares.push_back(static_cast<float>(count) / static_cast<float>(lit.size()));
    });
    return shares;
}

double rmse_of(const Shares& shares, const Shares& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double d = static_cast<double>(shares[i]) - static_cast<double>(truth[i]);
        sum += d * d;
    }
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(shares.size(), 1)));
}

/// A scene under one light, its samples, and what is true of them.
struct Stage {
    const Scene& scene;
    const FrameSamples& samples;
    Exec exec;
    int texels;
    Shares truth;
    LitOfPoints exact;  ///< of the points asked last
};

void by_exact(Stage& stage, SoftErrorRow& row) {
    SoftTimes times;
    stage.exact = soft_shadows(stage.scene, stage.samples, row.points, stage.exec, &times);
    row.build_ms = times.order_ms;
    row.lookup_ms = times.lookup_ms;
    row.rmse = rmse_of(shares_of(stage.samples, stage.exact), stage.truth);
}

void by_stack(Stage& stage, SoftErrorRow& row) {
    SceneLight light = stage.scene.lights[0];
    light.shadow.method = ShadowMethod::stack;
    light.shadow.samples = row.points;
    row.texels = light.shadow.resolution = stage.texels;
    std::vector<float> place[3];
    for_each_covered(stage.samples, [&](std::size_t i) {
        const Vec3d& eye = stage.scene.camera.eye;
        place[0].push_back(static_cast<float>(stage.samples.px[i] - eye.x));
        place[1].push_back(static_cast<float>(stage.samples.py[i] - eye.y));
        place[2].push_back(static_cast<float>(stage.samples.pz[i] - eye.z));
    });
    std::vector<float> normal[3];
    for_each_covered(stage.samples, [&](std::size_t i) {
        normal[0].push_back(stage.samples.gx[i]);
        normal[1].push_back(stage.samples.gy[i]);
        normal[2].push_back(stage.samples.gz[i]);
    });
    const StackPoints points{place[0].data(),  place[1].data(),  place[2].data(), normal[0].data(),
                             normal[1].data(), normal[2].data(), nullptr,         place[0].size()};
    ShadowStack stack;
    row.build_ms = milliseconds_of([&] {
        const FocusedViews views =
            stack_views(stage.scene.mesh, plan_stack(stage.scene.mesh, light), stage.texels);
        StackBuildParams params;
        params.tree.anisotropies = {-2};
        stack = build_stack(stage.scene.mesh, views, params, stage.exec);
    });
    row.bytes = stack.bytes;
    Shares shares;
    row.lookup_ms = milliseconds_of(
        [&] { shares = visible_share(stack_lookup(stack, stage.scene.camera.eye), points, 0, stage.exec); });
    row.rmse = rmse_of(shares, stage.truth);
}

#ifdef OBSCURA_HAS_EMBREE
/// Pairs of which nothing can darken the sample are no ray's work: they are as `exact` has them.
void by_rays(Stage& stage, SoftErrorRow& row) {
    const TracedSamples traced =
        trace_samples(with_points(stage.scene, row.points), stage.samples, stage.exec);
    row.build_ms = traced.hierarchy_ms;
    row.lookup_ms = traced.trace_ms;
    LitOfPoints lit = stage.exact;
    for (std::size_t p = 0; p < lit.size(); ++p) {
        for (std::size_t w = 0; w < lit[p].size(); ++w)
            lit[p][w] = (traced.lit[p][w] & traced.asked[p][w]) | (lit[p][w] & ~traced.asked[p][w]);
    }
    row.rmse = rmse_of(shares_of(stage.samples, lit), stage.truth);
}
#endif

struct Way {
    const char* name;
    void (*measure)(Stage& stage, SoftErrorRow& row);
};
constexpr Way ways[] = {
    {exact_name, by_exact},
    {stack_name, by_stack},
#ifdef OBSCURA_HAS_EMBREE
    {embree_name, by_rays},
#endif
};

MethodStyle soft_style(const std::string& method) {
    return shadow_style(method == stack_name ? compressed_name : method);
}

}  // namespace

SoftErrorPlan soft_error_plan(bool quick) {
    SoftErrorPlan plan;
    if (quick) plan = {{128, 64}, {4, 16}, 64, 256, plan.most_triangles};
    return plan;
}

std::vector<SoftErrorRow> measure_soft_errors(const ShadowRecipe& recipe, const SoftErrorPlan& plan,
                                              const BenchOptions& options) {
    Scene scene = stage_shadows(recipe, plan.picture);
    scene.render.samples = 1;
    scene.lights.resize(1);
    scene.lights[0].shadow.method = ShadowMethod::exact;
    const SceneLight sun = scene.lights[0];
    const Exec exec{best_isa(), options.threads.back()};
    const FrameSamples samples = frame_samples(scene, exec);
    std::vector<SoftErrorRow> rows;
    for (const SoftSubject& subject : soft_subjects()) {
        if (subject.name == std::string("a disc of 0.53 degrees")) continue;
        scene.lights[0] = sun;
        subject.shape(scene, scene.lights[0].light);
        const std::size_t triangles = scene.mesh.triangles.size();
        if (!is_parallel(scene.lights[0].light.kind) && triangles > plan.most_triangles) continue;
        Stage stage{scene, samples, exec, plan.texels, {}, {}};
        stage.truth = shares_of(samples, soft_shadows(scene, samples, plan.reference_points, exec));
        for (const int points : plan.points) {
            for (const Way& way : ways) {
                SoftErrorRow row{recipe.name, subject.name, way.name, triangles, samples.covered, points};
                way.measure(stage, row);
                options.say(fmt::format("{}, {}, {} points, {}: rmse {:.5f}, {:.0f} ms and {:.0f} ms",
                                        row.scene, row.light, points, row.method, row.rmse, row.build_ms,
                                        row.lookup_ms));
                rows.push_back(std::move(row));
            }
        }
    }
    return rows;
}

std::string soft_error_csv(const std::vector<SoftErrorRow>& rows) {
    std::string text = "scene,light,method,triangles,covered,points,texels,build_ms,lookup_ms,rmse,bytes\n";
    for (const SoftErrorRow& row : rows)
        text += fmt::format("{},{},{},{},{},{},{},{:.2f},{:.2f},{:.6f},{}\n", row.scene, row.light,
                            row.method, row.triangles, row.covered, row.points, row.texels, row.build_ms,
                            row.lookup_ms, row.rmse, row.bytes);
    return text;
}

std::string soft_error_markdown(const std::vector<SoftErrorRow>& rows, const SoftErrorPlan& plan) {
    std::string text = fmt::format(
        "\n![chart](shadows_soft_error.svg)\n\nA picture of {} x {} with one sample a pixel. Error: root "
        "mean square difference of the share of the light that reaches a sample, from that of {} points by "
        "exact shadows. The stack has maps of {} x {} texels of the same points that exact shadows ask; what "
        "its texels get wrong is left when points are many. Built: what casts shadows put in order (of a "
        "panel's points within asked), the stack, Embree's hierarchy; while scene and light stand still, all "
        "can be kept. One run of each, milliseconds.\n\n"
        "| scene | light | points | method | error | built | asked | MB "
        "|\n|---|---|--:|---|--:|--:|--:|--:|\n",
        plan.picture.width, plan.picture.height, plan.reference_points, plan.texels, plan.texels);
    for (const SoftErrorRow& row : rows) {
        text +=
            fmt::format("| {} | {} | {} | {} | {:.5f} | {:.0f} | {:.0f} | {} |\n", row.scene, row.light,
                        row.points, row.method, row.rmse, row.build_ms, row.lookup_ms,
                        row.bytes == 0 ? "-" : fmt::format("{:.1f}", 1e-6 * static_cast<double>(row.bytes)));
    }
    return text;
}

PanelChart soft_error_chart(const std::vector<SoftErrorRow>& rows, const SoftErrorPlan& plan) {
    PanelChart chart;
    chart.style_of = soft_style;
    chart.title = "Error of a light's share against time";
    chart.note = fmt::format(
        "{} x {} samples; points from left to right: {}. Hollow: lookups alone, the stack is kept.",
        plan.picture.width, plan.picture.height, fmt::join(plan.points, ", "));
    chart.x_label = "ms for a frame";
    chart.y_label = "rms error of the share";
    chart.x_tics = "set format x '%g'";
    chart.key_strip = true;
    for (const SoftErrorRow& row : rows) {
        const std::string name = row.scene + ", " + row.light;
        if (chart.panels.empty() || chart.panels.back().title != name) {
            chart.panels.push_back({name, "", {}});
            for (const Way& way : ways)
                chart.panels.back().lines.push_back({way.name, {}});
            chart.panels.back().lines.push_back({stack_name, {}, true, false, "stack, kept"});
        }
        std::vector<PanelLine>& lines = chart.panels.back().lines;
        for (PanelLine& line : lines) {
            if (line.method != row.method) continue;
            line.points.push_back({line.hollow ? row.lookup_ms : row.build_ms + row.lookup_ms, row.rmse});
        }
    }
    return chart;
}

int bench_soft_error(const BenchOptions& options) {
    const SoftErrorPlan plan = soft_error_plan(options.quick);
    std::vector<SoftErrorRow> rows;
    bool found = false;
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        const bool usual = options.quick || recipe.name == "vienna_west" || recipe.name == "city";
        if (options.scene.empty() ? !usual : recipe.name.find(options.scene) == std::string::npos) continue;
        found = true;
        for (SoftErrorRow& row : measure_soft_errors(recipe, plan, options))
            rows.push_back(std::move(row));
    }
    check_chosen(found, options);
    const std::string page =
        report_head("Error of soft shadows against time", "small pictures of a small scene", options) +
        machine_markdown({}) + soft_error_markdown(rows, plan);
    write_files(options, {{"shadows_soft_error.csv", soft_error_csv(rows)}, {"shadows_soft_error.md", page}});
    if (can_draw(options))
        run_gnuplot(panel_script(soft_error_chart(rows, plan)), options.out / "shadows_soft_error.svg");
    return static_cast<int>(ExitCode::ok);
}

}  // namespace obscura
