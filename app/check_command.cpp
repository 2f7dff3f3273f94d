#include "app/check_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/keyframes.h"
#include "app/scene_build.h"
#include "raster/view.h"

namespace obscura {
namespace {

std::string size_text(std::int64_t bytes) {
    const auto b = static_cast<double>(bytes);
    if (bytes < 10 << 10) return fmt::format("{} B", bytes);
    if (bytes < 10 << 20) return fmt::format("{:.1f} KiB", b / (1 << 10));
    return fmt::format("{:.1f} MiB", b / (1 << 20));
}

std::string point_text(Vec3d p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

std::string camera_text(const Camera& c) {
    const std::string lens = c.kind == CameraKind::perspective
                                 ? fmt::format("perspective, {:.4g} degrees high", c.vfov_deg)
                                 : fmt::format("orthographic, {:.4g} m high", c.height_m);
    return fmt::format("camera    {}, from {} m to {} m\n", lens, point_text(c.eye), point_text(c.look_at));
}

std::string picture_text(const SceneDocument& document, const Scene& scene) {
    const FrameRange range = scene_frames(document);
    const SceneTable& frames = subtable(document.root, "frames");
    const std::size_t keyframes = subtables(frames, "camera").size() + subtables(frames, "light").size();
    std::string out = fmt::format("picture   {} x {} pixels, {} sample{} each, exposure {:+.4g} EV\n",
                                  scene.render.width, scene.render.height, scene.render.samples,
                                  scene.render.samples == 1 ? "" : "s", scene.render.exposure_ev);
    out += fmt::format("frames    {} ({})", range.count(), text(frames, "range"));
    if (keyframes > 0) out += fmt::format(", {} keyframes, {}", keyframes, text(frames, "interpolation"));
    out += '\n';
    for (const SceneTable* output : subtables(document.root, "output")) {
        out += fmt::format("output    {} -> {}\n", text(*output, "aov"), text(*output, "file"));
    }
    return out;
}

const char* kind_text(LightKind kind) {
    switch (kind) {
        case LightKind::directional:
            return "directional";
        case LightKind::sun:
            return "sun";
        case LightKind::point:
            return "point";
        case LightKind::spot:
            return "spot";
    }
    return "";
}

/// ", texels of 34 mm": how fine the parallel light's map is; it covers all of the scene.
std::string texel_text(const Light& light, const Bounds& bounds) {
    const bool parallel = light.kind == LightKind::directional || light.kind == LightKind::sun;
    if (!parallel || bounds.empty()) return "";
    const LightView view = orthographic_light_view(bounds, light.direction, light.shadow.resolution);
    const auto& x = view.to_map.m[0];
    return fmt::format(", texels of {:.3g} mm", 1000 / std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
}

std::string light_text(const Light& light, const Bounds& bounds) {
    std::string out = fmt::format("light     {}: {}", light.id, kind_text(light.kind));
    if (light.below_horizon) out += ", below the horizon in the first frame";
    const int maps = shadow_map_count(light);
    if (maps == 0) return out + ", no shadows\n";
    const int n = light.shadow.resolution;
    return out + fmt::format(", {} shadow map{} of {} x {}{}, filter {} x {}, {}\n", maps,
                             maps == 1 ? "" : "s", n, n, texel_text(light, bounds), light.shadow.filter_px,
                             light.shadow.filter_px, size_text(shadow_map_bytes(light)));
}

std::string mesh_text(const Scene& scene) {
    const Mesh& mesh = scene.mesh;
    const auto closed = std::count_if(mesh.components.begin(), mesh.components.end(),
                                      [](const Component& c) { return c.closed; });
    std::string out =
        fmt::format("meshes    {} triangles, {} vertices, {} objects, {} closed and {} open components\n",
                    mesh.triangles.size(), mesh.positions.size(), mesh.objects.size(), closed,
                    static_cast<std::int64_t>(mesh.components.size()) - closed);
    if (mesh.triangles.empty()) out += "note      there is nothing to see but the sky\n";
    out += fmt::format("materials {}\n", scene.materials.size());
    for (const Texture& t : scene.textures) {
        out += fmt::format("texture   {}: {} x {} pixels, {} levels\n", t.name, t.levels[0].width,
                           t.levels[0].height, t.levels.size());
    }
    return out;
}

std::string memory_text(const Scene& scene) {
    const MemoryEstimate e = estimate_memory(scene);
    return fmt::format("memory    about {} of {} MiB: meshes {}, textures {}, shadow maps {}, frame {}\n",
                       size_text(e.total()), scene.limits.memory_mib, size_text(e.meshes),
                       size_text(e.textures), size_text(e.shadow_maps), size_text(e.frame));
}

}  // namespace

std::string check_report(const CheckOptions& options) {
    const SceneDocument document = read_scene(options.scene, options.overrides);
    const Scene scene = build_scene(document, FileAccess{document.folder, options.allowed_paths});
    std::string out = fmt::format("scene     {}\n", options.scene.string());
    out += picture_text(document, scene) + camera_text(scene.camera);
    const Bounds bounds = bounds_of(scene.mesh);
    for (const Light& light : scene.lights)
        out += light_text(light, bounds);
    return out + mesh_text(scene) + memory_text(scene) + "ok\n";
}

int check_command(const CheckOptions& options) {
    const std::string report = check_report(options);
    std::fputs(report.c_str(), stdout);
    return 0;
}

}  // namespace obscura
