#include "app/frame/render_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/frame_glare.h"
#include "app/frame/memory.h"
#include "app/frame/shadows.h"
#include "app/frame/sun_hours.h"
#include "app/frame/tiles.h"
#include "app/glare/glare_margin.h"
#include "app/glare/source_kernels.h"
#include "core/mesh_memory.h"
#include "core/stopwatch.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

Region crop_of(const Region& whole, const FrameOptions& options) {
    const Region& c = options.crop;
    if (c.width <= 0 || c.height <= 0) return whole;
    CHECK(c.x0 >= 0 && c.y0 >= 0 && c.x0 + c.width <= whole.width && c.y0 + c.height <= whole.height,
          fmt::format("crop {},{} {}x{} of {}x{}", c.x0, c.y0, c.width, c.height, whole.width, whole.height));
    return c;
}

/// Radiance and the channels of the same pass over the tiles, with glare.
void render_radiance(const Scene& scene, const TileScene& tiles, const FrameOptions& options,
                     const Exec& exec, std::optional<KeptPsf>& psf, Frame& frame) {
    const Stopwatch shade;
    const Region whole{0, 0, tiles.view.width, tiles.view.height}, crop = crop_of(whole, options);
    // Glare comes from anywhere: it takes the whole picture with its margin, and what the pixels show where
    // kernels differ.
    FrameOptions wanted = options;
    wanted.depth |= wants_source_kernels(scene.optics);
    wanted.object |= wants_source_kernels(scene.optics);
    wanted.shift |= tiles.surface.seen != nullptr && wants_source_kernels(scene.optics);
    size_frame(scene.optics.enabled ? tiles.bins->region : crop, wanted, frame);
    // A pattern may take longer than the picture: half of the progress is its own.
    const bool has_glare = scene.optics.enabled && options.progress;
    const double picture_share = has_glare ? 0.5 : 1.0,
                 first_share = picture_share / (1 + soft_passes(tiles));
    if (options.progress) wanted.progress = [&](double share) { options.progress(first_share * share); };
    render_tiles(tiles, wanted, exec, frame);
    if (options.progress) {
        wanted.progress = [&](double share) {
            options.progress(first_share + (picture_share - first_share) * share);
        };
    }
    if (frame.complete) add_soft_lights(tiles, wanted, exec, frame);
    frame.stats.tiles_s = shade.seconds();
    if (has_glare) wanted.progress = [&](double share) { options.progress(0.5 + 0.5 * share); };
    if (frame.complete) add_frame_glare(scene, wanted, exec, psf, frame);
    if (has_glare && frame.complete) options.progress(1);
    if (!options.depth) frame.depth_m = {};
    if (!options.object) frame.object = {};
    if (!options.shift) frame.shift_px = {};
    if (scene.optics.enabled) crop_frame(crop, frame);
}

}  // namespace

void prepare_scene(const Scene& scene, const Exec& exec, FrameCache& cache, FrameStats& stats) {
    if (!cache.prepared) {
        const Stopwatch watch;
        surface_tables(scene.mesh, scene.materials, exec, cache.surface);
        cache.bounds = bounds_of(scene.mesh);
        cache.prepared = true;
        stats.surface_s = watch.seconds();
    }
    CHECK(cache.surface.triangles.size() == scene.mesh.triangles.size(), "the mesh changed without forget()");
}

TileScene tile_scene(const Scene& scene, int width, int height, int samples) {
    TileScene t;
    t.view = camera_view(scene.camera, width, height);
    t.rays = camera_rays(scene.camera, width, height);
    t.pattern = sample_pattern(samples);
    t.materials = shade_materials(scene.materials);
    t.textures = scene.textures;
    t.textured = !scene.mesh.uvs.empty() && std::any_of(scene.materials.begin(), scene.materials.end(),
                                                        [](const Material& m) { return m.texture >= 0; });
    t.sky = shade_sky(scene.sky);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i].light;
        if (!sheds_light(light)) continue;
        TileLight& tile_light = t.lights.emplace_back();
        tile_light.scene_light = i;
        tile_light.shade = shade_light_of(light, scene.camera.eye);
    }
    return t;
}

void set_up_triangles(const Mesh& mesh, const Exec& exec, RasterScratch& scratch, TileScene& tiles,
                      int margin_px) {
    SetupParams params;
    params.centre_samples_only = tiles.pattern.size() == 1;
    params.region = {-margin_px, -margin_px, tiles.view.width + 2 * margin_px,
                     tiles.view.height + 2 * margin_px};
    setup_triangles(mesh, tiles.view, params, exec, scratch.setup);
    bin_records(scratch.setup, params.region, frame_tile_side, exec, scratch.bins);
    tiles.setup = &scratch.setup;
    tiles.bins = &scratch.bins;
}

TileScene prepare_tiles(const Scene& scene, const Exec& exec, FrameCache& cache) {
    const RenderSettings& render = scene.render;
    TileScene t = tile_scene(scene, render.width, render.height, render.samples);
    set_up_triangles(scene.mesh, exec, cache.camera_scratch, t, glare_margin(scene));
    t.mesh = &scene.mesh;
    t.surface = surface_mesh(scene.mesh, cache.surface);
    return t;
}

void render_picture(const Scene& scene, const TileScene& tiles, const FrameOptions& options, const Exec& exec,
                    std::optional<KeptPsf>& psf, Frame& frame) {
    const Light* sun = options.sun_hours ? sun_with_path(scene) : nullptr;
    CHECK(sun != nullptr || !options.sun_hours, "hours of sun need a sun");
    frame.sun_hours = {};
    // A pass is told as one of all.
    const double of_hours =
        sun != nullptr ? sun_passes(size_of(*tiles.casters), static_cast<int>(sun_steps(*sun->path).size()))
                       : 0;
    const double share = (1 + soft_passes(tiles)) / (1 + soft_passes(tiles) + of_hours);
    FrameOptions part = options;
    if (options.progress) part.progress = [&](double done) { options.progress(share * done); };
    render_radiance(scene, tiles, part, exec, psf, frame);
    if (sun == nullptr || !frame.complete) return;
    if (options.progress) part.progress = [&](double done) { options.progress(share + (1 - share) * done); };
    add_sun_hours(tiles, *sun, part, exec, frame);
}

void render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec, FrameCache& cache,
                  Frame& frame) {
    const Stopwatch total;
    frame.stats = FrameStats{};
    frame.stats.triangles = static_cast<std::int64_t>(scene.mesh.triangles.size());
    frame.lens_offset_m = {};
    const MemoryEstimate memory =
        estimate_memory(scene, {.lights = {}, .bright_px = {}, .channels = options});
    frame.stats.bytes = memory.total();
    check_memory(memory, scene.limits, "the frame");
    prepare_scene(scene, exec, cache, frame.stats);

    const Stopwatch setup;
    TileScene tiles = prepare_tiles(scene, exec, cache);
    for (const RecordBlock& block : tiles.setup->blocks)
        frame.stats.records += static_cast<std::int64_t>(block.count);
    frame.stats.bin_items = static_cast<std::int64_t>(tiles.bins->items.size());
    frame.stats.setup_s = setup.seconds();
    const std::int64_t other_bytes = memory.total() - memory.shadow_maps;
    if (!prepare_shadows(scene, other_bytes, exec, cache, tiles, frame.stats, options)) {
        size_frame(crop_of({0, 0, scene.render.width, scene.render.height}, options), options, frame);
        frame.complete = false;
        frame.stats.total_s = total.seconds();
        return;
    }

    for (const LightShadow& shadow : cache.shadows)
        frame.stats.lights.push_back(shadow.stats);

    render_picture(scene, tiles, options, exec, cache.psf, frame);
    frame.stats.total_s = total.seconds();
}

Frame render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec) {
    FrameCache cache;
    Frame frame;
    render_frame(scene, options, exec, cache, frame);
    return frame;
}

}  // namespace obscura
