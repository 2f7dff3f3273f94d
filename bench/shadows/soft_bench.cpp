#include "bench/shadows/soft_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "bench/harness/gnuplot.h"
#include "bench/harness/machine.h"
#include "bench/harness/panel_chart.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/harness/worker.h"
#include "bench/shadows/exact_session.h"
#include "bench/shadows/report.h"
#include "bench/shadows/soft_session.h"
#include "core/error.h"
#include "core/mesh.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// The largest extent of what is seen, metres.
double extent_of(const Mesh& mesh) {
    const Bounds box = bounds_of(mesh);
    const Vec3d size = box.high - box.low;
    return std::max({size.x, size.y, size.z});
}

struct Rival {
    std::unique_ptr<Worker> worker;
    std::vector<double>* first;
    std::vector<double>* second;
};

void run_rivals(const Scene& scene, const Scene& many, const FrameSamples& samples,
                const BenchOptions& options, SoftRow& row) {
    const SharedFloats canvas(findings_floats);
    const Exec exec{best_isa(), row.threads};
    std::vector<Rival> rivals;
    rivals.push_back(
        {std::make_unique<Worker>(
             exact_name, [&] { return open_soft(scene, samples, row.points, exec); }, row.threads, canvas),
         &row.order_ms, &row.lookup_ms});
#ifdef OBSCURA_HAS_EMBREE
    rivals.push_back(
        {std::make_unique<Worker>(
             embree_name, [&] { return open_exact_rays(many, samples, exec); }, row.threads, canvas),
         &row.hierarchy_ms, &row.packets_ms});
#else
    (void)many;
#endif
    for (int run = 0; run <= options.runs; ++run) {
        for (const Rival& rival : rivals) {
            const double first = rival.worker->run(0), second = rival.worker->run(1);
            if (run == 0) continue;
            rival.first->push_back(first);
            rival.second->push_back(second);
        }
        std::reverse(rivals.begin(), rivals.end());
    }
}

#ifdef OBSCURA_HAS_EMBREE
/// Pairs of sample and point for which the two differ.
void compare(const Scene& scene, const Scene& many, const FrameSamples& samples, SoftRow& row) {
    const Exec exec{best_isa(), 0};
    const LitOfPoints ours = soft_shadows(scene, samples, row.points, exec);
    const TracedSamples rays = trace_samples(many, samples, exec);
    for (std::size_t p = 0; p < ours.size(); ++p) {
        for (std::size_t w = 0; w < ours[p].size(); ++w) {
            row.pairs += std::popcount(rays.asked[p][w]);
            row.apart += std::popcount((ours[p][w] ^ rays.lit[p][w]) & rays.asked[p][w]);
        }
    }
}
#endif

std::string apart_percent(const SoftRow& row) {
    if (row.pairs == 0) return "-";
    return fmt::format("{:.5f}", 100 * static_cast<double>(row.apart) / static_cast<double>(row.pairs));
}

std::string times_text(const SoftRow& row) {
    if (!row.problem.empty()) return row.problem;
    return fmt::format("{:.0f} ms, Embree {:.0f} ms, ratio {:.2f} ({:.2f} with its hierarchy kept)",
                       row.ours_ms(), row.rays_ms(), row.ratio(), row.kept_ratio());
}

double total_ms(const std::vector<double>& a, const std::vector<double>& b) {
    return a.empty() || b.empty() ? 0 : median(a) + median(b);
}

std::string csv_of(const std::vector<SoftRow>& rows) {
    std::string text =
        "scene,light,triangles,covered,points,threads,order_median_ms,order_min_ms,order_max_ms,"
        "lookup_median_ms,lookup_min_ms,lookup_max_ms,hierarchy_median_ms,hierarchy_min_ms,hierarchy_max_ms,"
        "packets_median_ms,packets_min_ms,packets_max_ms,ratio,kept_ratio,pairs,apart,problem\n";
    for (const SoftRow& row : rows) {
        text += fmt::format("{},{},{},{},{},{},", row.scene, row.light, row.triangles, row.covered,
                            row.points, row.threads);
        for (const auto* runs : {&row.order_ms, &row.lookup_ms, &row.hierarchy_ms, &row.packets_ms})
            text += range_fields(*runs);
        text += fmt::format("{:.3f},{:.3f},{},{},\"{}\"\n", row.ratio(), row.kept_ratio(), row.pairs,
                            row.apart, row.problem);
    }
    return text;
}

std::string markdown_of(const std::vector<SoftRow>& rows) {
    std::string text =
        "\n![chart](shadows_soft.svg)\n\nMedians, milliseconds, for a picture of 1920 x 1080 with one sample "
        "a pixel. Order: casters as the light's middle sees them, and what its points see of the vertices; "
        "of points that are no disc's, within the lookups. Ratio: Embree's time over ours, above 1 ours is "
        "faster; kept: without the time its hierarchy takes. Apart: pairs of a sample and a point of which "
        "one is lit and one is not, of those that both ask.\n\n| scene | triangles | light | points | "
        "threads | order | lookups | hierarchy | rays | ratio | kept | apart % |\n"
        "|---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const SoftRow& row : rows) {
        if (!row.problem.empty()) {
            text += fmt::format("| {} | {} |\n", row.scene, row.problem);
            continue;
        }
        const auto ms = [](const std::vector<double>& runs) {
            return runs.empty() ? std::string("-") : fmt::format("{:.0f}", median(runs));
        };
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | **{:.2f}** | {:.2f} | {} |\n",
                            row.scene, row.triangles, row.light, row.points, row.threads, ms(row.order_ms),
                            ms(row.lookup_ms), ms(row.hierarchy_ms), ms(row.packets_ms), row.ratio(),
                            row.kept_ratio(), apart_percent(row));
    }
    return text;
}

PanelChart chart_of(const std::vector<SoftRow>& rows) {
    PanelChart chart;
    chart.style_of = shadow_style;
    chart.title = "All points of a light for every sample of a frame";
    chart.note =
        "1920 x 1080, one sample a pixel, one thread. Embree: hierarchy and packets of 16 rays. Both axes "
        "logarithmic.";
    chart.x_label = "points of the light";
    chart.y_label = "ms";
    chart.x_tics = "set format x '%g'";
    chart.one_key = true;
    for (const SoftRow& row : rows) {
        if (row.threads != 1 || row.ours_ms() <= 0) continue;
        const std::string name = row.scene + ", " + row.light;
        if (chart.panels.empty() || chart.panels.back().title != name)
            chart.panels.push_back({name, "", {{exact_name, {}}, {embree_name, {}}}});
        auto& lines = chart.panels.back().lines;
        lines[0].points.push_back({static_cast<double>(row.points), row.ours_ms()});
        if (row.rays_ms() > 0) lines[1].points.push_back({static_cast<double>(row.points), row.rays_ms()});
    }
    return chart;
}

/// The scene under its own sun, and the samples of its picture.
struct Staged {
    Scene scene;
    FrameSamples samples;
};
Staged stage(const ShadowRecipe& recipe, const BenchOptions& options) {
    Scene scene = stage_shadows(recipe, options.quick ? PictureSize{128, 64} : PictureSize{1920, 1080});
    scene.render.samples = 1;
    scene.lights.resize(1);
    scene.lights[0].shadow.method = ShadowMethod::exact;
    FrameSamples samples = frame_samples(scene, Exec{best_isa(), 1});
    return {std::move(scene), std::move(samples)};
}

/// Calls visit(light's name, scene with it, how many points) for all that is measured.
template <class Visit>
void for_each_light(const Scene& staged, const BenchOptions& options, Visit&& visit) {
    Scene scene = staged;
    for (const SoftSubject& subject : soft_subjects()) {
        scene.lights = staged.lights;
        subject.shape(scene, scene.lights[0].light);
        for (const int points : options.quick ? std::vector<int>{4} : std::vector<int>{16, 64, 256})
            visit(subject.name, scene, points);
    }
}

/// Times; workers are forked, so that this process must not have started a thread.
void measure(const ShadowRecipe& recipe, const BenchOptions& options, std::vector<SoftRow>& rows) {
    const Staged staged = stage(recipe, options);
    for_each_light(staged.scene, options, [&](const char* light, const Scene& scene, int points) {
        const Scene many = with_points(scene, points);
        for (const int threads : options.threads) {
            SoftRow& row = rows.emplace_back();
            row.scene = recipe.name;
            row.light = light;
            row.triangles = scene.mesh.triangles.size();
            row.covered = staged.samples.covered;
            row.points = points;
            row.threads = threads;
            try {
                run_rivals(scene, many, staged.samples, options, row);
            } catch (const std::runtime_error& error) {
                row.problem = fmt::format("failed: {}", error.what());
            }
            options.say(fmt::format("{}, {}, {} points, {}: {}", row.scene, row.light, points,
                                    threads_text(threads), times_text(row)));
        }
    });
}

#ifdef OBSCURA_HAS_EMBREE
/// Fills in where the two differ.
void compare_all(const ShadowRecipe& recipe, const BenchOptions& options, std::vector<SoftRow>& rows) {
    const Staged staged = stage(recipe, options);
    for_each_light(staged.scene, options, [&](const char* light, const Scene& scene, int points) {
        SoftRow found;
        found.points = points;
        compare(scene, with_points(scene, points), staged.samples, found);
        for (SoftRow& row : rows) {
            if (row.scene != recipe.name || row.light != light || row.points != points) continue;
            row.pairs = found.pairs;
            row.apart = found.apart;
        }
        options.say(fmt::format("{}, {}, {} points: {} % of {} pairs apart", recipe.name, light, points,
                                apart_percent(found), found.pairs));
    });
}
#endif

}  // namespace

const std::vector<SoftSubject>& soft_subjects() {
    static const std::vector<SoftSubject> all = {
        {"a disc of 0.53 degrees", [](const Scene&, Light& l) { l.angular_diameter_deg = 0.53; }},
        {"a disc of 10 degrees", [](const Scene&, Light& l) { l.angular_diameter_deg = 10; }},
        {"a panel",
         [](const Scene& scene, Light& l) {
             // As far off as the scene is large, a tenth as wide.
             const Bounds box = bounds_of(scene.mesh);
             const double size = extent_of(scene.mesh);
             l.kind = LightKind::area;
             l.direction = normalize(l.direction);
             l.position = (box.low + box.high) * 0.5 - l.direction * size;
             const Vec3d up = std::fabs(l.direction.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
             l.across = normalize(cross(l.direction, up));
             l.width_m = l.height_m = 0.1 * size;
             l.near_m = 0.01 * size;
             l.range_m = 10 * size;
         }},
    };
    return all;
}

double SoftRow::ours_ms() const {
    return total_ms(order_ms, lookup_ms);
}
double SoftRow::rays_ms() const {
    return total_ms(hierarchy_ms, packets_ms);
}
double SoftRow::ratio() const {
    return ours_ms() > 0 ? rays_ms() / ours_ms() : 0;
}
double SoftRow::kept_ratio() const {
    return ours_ms() > 0 && !packets_ms.empty() ? median(packets_ms) / ours_ms() : 0;
}

int bench_soft(const BenchOptions& options) {
    std::vector<SoftRow> rows;
    std::vector<ShadowRecipe> wanted;
    for (ShadowRecipe& recipe : shadow_recipes(options.data, options.quick)) {
        const bool usual = options.quick || recipe.name == "vienna_west" || recipe.name == "armadillo" ||
                           recipe.name == "city";
        if (options.scene.empty() ? usual : recipe.name.find(options.scene) != std::string::npos)
            wanted.push_back(std::move(recipe));
    }
    check_chosen(!wanted.empty(), options);
    for (const ShadowRecipe& recipe : wanted)
        measure(recipe, options, rows);
#ifdef OBSCURA_HAS_EMBREE
    for (const ShadowRecipe& recipe : wanted)
        compare_all(recipe, options, rows);
#endif
    std::string page =
        report_head("Shadows of lights with a size", "small pictures of a small scene", options);
    page += machine_markdown({}) + markdown_of(rows);
    write_files(options, {{"shadows_soft.csv", csv_of(rows)}, {"shadows_soft.md", page}});
    const PanelChart chart = chart_of(rows);
    if (can_draw(options) && !chart.panels.empty())
        run_gnuplot(panel_script(chart), options.out / "shadows_soft.svg");
    const bool failed =
        std::any_of(rows.begin(), rows.end(), [](const SoftRow& row) { return !row.problem.empty(); });
    return static_cast<int>(failed ? ExitCode::internal : ExitCode::ok);
}

}  // namespace obscura
