// The measuring loop: one worker per contestant and thread count, all alive, one on the clock at a time.

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/harness/worker.h"
#include "bench/raster/agreement.h"
#include "bench/raster/raster_bench.h"

namespace obscura {
namespace {

/// One job of one worker and the row its times go to.
struct Slot {
    std::size_t worker = 0, job = 0, row = 0;
};

/// Everybody who takes part in one scene.
struct Field {
    std::vector<std::unique_ptr<Worker>> workers;
    std::vector<Slot> slots;
    std::vector<BenchRow> rows;
    std::vector<float> reference;  ///< depth map of the first contestant that delivers one
};

BenchRow start_row(const BenchScene& scene, Workload workload, const Contestant& contestant, int threads) {
    BenchRow row;
    row.scene = scene.name;
    row.triangles = scene.scene.mesh.triangles.size();
    row.workload = workload;
    const bool frame = is_frame(workload);
    row.width = frame ? scene.scene.render.width : scene.light.width;
    row.height = frame ? scene.scene.render.height : scene.light.height;
    row.contestant = contestant.name;
    row.threads = threads;
    return row;
}

void add_problem(Field& field, const BenchScene& scene, const Contestant& contestant, int threads,
                 const std::string& problem) {
    for (const Workload workload : all_workloads) {
        field.rows.push_back(start_row(scene, workload, contestant, threads));
        field.rows.back().problem = problem;
    }
}

void enter(Field& field, const Contestant& contestant, const BenchScene& scene, int threads,
           const SharedFloats& canvas) {
    if (!contestant.absent.empty())
        return add_problem(field, scene, contestant, threads, "absent: " + contestant.absent);
    try {
        field.workers.push_back(std::make_unique<Worker>(
            contestant.name,
            [&] {
                return contestant.open(scene, Exec{best_isa(), threads});
            },
            threads, canvas));
    } catch (const std::runtime_error& error) {
        return add_problem(field, scene, contestant, threads, fmt::format("cannot open: {}", error.what()));
    }
    const Worker& worker = *field.workers.back();
    for (std::size_t job = 0; job < worker.jobs().size(); ++job) {
        BenchRow row = start_row(scene, worker.jobs()[job].workload, contestant, threads);
        row.method = worker.jobs()[job].method;
        row.same_work = worker.jobs()[job].same_work;
        row.version = worker.version();
        row.prepare_ms = worker.prepare_ms();
        row.prepare_mib = worker.prepare_mib();
        field.slots.push_back({field.workers.size() - 1, job, field.rows.size()});
        field.rows.push_back(row);
    }
}

/// Runs a job; a worker that fails takes its remaining jobs out of the bench, saying why. Returns false then.
bool run_once(Field& field, const Slot& slot, bool keep_time) {
    BenchRow& row = field.rows[slot.row];
    if (!row.problem.empty()) return false;
    try {
        const double ms = field.workers[slot.worker]->run(slot.job);
        if (keep_time) row.runs_ms.push_back(ms);
    } catch (const std::runtime_error& error) {
        for (const Slot& other : field.slots) {
            if (other.worker != slot.worker) continue;
            field.rows[other.row].problem = fmt::format("failed: {}", error.what());
            field.rows[other.row].runs_ms.clear();
        }
        return false;
    }
    return true;
}

void check_agreement(Field& field, const Slot& slot, const BenchScene& scene, const SharedFloats& canvas) {
    BenchRow& row = field.rows[slot.row];
    Worker& worker = *field.workers[slot.worker];
    if (!worker.jobs()[slot.job].delivers) return;
    worker.deliver(slot.job);
    Agreement agreement = summarise(row.workload, scene, canvas.data());
    if (!is_frame(row.workload)) {
        const std::size_t texels = result_size(Workload::depth, scene);
        if (field.reference.empty()) field.reference.assign(canvas.data(), canvas.data() + texels);
        compare_depths(agreement, scene, canvas.data(), field.reference.data());
    }
    row.agreement = agreement;
}

}  // namespace

std::vector<BenchRow> measure_scene(const std::vector<Contestant>& contestants, const BenchScene& scene,
                                    const BenchOptions& options) {
    std::size_t largest = 0;
    for (const Workload w : all_workloads) {
        largest = std::max(largest, result_size(w, scene));
    }
    const SharedFloats canvas(largest);
    Field field;
    for (const int threads : options.threads) {
        for (const Contestant& contestant : contestants)
            enter(field, contestant, scene, threads, canvas);
    }

    options.say(fmt::format("{}: warm-up and comparison of results", scene.name));
    for (const Slot& slot : field.slots) {
        if (run_once(field, slot, false)) check_agreement(field, slot, scene, canvas);
    }
    for (int run = 0; run < options.runs; ++run) {
        options.say(fmt::format("{}: run {} of {}", scene.name, run + 1, options.runs));
        for (const Slot& slot : field.slots)
            run_once(field, slot, true);
        std::reverse(field.slots.begin(), field.slots.end());
    }
    return field.rows;
}

}  // namespace obscura
