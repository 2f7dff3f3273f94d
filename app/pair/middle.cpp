#include "app/pair/middle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// Columns beyond the last one that either eye sees: the reach of gathers, and what edits add unforeseen.
constexpr int spare_columns = 8;

MiddleView empty_view(const Scene& scene, const DisparityLaw& law, int margin_px) {
    MiddleView v;
    v.picture_width = scene.render.width;
    v.picture_height = scene.render.height;
    v.margin_px = margin_px;
    const int width = v.picture_width + 2 * margin_px, height = v.picture_height;
    v.depth_m = Image<float>(width, height, std::numeric_limits<float>::infinity());
    v.normal = Image<Vec3f>(width, height);
    v.object = v.material = v.triangle = Image<std::uint32_t>(width, height, nothing_seen);
    v.disparity = DisparityMap(width, height, static_cast<float>(-law.offset));
    return v;
}

struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -low;
};

Range disparity_range(const MiddleView& view) {
    Range r;
    for (const float d : view.disparity.pixels) {
        r.low = std::min(r.low, d);
        r.high = std::max(r.high, d);
    }
    return r;
}

/// How far an edit may move what it is about, pixels.
double reach_of(const StereoEdit& edit, const Range& range) {
    if (edit.weight <= 0) return 0;
    if (const auto* anchor = std::get_if<AnchorEdit>(&edit.what)) return std::fabs(anchor->offset_px);
    if (const auto* match = std::get_if<MatchEdit>(&edit.what)) return std::fabs(match->offset_px);
    if (const auto* round = std::get_if<RoundnessEdit>(&edit.what)) {
        // About the middle of all there is; an object's own extent is smaller.
        return std::max(round->roundness - 1, 0.0) * 0.5 * static_cast<double>(range.high - range.low);
    }
    return 0;
}

}  // namespace

MiddleView middle_view(const Scene& scene, const StereoRig& rig, int margin_px, const Exec& exec,
                       FrameCache& cache) {
    if (scene.camera.kind != CameraKind::perspective) {
        throw UsageError(
            "a stereo pair needs a perspective camera: the rays of an orthographic one are parallel, and "
            "both eyes would see the same");
    }
    CHECK(margin_px >= 0);
    const DisparityLaw law = disparity_law(rig, scene.camera, scene.render.height);
    MiddleView view = empty_view(scene, law, margin_px);
    if (scene.mesh.triangles.empty()) return view;

    // The focal length in pixels follows from the height alone: a wider picture shows more on either side.
    FrameStats stats;
    prepare_scene(scene, exec, cache, stats);
    TileScene tiles = tile_scene(scene, view.width(), view.height(), 1);
    set_up_triangles(scene.mesh, exec, cache.camera_scratch, tiles);
    tiles.mesh = &scene.mesh;
    tiles.surface = surface_mesh(scene.mesh, cache.surface);

    const bool named = !scene.mesh.object.empty();
    parallel_for(tiles.bins->tiles(), exec, [&](std::size_t i) {
        TileWork work;  // not initialised: every stage writes what the next one reads
        walk_tile(tiles, i, tiles.pattern[0], exec.isa, work, [&](int x, int y, int at) {
            const SurfaceBlock& s = work.surface;
            const float z = view_distance(tiles.rays, s.depth[at]);
            view.depth_m(x, y) = z;
            view.disparity(x, y) = law.at(static_cast<double>(z));
            view.normal(x, y) = {s.nx[at], s.ny[at], s.nz[at]};
            view.triangle(x, y) = s.triangle[at];
            view.material(x, y) = static_cast<std::uint32_t>(s.material[at]);
            view.object(x, y) = named ? scene.mesh.object[s.triangle[at]] : 0;
        });
    });
    return view;
}

int automatic_margin(const MiddleView& view, const std::vector<StereoEdit>& edits) {
    const Range range = disparity_range(view);
    double widest = static_cast<double>(std::max({std::fabs(range.low), std::fabs(range.high), 0.0f})),
           reach = 0;
    for (const StereoEdit& edit : edits)
        reach = std::max(reach, reach_of(edit, range));
    widest = 0.5 * (widest + reach);
    const int most = view.picture_width / 4;
    return widest < most ? std::min(static_cast<int>(std::ceil(widest)) + spare_columns, most) : most;
}

}  // namespace obscura
