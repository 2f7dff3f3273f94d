// Times of exact shadows beside Embree's: each method in a process of its own, one on the clock at a time.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "app/frame/load_scene.h"
#include "app/frame/shadows.h"
#include "app/scene/scene_file.h"
#include "bench/harness/report.h"
#include "bench/harness/run_times.h"
#include "bench/harness/worker.h"
#include "bench/shadows/exact_bench.h"
#include "core/error.h"
#include "core/topology.h"
#include "scenes/city.h"

namespace obscura {
namespace {

constexpr PictureSize full{1920, 1080}, tiny{128, 64};

Scene staged(const ShadowRecipe& recipe) {
    Scene scene = stage_shadows(recipe, full);
    scene.lights[0].shadow.method = ShadowMethod::exact;
    return scene;
}

ShadowRecipe town_of(std::int64_t triangles) {
    return {fmt::format("town of {}k", triangles / 1000),
            "",
            {0.55, -0.62, -0.38},
            {-0.22, 0.20, 0.48},
            {0.0, 0.02, 0.0},
            [triangles] {
                return city({triangles, 0, 1}).mesh;
            }};
}

/// One method's worker and where its two jobs' times go.
struct Rival {
    std::unique_ptr<Worker> worker;
    std::vector<double>* first = nullptr;
    std::vector<double>* second = nullptr;
    ExactFindings* findings = nullptr;
};

void run_once(const Rival& rival, bool keep) {
    const double first = rival.worker->run(0), second = rival.worker->run(1);
    if (!keep) return;
    rival.first->push_back(first);
    rival.second->push_back(second);
}

void run_rivals(const Scene& scene, const FrameSamples& samples, const BenchOptions& options, ExactRow& row) {
    const SharedFloats canvas(findings_floats);
    const Exec exec{best_isa(), row.threads};
    std::vector<Rival> rivals;
    rivals.push_back({std::make_unique<Worker>(
                          exact_name, [&] { return open_exact(scene, samples, exec); }, row.threads, canvas),
                      &row.order_ms, &row.lookup_ms, &row.ours});
#ifdef OBSCURA_HAS_EMBREE
    rivals.push_back(
        {std::make_unique<Worker>(
             embree_name, [&] { return open_exact_rays(scene, samples, exec); }, row.threads, canvas),
         &row.hierarchy_ms, &row.packets_ms, &row.rays});
#endif
    for (int run = 0; run <= options.runs; ++run) {
        for (const Rival& rival : rivals)
            run_once(rival, run > 0);
        std::reverse(rivals.begin(), rivals.end());
    }
    for (const Rival& rival : rivals) {
        rival.worker->deliver(1);
        *rival.findings = read_findings(canvas.data());
    }
}

void say(const ExactRow& row, const BenchOptions& options) {
    options.say(fmt::format(
        "{}, {} x {}, {} samples, {}: {}", row.scene, row.picture.width, row.picture.height, row.samples,
        threads_text(row.threads),
        row.problem.empty()
            ? fmt::format(
                  "exact {:.1f} ms, Embree {:.1f} ms, ratio {:.2f}; {} asked, {:.3f} and {:.3f} % lit",
                  row.ours_ms(), row.rays_ms(), row.ratio(), row.ours.asked,
                  100.0 * static_cast<double>(row.ours.lit) / static_cast<double>(row.ours.asked),
                  100.0 * static_cast<double>(row.rays.lit) / static_cast<double>(row.rays.asked))
            : row.problem));
}

double sum_of_medians(const std::vector<double>& a, const std::vector<double>& b) {
    return a.empty() || b.empty() ? 0 : median(a) + median(b);
}

}  // namespace

const char* series_name(ExactSeries series) {
    constexpr const char* names[] = {"scenes", "samples", "triangles"};
    return names[static_cast<std::size_t>(series)];
}

double ExactRow::ours_ms() const {
    return sum_of_medians(order_ms, lookup_ms);
}
double ExactRow::rays_ms() const {
    return sum_of_medians(hierarchy_ms, packets_ms);
}
double ExactRow::ratio() const {
    return ours_ms() > 0 ? rays_ms() / ours_ms() : 0;
}

std::vector<ExactSubject> exact_subjects(const BenchOptions& options) {
    const std::vector<int> both = {1, 4};
    const PictureSize size = options.quick ? tiny : full;
    std::vector<ExactSubject> subjects;
    const auto add = [&](ExactSubject subject) {
        if (subject.name.find(options.scene) != std::string::npos) subjects.push_back(std::move(subject));
    };
    for (const char* name : {"courtyard", "city", "night_street", "sun_star"}) {
        const auto file = std::filesystem::path("scenes") / fmt::format("{}.toml", name);
        if (options.quick || !std::filesystem::exists(file)) continue;
        add({fmt::format("{} (scene)", name), ExactSeries::scenes, {size}, both, [file] {
                 return load_scene(read_scene(file), FileAccess{file.parent_path(), {}});
             }});
    }
    for (const ShadowRecipe& recipe : shadow_recipes(options.data, options.quick))
        add({recipe.name, ExactSeries::scenes, {size}, both, [recipe] { return staged(recipe); }});
    std::vector<PictureSize> pictures = {{480, 270}, {960, 540}, {1920, 1080}};
    std::vector<std::int64_t> towns = {10'000, 30'000, 100'000, 300'000, 1'000'000};
    if (options.quick) {
        pictures = {{64, 64}, {128, 64}};
        towns = {1000, 4000};
    }
    const ShadowRecipe middle = town_of(towns[towns.size() / 2]);
    add({middle.name, ExactSeries::samples, pictures, both, [middle] { return staged(middle); }});
    for (const std::int64_t triangles : towns) {
        const ShadowRecipe town = town_of(triangles);
        add({town.name, ExactSeries::triangles, {size}, {1}, [town] { return staged(town); }});
    }
    return subjects;
}

std::vector<ExactRow> measure_exact(const ExactSubject& subject, const BenchOptions& options) {
    std::vector<ExactRow> rows;
    Scene scene = subject.make();
    ExactRow row;
    row.scene = subject.name;
    row.series = subject.series;
    row.triangles = scene.mesh.triangles.size();
    row.lights =
        static_cast<std::size_t>(std::count_if(scene.lights.begin(), scene.lights.end(), casts_shadows));
    for (const PictureSize& picture : subject.pictures) {
        for (const int samples : subject.samples) {
            scene.render.width = picture.width;
            scene.render.height = picture.height;
            scene.render.samples = samples;
            const FrameSamples found = frame_samples(scene, Exec{best_isa(), 1});
            row.picture = picture;
            row.samples = samples;
            row.covered = found.covered;
            for (const int threads : options.threads) {
                row.threads = threads;
                ExactRow& measured = rows.emplace_back(row);
                try {
                    run_rivals(scene, found, options, measured);
                } catch (const std::runtime_error& error) {
                    measured.problem = fmt::format("failed: {}", error.what());
                }
                say(measured, options);
            }
        }
    }
    return rows;
}

}  // namespace obscura
