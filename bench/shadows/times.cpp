// Times of lookups and builds: every method and size in a process of its own, one on the clock at a time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "bench/harness/run_times.h"
#include "bench/harness/worker.h"
#include "bench/shadows/map_points.h"
#include "bench/shadows/methods.h"
#include "bench/shadows/shadow_bench.h"
#include "core/error.h"
#include "core/parallel.h"
#ifdef OBSCURA_HAS_EMBREE
#include "bench/shadows/shadow_rays.h"
#endif

namespace obscura {
namespace {

/// A scene and its pixels, made before any worker is forked and shared by all.
struct Field {
    const ShadowRecipe& recipe;
    const BenchOptions& options;
    Scene scene;
    VisiblePoints points;
    std::size_t lookups = 0;  ///< pixels that face the light
};

/// Someone who makes a session, and what its rows say.
struct Entrant {
    std::string method;
    int size = 0;
    std::function<Session(const Exec& exec)> open;
};

std::size_t facing_pixels(const Scene& scene, const VisiblePoints& points) {
    const Vec3f light = to_float(-normalize(scene.lights[0].light.direction));
    std::size_t facing = 0;
    for (const SurfaceBlock& s : points.blocks) {
        for (int at = 0; at < block_samples; ++at) {
            const bool faces = dot(Vec3f{s.gx[at], s.gy[at], s.gz[at]}, light) > 0;
            facing += is_covered(s, at) && faces ? 1 : 0;
        }
    }
    return facing;
}

/// A map and its jobs: to build it again, and to look all pixels up.
struct MapSession {
    BuiltShadow built;
    std::vector<float> visibility;
    MapPointList points;
    std::vector<std::uint16_t> lit;
};

using BuildMap = BuiltShadow (*)(const Scene& scene, int size, const Exec& exec);

/// Points in pieces that threads share out: a multiple of 16.
constexpr std::size_t piece = 4096;

void add_point_jobs(const Field& field, MapSession& state, const Exec& exec, Session& session) {
    state.points = map_points(field.points, state.built.light);
    const std::size_t count = state.points.x.size();
    state.lit.resize((count + 15) / 16);
    for (const PointLookup& lookup : state.built.point_lookups(exec.isa)) {
        const auto run = [&state, exec, count, look = lookup.look] {
            parallel_for((count + piece - 1) / piece, exec, [&](std::size_t i) {
                const std::size_t first = i * piece;
                look(state.points.points(first, std::min(piece, count - first)), &state.lit[first / 16]);
            });
        };
        session.jobs.push_back({Workload::lookup, lookup.name, true, run, {}});
    }
}

Session open_map(const Field& field, int size, BuildMap build, const Exec& exec) {
    const auto state = std::make_shared<MapSession>();
    state->built = build(field.scene, size, exec);
    state->visibility.resize(field.points.blocks.size() * block_samples);
    Session session;
    session.version = fmt::format("this build ({})", isa_name(exec.isa));
    session.prepare_ms = 1e3 * state->built.build_s;
    session.prepare_mib = static_cast<double>(state->built.bytes) / (1 << 20);
    session.jobs.push_back({Workload::shadow_map,
                            "build",
                            true,
                            [&field, size, build, exec] { build(field.scene, size, exec); },
                            {}});
    for (const ShadowLookup& lookup : state->built.lookups(exec.isa)) {
        session.jobs.push_back({Workload::lookup,
                                lookup.name,
                                true,
                                [&field, exec, s = state.get(), look = lookup.block] {
                                    parallel_for(field.points.blocks.size(), exec, [&](std::size_t b) {
                                        look(field.points.blocks[b], &s->visibility[b * block_samples]);
                                    });
                                },
                                {}});
    }
    add_point_jobs(field, *state, exec, session);
    session.state = state;
    return session;
}

std::vector<Entrant> entrants_of(const Field& field, const ShadowBenchPlan& plan,
                                 std::vector<std::uint8_t>& shown) {
    std::vector<Entrant> entrants;
    const bool deep = is_timed(plan, field.recipe.name);
    for (const int size : plan.timed_dense_sizes) {
        if (!deep && size > plan.shallow_timed_size) continue;
        entrants.push_back({dense_name, size, [&field, size](const Exec& exec) {
                                return open_map(field, size, build_dense, exec);
                            }});
    }
    for (const int size : plan.timed_compressed_sizes) {
        if (!deep && size > plan.shallow_timed_size) continue;
        entrants.push_back({compressed_name, size, [&field, size](const Exec& exec) {
                                return open_map(field, size, build_compressed, exec);
                            }});
    }
#ifdef OBSCURA_HAS_EMBREE
    entrants.push_back({embree_name, 0, [&field, &shown](const Exec& exec) {
                            const Vec3d to_light = -normalize(field.scene.lights[0].light.direction);
                            return open_shadow_rays(field.scene.mesh, field.points, to_light, shown, exec);
                        }});
#else
    static_cast<void>(shown);
#endif
    return entrants;
}

/// One job of one worker, the row it fills, and what it has taken so far.
struct Slot {
    std::size_t worker = 0, job = 0, row = 0;
    double spent_ms = 0;
};

/// Jobs that take long are not repeated once they have taken this much.
constexpr double enough_ms = 6000;

void run_slot(std::vector<std::unique_ptr<Worker>>& workers, Slot& slot, bool keep,
              std::vector<TimeRow>& rows) {
    TimeRow& row = rows[slot.row];
    if (!row.problem.empty() || slot.spent_ms > enough_ms) return;
    try {
        const double ms = workers[slot.worker]->run(slot.job);
        slot.spent_ms += ms;
        if (keep || ms > enough_ms) row.runs_ms.push_back(ms);
    } catch (const std::runtime_error& error) {
        row.problem = fmt::format("failed: {}", error.what());
    }
}

TimeRow start_row(const Field& field, const Entrant& entrant, int threads) {
    TimeRow row;
    row.scene = field.recipe.name;
    row.triangles = field.scene.mesh.triangles.size();
    row.method = entrant.method;
    row.size = entrant.size;
    row.threads = threads;
    return row;
}

void enter(const Field& field, const Entrant& entrant, int threads, const SharedFloats& canvas,
           std::vector<std::unique_ptr<Worker>>& workers, std::vector<Slot>& slots,
           std::vector<TimeRow>& rows) {
    TimeRow row = start_row(field, entrant, threads);
    const Exec exec{best_isa(), threads};
    try {
        workers.push_back(std::make_unique<Worker>(
            entrant.method, [&] { return entrant.open(exec); }, threads, canvas));
    } catch (const std::runtime_error& error) {
        row.problem = fmt::format("failed: {}", error.what());
        rows.push_back(row);
        return;
    }
    const Worker& worker = *workers.back();
    row.version = worker.version();
    row.bytes = std::llround(worker.prepare_mib() * (1 << 20));
    if (entrant.size == 0) {
        row.job = "build";  // of the rays' hierarchy: once, when the session opened
        row.runs_ms = {worker.prepare_ms()};
        rows.push_back(row);
    }
    for (std::size_t job = 0; job < worker.jobs().size(); ++job) {
        row.job = worker.jobs()[job].method;
        row.lookups = worker.jobs()[job].workload == Workload::lookup ? field.lookups : 0;
        row.runs_ms.clear();
        // What took long when the session opened is not done again.
        if (worker.jobs()[job].workload == Workload::shadow_map && worker.prepare_ms() > enough_ms) {
            row.runs_ms = {worker.prepare_ms()};
        } else {
            slots.push_back({workers.size() - 1, job, rows.size()});
        }
        rows.push_back(row);
    }
}

}  // namespace

double TimeRow::rate() const {
    if (runs_ms.empty() || lookups == 0) return 0;
    return static_cast<double>(lookups) / (1e3 * median(runs_ms) * threads);
}

std::vector<TimeRow> measure_shadow_times(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                          const BenchOptions& options) {
    Field field{recipe, options, stage_shadows(recipe, plan.picture), {}, 0};
    field.points = visible_points(field.scene, Exec{best_isa(), 1});
    field.lookups = facing_pixels(field.scene, field.points);
    std::vector<std::uint8_t> shown(static_cast<std::size_t>(field.points.width) *
                                    static_cast<std::size_t>(field.points.height));
    const std::vector<Entrant> entrants = entrants_of(field, plan, shown);
    const SharedFloats canvas(1);
    std::vector<TimeRow> rows;
    for (const int threads : options.threads) {
        options.say(fmt::format("{}: times, {} threads", recipe.name, threads));
        std::vector<std::unique_ptr<Worker>> workers;
        std::vector<Slot> slots;
        for (const Entrant& entrant : entrants)
            enter(field, entrant, threads, canvas, workers, slots, rows);
        for (Slot& slot : slots)
            run_slot(workers, slot, false, rows);
        for (int run = 0; run < options.runs; ++run) {
            for (Slot& slot : slots)
                run_slot(workers, slot, true, rows);
            std::reverse(slots.begin(), slots.end());
        }
    }
    for (const TimeRow& row : rows) {
        if (row.runs_ms.empty()) continue;
        options.say(fmt::format("{}, {} {}, {}, {} threads: {:.2f} ms, {:.1f} M/s per thread", row.scene,
                                row.method, row.size, row.job, row.threads, median(row.runs_ms), row.rate()));
    }
    return rows;
}

}  // namespace obscura
