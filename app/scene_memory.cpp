// What a scene will need, and whether it may.

#include <fmt/format.h>

#include "app/keyframes.h"
#include "app/scene_build.h"
#include "app/scene_shapes.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::int64_t vertex_bytes = sizeof(Vec3f) * 2 + sizeof(Vec2f);
constexpr std::int64_t triangle_bytes = sizeof(Triangle) + 4 * sizeof(std::uint32_t) + sizeof(Plane);
// Tiles resolve their samples at once: a pixel keeps its radiance and channels, and its codes while they are
// encoded (raw, filtered, compressed).
constexpr std::int64_t pixel_bytes = 48 + 24;
constexpr std::int64_t depth_bytes = 4;

std::int64_t frame_bytes(const RenderSettings& render) {
    return std::int64_t{render.width} * render.height * pixel_bytes;
}

double mib(std::int64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

int shadow_map_count(const Light& light) {
    if (light.shadow.method == ShadowMethod::none) return 0;
    return light.kind == LightKind::point ? 6 : 1;
}

std::int64_t shadow_map_bytes(const Light& light) {
    return shadow_map_count(light) * std::int64_t{light.shadow.resolution} * light.shadow.resolution *
           depth_bytes;
}

MemoryEstimate estimate_memory(const Scene& scene) {
    MemoryEstimate e;
    e.meshes = static_cast<std::int64_t>(scene.mesh.positions.size()) * vertex_bytes +
               static_cast<std::int64_t>(scene.mesh.triangles.size()) * triangle_bytes;
    for (const Texture& texture : scene.textures) {
        for (const auto& level : texture.levels) {
            e.textures += static_cast<std::int64_t>(level.pixels.size() * sizeof(Vec3f));
        }
    }
    for (const Light& light : scene.lights)
        e.shadow_maps += shadow_map_bytes(light);
    e.frame = frame_bytes(scene.render);
    return e;
}

MemoryEstimate estimate_memory(const SceneDocument& document) {
    MemoryEstimate e;
    for (const SceneTable* mesh : subtables(document.root, "mesh")) {
        // Shapes have at most three vertices per triangle of their own.
        e.meshes += max_triangles(*mesh) * (triangle_bytes + 3 * vertex_bytes);
    }
    for (const SceneTable* light : subtables(document.root, "light"))
        e.shadow_maps += shadow_map_bytes(light_of(*light));
    e.frame = frame_bytes(render_settings_of(document));
    return e;
}

void check_memory(const MemoryEstimate& estimate, const Limits& limits, const std::string& scene_name) {
    if (estimate.total() <= limits.memory_mib << 20) return;
    throw LimitError(
        fmt::format("{}: needs about {:.0f} MiB (meshes {:.0f}, textures {:.0f}, shadow maps {:.0f}, frame "
                    "{:.0f}), more than limits.memory_mib = {}",
                    scene_name, mib(estimate.total()), mib(estimate.meshes), mib(estimate.textures),
                    mib(estimate.shadow_maps), mib(estimate.frame), limits.memory_mib));
}

}  // namespace obscura
