#include "app/pair/pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/frame/memory.h"
#include "app/pair/middle.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "stereo/map_projection.h"
#include "stereo/reduced_system.h"
#include "stereo/thesis/methods.h"
#include "stereo/upsample.h"
#include "stereo/warm_start.h"

namespace obscura {
namespace {

MiddleView view_of(const Scene& scene, const StereoSettings& settings, const Exec& exec, FrameCache& cache) {
    if (settings.margin_px != auto_margin)
        return middle_view(scene, settings.rig, settings.margin_px, exec, cache);
    MiddleView narrow = middle_view(scene, settings.rig, 0, exec, cache);
    const int margin = automatic_margin(narrow, settings.edits);
    return margin == 0 ? std::move(narrow) : middle_view(scene, settings.rig, margin, exec, cache);
}

std::vector<std::string> object_names(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const Object& object : mesh.objects)
        names.push_back(object.name);
    return names;
}

/// Where the solve starts: last frame's change on this frame's surfaces, or nothing.
DisparityMap start_of(const StereoSettings& settings, const StereoCache& cache, const MiddleView& view,
                      const Camera& camera, const Exec& exec) {
    if (!settings.warm_start || !cache.last) return {};
    const SeenFrame before{cache.last->view, cache.last->camera}, now{view, camera};
    return carried_map(before, cache.last->solution, now, WarmStartParams{}, exec);
}

/// Instead of edits: one curve for the whole picture.
void remap_map(const StereoSettings& settings, const Exec& exec, StereoPair& pair) {
    const DisparitySystem& system = pair.edited.system;
    const RemapCurve curve = remap_curve(system.original, system.valid, settings.remap);
    pair.optimised = pair.solution.disparity = remapped(system.original, system.valid, curve, exec);
    pair.solution.report.converged = true;
}

/// The system at the resolution that is asked for, solved, and the map at full resolution.
void solve_map(const Scene& scene, const StereoSettings& settings, const Exec& exec, StereoCache& cache,
               StereoPair& pair) {
    const Stopwatch editing;
    const bool remaps = settings.remap.kind != RemapKind::none, lower = settings.map_scale > 1 && !remaps;
    const std::vector<StereoEdit> no_edits;
    pair.edited = edited_system(pair.view, remaps ? no_edits : settings.edits, settings.edit,
                                object_names(scene.mesh), exec);
    if (lower) {
        pair.reduced_view = reduced(pair.view, settings.map_scale);
        pair.reduced_system = reduced_system(pair.edited.system, pair.view, settings.map_scale, exec);
    }
    const MiddleView& view = lower ? pair.reduced_view : pair.view;
    pair.times.edit_s = editing.seconds();

    const Stopwatch solving;
    if (remaps) {
        remap_map(settings, exec, pair);
        pair.times.solve_s = solving.seconds();
        return;
    }
    const DisparityMap start = start_of(settings, cache, view, scene.camera, exec);
    pair.warm = !start.pixels.empty();
    pair.solution = solve_by_method(lower ? pair.reduced_system : pair.edited.system, settings.solver, exec,
                                    start, &cache.solver);
    const std::vector<float>& solved = pair.solution.disparity.pixels;
    CHECK(std::all_of(solved.begin(), solved.end(), [](float d) { return std::isfinite(d); }),
          "the solver diverged");
    pair.times.solve_s = solving.seconds();

    const Stopwatch upsampling;
    pair.optimised =
        lower ? upsampled_solution(pair.view, view, pair.solution.disparity, UpsampleParams{}, exec)
              : pair.solution.disparity;
    pair.times.upsample_s = upsampling.seconds();
}

void check_bytes(const Scene& scene, const StereoSettings& settings, std::int64_t triangles,
                 StereoPair& pair) {
    MemoryEstimate memory = estimate_memory(scene);
    const int margin = pair.view.picture_width > 0 ? pair.view.margin_px : auto_margin;
    memory.frame += stereo_bytes(scene, settings, triangles, margin);
    pair.bytes = memory.total();
    check_memory(memory, scene.limits, "the stereo pair");
}

/// Moving stops at the first triangle that no longer fits, which check_bytes() then refuses.
std::int64_t most_triangles(const Scene& scene, const StereoSettings& settings, int margin_px) {
    const std::int64_t free = (scene.limits.memory_mib << 20) - estimate_memory(scene).total();
    std::int64_t fits = 0, too_many = settings.reproject.max_triangles;
    while (too_many - fits > 1) {
        const std::int64_t middle = fits + (too_many - fits) / 2;
        (stereo_bytes(scene, settings, middle, margin_px) <= free ? fits : too_many) = middle;
    }
    return too_many;
}

/// Change of disparity at a place of a map, between four pixels of one object; nothing elsewhere.
std::optional<double> change_between(const MiddleView& view, const DisparityMap& optimised,
                                     std::uint32_t object, double depth_m, double column, double row) {
    const double x = column - 0.5, y = row - 0.5;
    if (!(x >= 0 && y >= 0 && x < view.width() - 1 && y < view.height() - 1)) return std::nullopt;
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
        const int i = x0 + (k & 1), j = y0 + (k >> 1);
        const auto z = static_cast<double>(view.depth_m(i, j));
        if (view.object(i, j) != object || std::fabs(z - depth_m) > 0.02 * depth_m) return std::nullopt;
        const double weight = ((k & 1) != 0 ? x - x0 : 1 - (x - x0)) * (k >> 1 != 0 ? y - y0 : 1 - (y - y0));
        sum += weight * static_cast<double>(optimised(i, j) - view.disparity(i, j));
    }
    return sum;
}

TemporalChange temporal_change(const StereoCache::Last& last, const StereoPair& pair, const Camera& camera,
                               double steady_px) {
    const MapProjection before = map_projection(last.camera, last.full_view),
                        now = map_projection(camera, pair.view);
    ErrorSum sum(steady_px);
    for (int y = 0; y < pair.view.height(); ++y) {
        for (int x = 0; x < pair.view.width(); ++x) {
            if (pair.view.object(x, y) == nothing_seen) continue;
            const Vec3d point =
                now.eye + now.ray(x + 0.5, y + 0.5) * static_cast<double>(pair.view.depth_m(x, y));
            const MapPoint place = before.project(to_float(point));
            if (!before.on_map(place)) continue;
            const auto earlier = change_between(last.full_view, last.optimised, pair.view.object(x, y),
                                                place.z, place.column(), place.row());
            if (earlier) {
                sum.add(static_cast<double>(pair.optimised(x, y) - pair.view.disparity(x, y)) - *earlier);
            }
        }
    }
    return {sum.error()};
}

void keep_for_next(const Scene& scene, const StereoPair& pair, StereoCache& cache) {
    const bool lower = !pair.reduced_view.disparity.pixels.empty();
    cache.last = StereoCache::Last{lower ? pair.reduced_view : pair.view, pair.solution.disparity, pair.view,
                                   pair.optimised, scene.camera};
}

void measure(const Scene& scene, const StereoSettings& settings, const Exec& exec, StereoCache& cache,
             StereoPair& pair) {
    const Stopwatch watch;
    const double tolerance = settings.reproject.tolerance_px;
    pair.realised = realised_disparity(scene, pair.moved, cache.eyes.left, cache.eyes.right, pair.view,
                                       pair.optimised, tolerance, exec, cache.eyes.middle);
    pair.left_error = picture_error(pair.eyes.left_map, Eye::left, pair.view, pair.optimised, tolerance);
    pair.right_error = picture_error(pair.eyes.right_map, Eye::right, pair.view, pair.optimised, tolerance);
    pair.times.measure_s = watch.seconds();
}

/// From the map to the pictures.
void render_pair(const Scene& scene, const StereoSettings& settings, const StereoPairOptions& options,
                 const Exec& exec, StereoCache& cache, StereoPair& pair) {
    const Stopwatch moving;
    ReprojectParams reproject = settings.reproject;
    reproject.max_triangles = most_triangles(scene, settings, pair.view.margin_px);
    pair.moved =
        moved_mesh(scene.mesh, scene.camera, pair.view, pair.optimised, reproject, exec, pair.reprojection);
    pair.times.mesh_s = moving.seconds();
    check_bytes(scene, settings, static_cast<std::int64_t>(pair.moved.mesh.triangles.size()), pair);

    const Stopwatch rendering;
    const auto seen = [&](Eye eye) {
        return eye_positions(pair.moved, scene.camera, scene.render.height, settings.rig, eye);
    };
    EyesWanted wanted;
    wanted.shading = settings.shading;
    wanted.channels = options.channels;
    if (settings.middle_picture) wanted.middle_margin_px = pair.view.margin_px;
    const std::int64_t other_bytes = pair.bytes - estimate_memory(scene).shadow_maps;
    pair.complete = render_eyes(scene, pair.moved, {seen(Eye::left), seen(Eye::right)}, settings.rig, wanted,
                                other_bytes, exec, cache.eyes, pair.eyes);
    pair.times.render_s = rendering.seconds();
}

}  // namespace

void render_stereo_pair(const Scene& scene, const StereoSettings& settings, const StereoPairOptions& options,
                        const Exec& exec, StereoCache& cache, StereoPair& pair) {
    CHECK(settings.map_scale == 1 || settings.map_scale == 2 || settings.map_scale == 4 ||
          settings.map_scale == 8);
    const Stopwatch total;
    pair = StereoPair{};
    check_bytes(scene, settings, 0, pair);
    const Stopwatch viewing;
    pair.view = view_of(scene, settings, exec, cache.eyes.frame);
    pair.times.view_s = viewing.seconds();
    check_bytes(scene, settings, 0, pair);  // with the margin that was found
    if (stopped(options.channels.cancel)) return;

    solve_map(scene, settings, exec, cache, pair);
    if (cache.last) pair.temporal = temporal_change(*cache.last, pair, scene.camera, options.steady_px);
    keep_for_next(scene, pair, cache);
    if (stopped(options.channels.cancel)) return;

    if (options.pictures) {
        render_pair(scene, settings, options, exec, cache, pair);
        if (pair.complete && options.measure) measure(scene, settings, exec, cache, pair);
    } else {
        pair.complete = true;
    }
    pair.times.total_s = total.seconds();
}

Conflicts remaining_conflicts(const Scene& scene, const StereoSettings& settings, const StereoPair& pair,
                              const Exec& exec) {
    const EditParams& edit = settings.edit;
    return find_conflicts(pair.view, pair.optimised, {edit.comfort, edit.meaningful_px},
                          object_names(scene.mesh), exec);
}

}  // namespace obscura
