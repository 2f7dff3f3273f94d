// Dense dual-depth maps of peers, as a measure for building trees.

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "bench/harness/worker.h"
#include "bench/shadows/shadow_bench.h"

namespace obscura {
namespace {

void run_dual_depths(const Contestant& contestant, const BenchScene& scene, const TimeRow& like,
                     std::vector<TimeRow>& rows) {
    TimeRow row = like;
    row.method = contestant.name;
    row.job = "dual depth";
    if (!contestant.absent.empty()) {
        row.problem = "absent: " + contestant.absent;
        rows.push_back(row);
        return;
    }
    try {
        const SharedFloats canvas(1);
        const Exec exec{best_isa(), row.threads};
        Worker worker(
            contestant.name, [&] { return contestant.open(scene, exec); }, row.threads, canvas);
        row.version = worker.version();
        for (std::size_t job = 0; job < worker.jobs().size(); ++job) {
            const WorkerJob& offered = worker.jobs()[job];
            if (offered.workload != Workload::dual_depth || !offered.same_work) continue;
            row.job = fmt::format("dual depth: {}", offered.method);
            row.runs_ms = {worker.run(job)};
            rows.push_back(row);
        }
    } catch (const std::runtime_error& error) {
        row.runs_ms.clear();
        row.problem = fmt::format("failed: {}", error.what());
        rows.push_back(row);
    }
}

}  // namespace

std::vector<TimeRow> measure_dual_depths(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                         const std::vector<Contestant>& peers, const BenchOptions& options) {
    const BenchScene scene = stage_scene(recipe.name, recipe.make(),
                                         BenchSize{plan.peer_map, plan.picture.width, plan.picture.height});
    std::vector<TimeRow> rows;
    for (const int threads : options.threads) {
        TimeRow like;
        like.scene = recipe.name;
        like.triangles = scene.scene.mesh.triangles.size();
        like.size = plan.peer_map;
        like.threads = threads;
        like.bytes = 8LL * plan.peer_map * plan.peer_map;
        for (const Contestant& contestant : peers)
            run_dual_depths(contestant, scene, like, rows);
    }
    for (const TimeRow& row : rows) {
        options.say(row.problem.empty()
                        ? fmt::format("{}, {} {}, {}, {} threads: {:.0f} ms", row.scene, row.method, row.size,
                                      row.job, row.threads, row.runs_ms[0])
                        : fmt::format("{}, {}: {}", row.scene, row.method, row.problem));
    }
    return rows;
}

}  // namespace obscura
