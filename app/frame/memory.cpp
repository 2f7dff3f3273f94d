#include "app/frame/memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/channels.h"
#include "app/frame/shadow_memory.h"
#include "app/frame/sun_hours.h"
#include "app/frame/tile.h"
#include "app/glare/glare_margin.h"
#include "app/glare/glare_memory.h"
#include "app/glare/lamp_pixels.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/shapes.h"
#include "core/count_text.h"
#include "core/error.h"
#include "core/mesh_memory.h"
#include "core/parallel.h"
#include "core/sky/image_sky.h"
#include "raster/layer_tile.h"
#include "raster/setup_memory.h"

namespace obscura {
namespace {

/// Tiles resolve their samples at once: a pixel keeps its radiance and channels, and its codes while they are
/// encoded (raw, filtered, compressed).
std::int64_t picture_bytes(const RenderSettings& render, const FrameOptions& wanted) {
    constexpr std::int64_t code_bytes = 12;
    std::int64_t pixel = sizeof(Vec3f) + code_bytes;
    for_each_channel(
        [&]<class T>(const FrameChannel<T>& row) { pixel += wanted.*row.wanted ? sizeof(T) : 0; });
    return std::int64_t{render.width} * render.height * pixel;
}

/// What the threads hold: a tile each, and in shadow maps the layers of one. Layers begin at 12 per texel (8,
/// and half as many again) and grow only where more surfaces lie behind one another.
std::int64_t thread_bytes(bool layers) {
    constexpr std::int64_t layer_bytes =
        std::int64_t{layer_tile_texels} * layers_in_place * 3 / 2 * (sizeof(LayerKey) + sizeof(std::int32_t));
    return hardware_threads() * (std::int64_t{sizeof(TileWork)} + (layers ? layer_bytes : 0));
}

/// Tables of surfaces and the camera's setup, which serve every step.
std::int64_t prepared_bytes(const MeshSize& mesh, const RenderSettings& render) {
    return surface_table_bytes(mesh) + setup_bytes(mesh) +
           bin_bytes(mesh.triangles, render.width, render.height, frame_tile_side);
}

/// The program at work, the rounding of large blocks to pages, and freed ones that the allocator keeps, more
/// or fewer as threads take turns: measured (5 to 15 %), not derived.
std::int64_t allocator_bytes(std::int64_t held) {
    return (std::int64_t{4} << 20) + held / 6;
}

/// Suns that hours of sun are counted of, with or without sun; none: not wanted.
int suns_of(const Scene& scene, const FrameOptions& wanted) {
    const Light* sun = wanted.sun_hours ? sun_with_path(scene) : nullptr;
    // A step in which the sun sets and rises again has two.
    return sun != nullptr ? sun->path->steps + 1 : 0;
}

}  // namespace

MemoryEstimate estimate_memory(const Scene& scene, const KnownNeeds& known) {
    const MeshSize mesh = size_of(scene.mesh);
    // Pictures that glare are rendered wider, and cropped.
    const int margin = glare_margin(scene);
    const RenderSettings wide = widened(scene.render, margin);
    const std::span<const SceneLight> lights =
        known.lights.value_or(std::span<const SceneLight>(scene.lights));
    MemoryEstimate e;
    e.meshes = mesh_bytes(mesh);
    for (const auto& [name, surface] : scene.emitters)
        e.meshes += static_cast<std::int64_t>(surface->pieces.capacity() * sizeof(EmitterPiece));
    for (const Texture& texture : scene.textures) {
        for (const auto& level : texture.levels)
            e.textures += static_cast<std::int64_t>(level.pixels.size() * sizeof(Vec3f));
    }
    // As it was read, and as frames ask it.
    if (scene.sky.image)
        e.textures += static_cast<std::int64_t>(2 * scene.sky.image->pixels.pixels.size() * sizeof(Vec3f));
    const ShadowBytes shadows = shadow_bytes(mesh, lights, wide);
    e.shadow_maps += shadows.kept;
    bool layers = false;
    std::int64_t making_stacks = 0, whole_blocks = 0;  // which leave nothing over
    for (const SceneLight& light : lights) {
        if (light.shadow.method == ShadowMethod::none) continue;
        const ShadowMethodRow& row = row_of(light.shadow.method);
        const ShadowBytes one = row.bytes(light, mesh, wide);
        if (row.whole_blocks) whole_blocks += one.kept;
        if (light.shadow.method == ShadowMethod::stack) {
            e.stacks += one.kept;
            making_stacks = std::max(making_stacks, one.making);
        }
        layers |= row.uses_layers;
    }
    e.stacks += making_stacks;
    // Hours of sun come after the picture, pass after pass as lights with a size do.
    const int suns = suns_of(scene, known.channels);
    e.shadow_maps +=
        std::max(soft_passes_bytes(mesh, lights, scene.sky, wide), sun_hours_pass_bytes(mesh, suns));
    // First the shadows are made, then the picture, then its glare. A quarter of what shadows took is lists
    // in small blocks, which stay with the threads.
    const std::int64_t making =
        std::max(shadows.lists + shadows.making, exact_work_bytes(mesh, lights, scene.sky));
    const std::int64_t picture =
        picture_bytes(wide, known.channels) +
        std::max(glare_bytes(scene.optics, scene.render, margin, lamp_count(scene), known.bright_px),
                 suns > 0 ? sun_hours_sums_bytes(scene.render) : 0);
    e.frame = prepared_bytes(mesh, wide) + shadows.setup + thread_bytes(layers) +
              std::max(exact_tiles_bytes(lights, scene.sky), sun_hours_tiles_bytes(mesh, suns)) +
              std::max(making, making / 4 + picture);
    e.frame += allocator_bytes(e.total() - whole_blocks);
    return e;
}

MemoryEstimate estimate_memory(const SceneDocument& document) {
    MemoryEstimate e;
    for (const SceneTable* mesh : subtables(document.root, "mesh")) {
        // Shapes have at most three vertices per triangle of their own.
        e.meshes += mesh_bytes({3 * max_triangles(*mesh), max_triangles(*mesh), 0});
    }
    const RenderSettings render = render_settings_of(document);
    const OpticsSettings optics = optics_of(document, scene_frames(document).first);
    // Lamps are counted, and known to be bright, when their meshes are there.
    const int margin = glare_margin(optics, render, 0);
    const RenderSettings wide = widened(render, margin);
    for (const SceneTable* table : subtables(document.root, "light")) {
        const SceneLight light = light_of(*table);
        e.shadow_maps += shadow_bytes({}, std::span(&light, 1), wide).kept;
    }
    e.frame = picture_bytes(wide, {}) + glare_bytes(optics, render, margin, 0, {});
    return e;
}

void check_memory(const MemoryEstimate& estimate, const Limits& limits, const std::string& scene_name) {
    if (estimate.total() <= limits.memory_mib << 20) return;
    const std::string stacks =
        estimate.stacks > estimate.total() / 4
            ? fmt::format(
                  "; stacks take {:.0f} of it: lower their samples or resolution, or use method = "
                  "\"exact\", which keeps no maps",
                  mib(estimate.stacks))
            : "";
    throw LimitError(
        fmt::format("{}: needs about {:.0f} MiB (meshes {:.0f}, textures {:.0f}, shadow maps {:.0f}, frame "
                    "{:.0f}), more than limits.memory_mib = {}{}",
                    scene_name, mib(estimate.total()), mib(estimate.meshes), mib(estimate.textures),
                    mib(estimate.shadow_maps), mib(estimate.frame), limits.memory_mib, stacks));
}

}  // namespace obscura
