#include "app/pair/eyes.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "app/frame/shadows.h"
#include "app/frame/tiles.h"
#include "app/glare/glare_margin.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/vec_arrays.h"
#include "stereo/eye_mesh.h"

namespace obscura {
namespace {

float side_of(Eye eye) {
    return eye == Eye::left ? 1.0f : -1.0f;
}

/// Whether two triangles have an edge in common, by position.
bool joined(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
    if (a == nothing_seen || b == nothing_seen) return false;
    int corners = 0;
    for (const std::uint32_t v : mesh.triangles[a].v) {
        for (const std::uint32_t w : mesh.triangles[b].v)
            corners += mesh.positions[v] == mesh.positions[w] ? 1 : 0;
    }
    return corners >= 2;
}

std::int64_t count_cracks(const Mesh& mesh, const Image<std::uint32_t>& triangle) {
    std::int64_t cracks = 0;
    for (int y = 0; y < triangle.height; ++y) {
        for (int x = 0; x < triangle.width; ++x) {
            if (triangle(x, y) != nothing_seen) continue;
            const bool across =
                x > 0 && x + 1 < triangle.width && joined(mesh, triangle(x - 1, y), triangle(x + 1, y));
            const bool down =
                y > 0 && y + 1 < triangle.height && joined(mesh, triangle(x, y - 1), triangle(x, y + 1));
            cracks += across || down ? 1 : 0;
        }
    }
    return cracks;
}

/// The shared steps' statistics become each picture's own, so that its lookups find their lights.
void render_one(const Scene& scene, const TileScene& tiles, const EyesWanted& wanted, double from, double to,
                const Exec& exec, EyesCache& cache, const FrameStats& shared, Frame& frame) {
    const Stopwatch watch;
    FrameOptions options = wanted.channels;
    if (options.progress) {
        options.progress = [&](double share) { wanted.channels.progress(from + (to - from) * share); };
    }
    frame.stats = shared;
    frame.stats.notices.clear();
    for (const RecordBlock& block : tiles.setup->blocks)
        frame.stats.records += static_cast<std::int64_t>(block.count);
    frame.stats.bin_items = static_cast<std::int64_t>(tiles.bins->items.size());
    frame.stats.triangles = static_cast<std::int64_t>(tiles.mesh->triangles.size());
    render_picture(scene, tiles, options, exec, cache.frame.psf, frame);
    frame.stats.total_s = watch.seconds();
}

/// The middle camera's picture, wider than the scene's.
TileScene middle_tiles(const Scene& scene, int margin_px, const Exec& exec, EyesCache& cache) {
    TileScene t =
        tile_scene(scene, scene.render.width + 2 * margin_px, scene.render.height, scene.render.samples);
    set_up_triangles(scene.mesh, exec, cache.middle, t, glare_margin(scene));
    t.mesh = &scene.mesh;
    t.surface = surface_mesh(scene.mesh, cache.frame.surface);
    return t;
}

}  // namespace

TileScene eye_tiles(const Scene& scene, const MovedMesh& moved, const SurfaceTables& tables,
                    const StereoRig& rig, Eye eye, const Exec& exec, EyeStage& stage) {
    CHECK(stage.seen.size() == moved.mesh.positions.size());
    const RenderSettings& render = scene.render;
    TileScene t = tile_scene(scene, render.width, render.height, render.samples);
    set_up_triangles(eye_mesh(moved, stage.seen, exec), exec, stage.scratch, t, glare_margin(scene));
    t.mesh = &moved.mesh;
    t.surface = surface_mesh(moved.mesh, tables);
    // Without triangles nothing is read, but the sky has its place.
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    static constexpr float no_vertices[3] = {0, 0, 0};
    t.surface.seen = stage.seen.empty() ? no_vertices : &stage.seen.data()->x;
    // The left eye draws a column at X + d / 2, d = -offset for infinity: column X' shows X' + offset / 2.
    const DisparityLaw law = disparity_law(rig, scene.camera, render.height);
    t.surface.background_shift_px = side_of(eye) * static_cast<float>(0.5 * law.offset);
    return t;
}

EyeMap eye_map(const Scene& scene, const TileScene& tiles, const MovedMesh& moved, const StereoRig& rig,
               Eye eye, const Exec& exec) {
    const int width = tiles.view.width, height = tiles.view.height;
    const DisparityLaw law = disparity_law(rig, scene.camera, height);
    EyeMap map;
    map.depth_m = Image<float>(width, height, std::numeric_limits<float>::infinity());
    map.triangle = Image<std::uint32_t>(width, height, nothing_seen);
    map.disparity = map.original = DisparityMap(width, height, static_cast<float>(-law.offset));
    const Basis basis = look_basis(scene.camera.look_at - scene.camera.eye, scene.camera.up);
    parallel_for(tiles.bins->tiles(), exec, [&](std::size_t i) {
        TileWork work;  // not initialised: every stage writes what the next one reads
        walk_tile(tiles, i, {128, 128}, exec.isa, work, [&](int x, int y, int at) {
            if (!tiles.in_picture(x, y)) return;
            const SurfaceBlock& s = work.surface;
            const float z = view_distance(tiles.rays, s.depth[at]);
            map.depth_m(x, y) = z;
            map.triangle(x, y) = moved.source[s.triangle[at]];
            map.original(x, y) = law.at(static_cast<double>(z));
            // The point is half its disparity away from where the middle camera sees it.
            const Vec3d p = to_double(Vec3f{s.px[at], s.py[at], s.pz[at]});
            const double column = 0.5 * width + law.focal_px * dot(p, basis.right) / dot(p, basis.forward);
            map.disparity(x, y) =
                static_cast<float>(2.0 * static_cast<double>(side_of(eye)) * (x + 0.5 - column));
        });
    });
    map.cracks = count_cracks(scene.mesh, map.triangle);
    return map;
}

bool render_eyes(const Scene& scene, const MovedMesh& moved, EyePositions positions, const StereoRig& rig,
                 const EyesWanted& wanted, std::int64_t other_bytes, const Exec& exec, EyesCache& cache,
                 EyeFrames& out) {
    CHECK(wanted.channels.crop.empty(), "eyes are rendered whole");
    FrameStats& shared = out.shared = FrameStats{};
    prepare_scene(scene, exec, cache.frame, shared);
    const Stopwatch setup;
    surface_tables(moved.mesh, scene.materials, exec, cache.tables);
    cache.left.seen = std::move(positions.left);
    cache.right.seen = std::move(positions.right);
    std::vector<TileScene> pictures;
    pictures.push_back(eye_tiles(scene, moved, cache.tables, rig, Eye::left, exec, cache.left));
    pictures.push_back(eye_tiles(scene, moved, cache.tables, rig, Eye::right, exec, cache.right));
    const Vec3d half =
        look_basis(scene.camera.look_at - scene.camera.eye, scene.camera.up).right * (0.5 * rig.interaxial_m);
    if (wanted.shading == EyeShading::eyes) {
        set(pictures[0].rays.viewer, to_float(-half));
        set(pictures[1].rays.viewer, to_float(half));
    }
    const bool middle = wanted.middle_margin_px >= 0;
    if (middle) pictures.push_back(middle_tiles(scene, wanted.middle_margin_px, exec, cache));
    shared.setup_s = setup.seconds();

    // What the pictures look up follows from the edits, not from the camera alone.
    forget_picture_shadows(cache.frame);
    if (!prepare_shadows(scene, other_bytes, exec, cache.frame, pictures, shared, wanted.channels))
        return false;
    for (const LightShadow& shadow : cache.frame.shadows)
        shared.lights.push_back(shadow.stats);

    out.left.lens_offset_m = -half;
    out.right.lens_offset_m = half;
    const double step = middle ? 1.0 / 3 : 0.5;
    render_one(scene, pictures[0], wanted, 0, step, exec, cache, shared, out.left);
    render_one(scene, pictures[1], wanted, step, 2 * step, exec, cache, shared, out.right);
    out.middle.reset();
    if (middle) {
        render_one(scene, pictures[2], wanted, 2 * step, 1, exec, cache, shared, out.middle.emplace());
    }
    out.left_map = eye_map(scene, pictures[0], moved, rig, Eye::left, exec);
    out.right_map = eye_map(scene, pictures[1], moved, rig, Eye::right, exec);
    return out.left.complete && out.right.complete && (!middle || out.middle->complete);
}

}  // namespace obscura
