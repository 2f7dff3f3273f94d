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
    return std::any_of(lights.begin(), lights.end(), [](const SceneLight& light) {
        return light.shadow.method == ShadowMethod::exact || light.shadow.method == ShadowMethod::day;
    });
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

/// What threads take to put the casters of so many lights in order (raster/exact/caster_pool.h).
std::int64_t caster_pool_bytes(const MeshSize& mesh, int lights) {
    const int threads = hardware_threads(), scratches = lights < threads ? 1 : threads;
    return scratches * (setup_bytes(mesh) + casters_sorting_bytes(mesh.triangles));
}

}  // namespace

std::int64_t exact_work_bytes(const MeshSize& mesh, std::span<const SceneLight> lights, const Sky& sky) {
    if (!any_exact(lights) && !is_occluded(sky)) return 0;
    return sends_on(sky) ? surface_light_work_bytes(mesh) : 0;
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

ShadowBytes shadow_bytes(const MeshSize& mesh, std::span<const SceneLight> lights,
                         const RenderSettings& render) {
    ShadowBytes sum;
    for (const ShadowMethodRow& row : shadow_methods()) {
        std::int64_t setup = 0;
        for (const SceneLight& light : lights) {
            if (light.shadow.method != row.method) continue;
            const ShadowBytes one = row.bytes(light, mesh, render);
            sum.kept += one.kept;
            sum.lists += one.lists;
            sum.making = std::max(sum.making, one.making);
            setup = std::max(setup, one.setup);
        }
        sum.setup += setup;
    }
    return sum;
}

}  // namespace obscura
