#include "app/frame/shadow_memory.h"

#include <algorithm>
#include <cmath>

#include "app/frame/exact_tile.h"
#include "app/frame/needed_texels.h"
#include "app/frame/soft_light.h"
#include "app/frame/stack_shadow.h"
#include "app/frame/sun_hours.h"
#include "app/frame/surface_light.h"
#include "app/scene/shadow_code.h"
#include "core/parallel.h"
#include "hierarchy/build_memory.h"
#include "hierarchy/codes/codes.h"
#include "raster/exact/casters.h"
#include "raster/exact/soft_casters.h"
#include "raster/gbuffer.h"
#include "raster/setup_memory.h"
#include "raster/shadow_map.h"

namespace obscura {
namespace {

bool any_exact(std::span<const SceneLight> lights) {
    return std::any_of(lights.begin(), lights.end(),
                       [](const SceneLight& light) { return light.shadow.method == ShadowMethod::exact; });
}

/// Parts of a disc that one pass asks, as add_soft_lights() shares them out.
std::int64_t disc_bytes(const MeshSize& mesh, const SceneLight& light, const RenderSettings& render) {
    const int asked = light.shadow.samples == auto_samples ? 16 : light.shadow.samples;
    const int of_sample = asked / std::clamp(asked / 16, 1, render.samples);
    return std::min(std::int64_t{(of_sample + 15) / 16} * soft_parts_bytes(mesh.vertices),
                    soft_pass_bytes(mesh, true));
}

bool is_occluded(const Sky& sky) {
    return sky.occlusion && sky.ambient > 0;
}

bool sends_on(const Sky& sky) {
    return is_occluded(sky) && sky.bounces > 0;
}

/// Nodes of one view's tree, all of it. A model, not a bound: they grow with the length of the outlines on
/// the map, that is with its side; 31 to 32 per texel of the side in the closed city of Scandolo, Bauszat and
/// Eisemann 2016, more where there are many leaves. Construction stops at the limit. Nothing where the
/// picture decides the resolution: it is found later.
std::int64_t expected_nodes(const ShadowSettings& shadow) {
    constexpr std::int64_t nodes_per_side = 32;
    return std::min(nodes_per_side * shadow.resolution,
                    std::int64_t{shadow.resolution} * shadow.resolution * 4 / 3);
}

/// Nodes of all of a light's trees, as far as they are built.
std::int64_t built_nodes(const SceneLight& light, const RenderSettings& render) {
    const ShadowSettings& s = light.shadow;
    const std::int64_t maps = shadow_map_count(light), all = maps * expected_nodes(s);
    const std::int64_t squares = is_of_one_picture(s) ? expected_squares(s, maps, render) : 0;
    // A light whose collection is given up has all of its map built. Else nodes follow the outlines that the
    // picture shows: 200 to 4000 per side of its samples were measured, most where there are leaves.
    if (!is_of_one_picture(s) || squares >= most_needed_squares) return all;
    const double side = std::sqrt(static_cast<double>(render.width) * render.height * render.samples);
    const std::int64_t seen = maps == 0 ? 0 : std::min(static_cast<std::int64_t>(250 * side), 2 * squares);
    return s.resolution == auto_resolution ? seen : std::min(all, seen);
}

std::int64_t top_bytes(const SceneLight& light) {
    return light.shadow.resolution == auto_resolution
               ? 0
               : shadow_map_count(light) * top_nodes_of(chosen_code(light.shadow).code) *
                     (std::int64_t{sizeof(TopNode)} << (2 * light.shadow.top_levels));
}

/// What threads take to put the casters of so many lights in order (raster/exact/caster_pool.h).
std::int64_t caster_pool_bytes(const MeshSize& mesh, int lights) {
    const int threads = hardware_threads(), scratches = lights < threads ? 1 : threads;
    return scratches * (setup_bytes(mesh) + casters_sorting_bytes(mesh.triangles));
}

}  // namespace

std::int64_t exact_casters_bytes(const MeshSize& mesh, std::span<const SceneLight> lights) {
    std::int64_t bytes = 0;
    for (const SceneLight& light : lights) {
        if (light.shadow.method != ShadowMethod::exact) continue;
        // Triangles at the borders of six views are in several of them.
        const bool six = shadow_view_count(light.light.kind) > 1;
        bytes += casters_bytes(six ? mesh.triangles * 5 / 4 : mesh.triangles);
    }
    return bytes;
}

std::int64_t exact_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky) {
    if (!any_exact(lights) && !is_occluded(sky)) return 0;
    return sends_on(sky) ? surface_light_work_bytes(mesh) : 0;
}

std::int64_t stacks_bytes(const MeshSize& mesh, std::span<const SceneLight> lights) {
    std::int64_t bytes = 0;
    for (const SceneLight& light : lights)
        if (light.shadow.method == ShadowMethod::stack) bytes += stack_bytes(light, mesh.triangles);
    return bytes;
}

std::int64_t making_stacks_bytes(const MeshSize& mesh, std::span<const SceneLight> lights) {
    std::int64_t bytes = 0;
    for (const SceneLight& light : lights) {
        if (light.shadow.method != ShadowMethod::stack) continue;
        // Maps are made side by side, by every thread with a setup of its own.
        const std::int64_t setup = hardware_threads() * construction_bytes(mesh);
        bytes = std::max(bytes, setup + stack_work_bytes(light, mesh.triangles));
    }
    return bytes;
}

std::int64_t exact_tiles_bytes(std::span<const SceneLight> lights, const Sky& sky) {
    if (!any_exact(lights) && !is_occluded(sky)) return 0;
    const bool soft = is_occluded(sky) || std::any_of(lights.begin(), lights.end(), is_soft);
    const std::size_t together = std::max<std::size_t>(lights.size(), soft ? most_soft_together : 0);
    return hardware_threads() * exact_tile_bytes(together, sends_on(sky));
}

std::int64_t soft_passes_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky,
                               const RenderSettings& render) {
    // Points that are no disc's have casters of their own, set up meanwhile by every thread.
    const std::int64_t own =
        soft_pass_bytes(mesh, false) + caster_pool_bytes(mesh, soft_points_together(mesh, false));
    std::int64_t most = is_occluded(sky) ? own : 0;
    for (const SceneLight& light : lights) {
        if (is_soft(light))
            most = std::max(most, is_parallel(light.light.kind) ? disc_bytes(mesh, light, render) : own);
    }
    return most + (sends_on(sky) ? surface_light_bytes(mesh) : 0);
}

std::int64_t sun_hours_pass_bytes(const MeshSize& mesh, int steps) {
    if (steps == 0) return 0;
    return sun_pass_bytes(mesh, steps) + caster_pool_bytes(mesh, suns_together(mesh, steps));
}

std::int64_t sun_hours_tiles_bytes(const MeshSize& mesh, int steps) {
    if (steps == 0) return 0;
    return hardware_threads() * exact_tile_bytes(static_cast<std::size_t>(suns_together(mesh, steps)));
}

std::int64_t sun_hours_sums_bytes(const RenderSettings& render) {
    constexpr std::int64_t pixel = sizeof(double) + sizeof(std::uint8_t);
    return std::int64_t{render.width} * render.height * pixel;
}

int shadow_map_count(const SceneLight& light) {
    if (light.shadow.method == ShadowMethod::none) return 0;
    return shadow_view_count(light.light.kind);
}

std::int64_t shadow_map_bytes(const SceneLight& light) {
    if (light.shadow.method == ShadowMethod::exact) return 0;
    if (light.shadow.method == ShadowMethod::stack) return 0;  // see stacks_bytes()
    if (light.shadow.method == ShadowMethod::map)
        return dense_map_bytes(light.light.kind, light.shadow.resolution);
    return shadow_map_count(light) * expected_nodes(light.shadow) * node_bytes + top_bytes(light);
}

std::int64_t built_map_bytes(const SceneLight& light, const RenderSettings& render) {
    if (!is_of_one_picture(light.shadow)) return shadow_map_bytes(light);
    return built_nodes(light, render) * node_bytes + top_bytes(light);
}

std::int64_t expected_squares(const ShadowSettings& shadow, std::int64_t maps, const RenderSettings& render) {
    const std::int64_t pixels = std::int64_t{render.width} * render.height;
    // Of texels as large as pixels, neighbouring samples read the same squares; of small ones each its own.
    const std::int64_t fifths = shadow.max_magnification < 0.5 ? 8 * render.samples
                                : render.samples >= 16         ? 40
                                : render.samples >= 4          ? 15
                                                               : 6;
    const std::int64_t read = pixels * fifths / 5;
    const std::int64_t blocks = (std::int64_t{shadow.resolution} + 7) / 8;
    // Hierarchical kernels read coarser squares, too: a third more of them.
    const std::int64_t there =
        shadow.resolution == auto_resolution ? most_needed_squares : maps * blocks * blocks * 4 / 3 + 1;
    return std::min({read, there, most_needed_squares});
}

std::int64_t shadow_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights,
                               const RenderSettings& render) {
    // A word holds sixteen squares, of which a quarter are read; a code is one square. Codes of all lights
    // stay until their trees are made, and one light's words are there twice while they are sorted.
    constexpr std::int64_t word_bytes = sizeof(std::uint64_t) / 4, code_bytes = sizeof(std::uint64_t);
    std::int64_t lists = 0, most = 0, work = making_stacks_bytes(mesh, lights);
    for (const SceneLight& light : lights) {
        const ShadowSettings& s = light.shadow;
        if (s.method != ShadowMethod::compressed) continue;
        const std::int64_t squares =
            is_of_one_picture(s) ? expected_squares(s, shadow_map_count(light), render) : 0;
        lists += squares * (word_bytes + code_bytes);
        most = std::max(most, squares);
        // One view's tree at a time.
        const std::int64_t nodes = built_nodes(light, render) / std::max(shadow_map_count(light), 1);
        work = std::max(
            work, construction_bytes(mesh) + nodes * row_of(chosen_code(s).code).node_construction_bytes);
    }
    return lists + std::max(work, most * 2 * word_bytes);
}

std::int64_t kept_setup_bytes(const MeshSize& mesh, std::span<const SceneLight> lights) {
    std::int64_t bytes = 0;
    bool exact = false;
    for (const SceneLight& light : lights) {
        const int side = light.shadow.resolution;
        if (light.shadow.method == ShadowMethod::map) {
            bytes =
                std::max(bytes, setup_bytes(mesh) + bin_bytes(mesh.triangles, side, side, frame_tile_side));
        }
        exact |= light.shadow.method == ShadowMethod::exact;
    }
    return bytes + (exact ? setup_bytes(mesh) + casters_sorting_bytes(mesh.triangles) : 0);
}

}  // namespace obscura
