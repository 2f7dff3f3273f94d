#include "app/render_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "app/frame_shadows.h"
#include "app/scene_build.h"
#include "app/source_kernels.h"
#include "app/stopwatch.h"
#include "core/parallel.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

Region crop_of(const RenderSettings& render, const FrameOptions& options) {
    const Region& c = options.crop;
    if (c.width <= 0 || c.height <= 0) return {0, 0, render.width, render.height};
    CHECK(
        c.x0 >= 0 && c.y0 >= 0 && c.x0 + c.width <= render.width && c.y0 + c.height <= render.height,
        fmt::format("crop {},{} {}x{} of {}x{}", c.x0, c.y0, c.width, c.height, render.width, render.height));
    return c;
}

/// One channel: as large as the frame when wanted, else empty.
template <class T>
void set_channel(Image<T>& channel, bool wanted, const Frame& frame) {
    channel = wanted ? Image<T>(frame.width, frame.height) : Image<T>();
}

void size_frame(const Region& crop, const FrameOptions& options, Frame& frame) {
    frame.x0 = crop.x0;
    frame.y0 = crop.y0;
    frame.width = crop.width;
    frame.height = crop.height;
    frame.radiance.reset(crop.width, crop.height);
    set_channel(frame.depth_m, options.depth, frame);
    set_channel(frame.normal, options.normal, frame);
    set_channel(frame.albedo, options.albedo, frame);
    set_channel(frame.object, options.object, frame);
    set_channel(frame.shadow, options.shadow, frame);
}

/// Tells `progress` about once per half percent, one call at a time.
class ProgressMeter {
  public:
    ProgressMeter(const std::function<void(double)>& progress, std::size_t tiles)
        : progress_(progress), tiles_(tiles), step_(std::max<std::size_t>(tiles / 200, 1)) {}
    void tile_done() {
        if (!progress_) return;
        const std::lock_guard lock(mutex_);
        ++done_;
        if (done_ % step_ == 0 || done_ == tiles_) {
            progress_(static_cast<double>(done_) / static_cast<double>(tiles_));
        }
    }

  private:
    const std::function<void(double)>& progress_;
    std::size_t tiles_, step_, done_ = 0;
    std::mutex mutex_;
};

void render_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, Frame& frame) {
    const int column0 = frame.x0 / frame_tile_side, row0 = frame.y0 / frame_tile_side;
    const int columns = (frame.x0 + frame.width - 1) / frame_tile_side - column0 + 1;
    const int rows = (frame.y0 + frame.height - 1) / frame_tile_side - row0 + 1;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    ProgressMeter meter(options.progress, tiles);
    std::vector<std::int64_t> covered(tiles, 0);
    const std::size_t lights = scene.lights.size();
    std::vector<double> lookup_s(tiles * lights, 0.0);
    std::atomic<bool> skipped = false;
    parallel_for(tiles, exec, [&](std::size_t i) {
        if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed)) {
            skipped = true;
            return;
        }
        TileWork work;  // not initialised: every stage writes what the next one reads
        work.lookup_s = std::span(lookup_s).subspan(i * lights, lights);
        const int column = column0 + static_cast<int>(i) % columns,
                  row = row0 + static_cast<int>(i) / columns;
        covered[i] = render_tile(scene, column, row, options, exec.isa, work, frame);
        meter.tile_done();
    });
    frame.complete = !skipped;
    for (const std::int64_t n : covered)
        frame.stats.covered_samples += n;
    std::size_t shadow = 0;
    for (std::size_t l = 0; l < lights; ++l) {
        if (!scene.lights[l].pcf) continue;
        double& sum = frame.stats.lights[shadow++].lookup_s;
        for (std::size_t i = 0; i < tiles; ++i)
            sum += lookup_s[i * lights + l];
    }
    frame.stats.samples = static_cast<std::int64_t>(tiles) * frame_tile_side * frame_tile_side *
                          static_cast<std::int64_t>(scene.pattern.size());
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

TileScene prepare_tiles(const Scene& scene, const Exec& exec, FrameCache& cache) {
    TileScene t;
    const RenderSettings& render = scene.render;
    t.view = camera_view(scene.camera, render.width, render.height);
    t.rays = camera_rays(scene.camera, render.width, render.height);
    t.pattern = sample_pattern(render.samples);
    SetupParams params;
    params.centre_samples_only = render.samples == 1;
    setup_triangles(scene.mesh, t.view, params, exec, cache.camera_scratch.setup);
    bin_records(cache.camera_scratch.setup, {0, 0, render.width, render.height}, frame_tile_side, exec,
                cache.camera_scratch.bins);
    t.setup = &cache.camera_scratch.setup;
    t.bins = &cache.camera_scratch.bins;
    t.mesh = &scene.mesh;
    t.surface = surface_mesh(scene.mesh, cache.surface);
    t.materials = shade_materials(scene.materials);
    t.textures = scene.textures;
    t.textured = !scene.mesh.uvs.empty() && std::any_of(scene.materials.begin(), scene.materials.end(),
                                                        [](const Material& m) { return m.texture >= 0; });
    t.sky = shade_sky(scene.sky);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        if (!sheds_light(light)) continue;
        TileLight& tile_light = t.lights.emplace_back();
        tile_light.scene_light = i;
        tile_light.shade = shade_light_of(light, scene.camera.eye);
    }
    return t;
}

void render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec, FrameCache& cache,
                  Frame& frame) {
    const Stopwatch total;
    frame.stats = FrameStats{};
    frame.stats.triangles = static_cast<std::int64_t>(scene.mesh.triangles.size());
    const MemoryEstimate memory = estimate_memory(scene);
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
    if (!prepare_shadows(scene, other_bytes, exec, cache, tiles, frame.stats, options.cancel)) {
        size_frame(crop_of(scene.render, options), options, frame);
        frame.complete = false;
        frame.stats.total_s = total.seconds();
        return;
    }

    for (const LightShadow& shadow : cache.shadows)
        frame.stats.lights.push_back(shadow.stats);

    const Stopwatch shade;
    const Region crop = crop_of(scene.render, options), whole{0, 0, scene.render.width, scene.render.height};
    // Glare comes from anywhere: it takes the whole picture, and what the pixels show where kernels differ.
    FrameOptions wanted = options;
    wanted.depth |= wants_source_kernels(scene.optics);
    wanted.object |= wants_source_kernels(scene.optics);
    size_frame(scene.optics.enabled ? whole : crop, wanted, frame);
    // A pattern may take longer than the picture: half of the progress is its own.
    const bool has_glare = scene.optics.enabled && options.progress;
    if (has_glare) wanted.progress = [&](double share) { options.progress(0.5 * share); };
    render_tiles(tiles, wanted, exec, frame);
    frame.stats.tiles_s = shade.seconds();
    if (has_glare) wanted.progress = [&](double share) { options.progress(0.5 + 0.5 * share); };
    if (frame.complete) add_frame_glare(scene, wanted, exec, cache.psf, frame);
    if (has_glare && frame.complete) options.progress(1);
    if (!options.depth) frame.depth_m = {};
    if (!options.object) frame.object = {};
    if (scene.optics.enabled) crop_frame(crop, frame);
    frame.stats.total_s = total.seconds();
}

Frame render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec) {
    FrameCache cache;
    Frame frame;
    render_frame(scene, options, exec, cache, frame);
    return frame;
}

}  // namespace obscura
