#include "app/frame/memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/frame/glare_memory.h"
#include "app/frame/lamp_pixels.h"
#include "app/frame/needed_texels.h"
#include "app/frame/tile.h"
#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "app/scene/shapes.h"
#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/facets.h"
#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"
#include "raster/layer_tile.h"
#include "raster/surface.h"

namespace obscura {
namespace {

constexpr std::int64_t vertex_bytes = sizeof(Vec3f) * 2 + sizeof(Vec2f);
constexpr std::int64_t triangle_bytes = sizeof(Triangle) + 4 * sizeof(std::uint32_t) + sizeof(Plane);
// Tiles resolve their samples at once: a pixel keeps its radiance and channels, and its codes while they are
// encoded (raw, filtered, compressed).
constexpr std::int64_t pixel_bytes = 48 + 24;
constexpr std::int64_t depth_bytes = 4;

std::int64_t picture_bytes(const RenderSettings& render) {
    return std::int64_t{render.width} * render.height * pixel_bytes;
}

/// Nodes of one view's tree. A model, not a bound: they grow with the length of the outlines on the map, that
/// is with its side; 31 to 32 per texel of the side in the closed city of Scandolo, Bauszat and Eisemann
/// 2016, more where there are many leaves. Construction stops at the limit. Nothing where the picture decides
/// the resolution: it is found later.
std::int64_t expected_nodes(const ShadowSettings& shadow) {
    constexpr std::int64_t nodes_per_side = 32;
    return std::min(nodes_per_side * shadow.resolution,
                    std::int64_t{shadow.resolution} * shadow.resolution * 4 / 3);
}

/// Serialised: a leaf or an empty node takes 4 bytes, a full one 8.
constexpr std::int64_t node_bytes = 6;

/// One view at work: vertices, records and planes, lists of tiles (the counts of every block of triangles,
/// and the entries). Most triangles lie in one tile; we allow eight each, and every record in every tile
/// where that is less.
std::int64_t view_bytes(const Mesh& mesh, std::int64_t width, std::int64_t height) {
    const auto vertices = static_cast<std::int64_t>(mesh.positions.size());
    const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
    const auto faces = static_cast<std::int64_t>(mesh.faces.size());
    const std::int64_t tiles = ((width + frame_tile_side - 1) / frame_tile_side) *
                               ((height + frame_tile_side - 1) / frame_tile_side);
    const std::int64_t blocks = std::min<std::int64_t>(triangles / 4096 + 1, 64);
    const std::int64_t entries = triangles * std::min<std::int64_t>(tiles, 8);
    constexpr std::int64_t plane_bytes = sizeof(DepthPlane) + 2 * sizeof(std::int32_t);
    constexpr std::int64_t entry_bytes = sizeof(std::uint32_t);
    return vertices * std::int64_t{sizeof(MapVertex)} + triangles * std::int64_t{sizeof(TriangleRecord)} +
           faces * plane_bytes + (tiles * (blocks + 1) + entries) * entry_bytes;
}

/// What the threads hold: a tile each, and in shadow maps the layers of one. Layers begin at 12 per texel (8,
/// and half as many again) and grow only where more surfaces lie behind one another.
std::int64_t thread_bytes(bool shadows) {
    constexpr std::int64_t layer_bytes =
        std::int64_t{layer_tile_texels} * layers_in_place * 3 / 2 * (sizeof(LayerKey) + sizeof(std::int32_t));
    return hardware_threads() * (std::int64_t{sizeof(TileWork)} + (shadows ? layer_bytes : 0));
}

/// A compressed map under construction: setup without tiles, a facet per triangle and what threads list of
/// them, and the nodes of one view's tree, twice (parts are joined).
std::int64_t construction_bytes(const Mesh& mesh, const ShadowSettings& shadow) {
    const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
    const std::int64_t lists = (hardware_threads() + 1) * 2 * std::int64_t{sizeof(Listed)};
    return view_bytes(mesh, 0, 0) + triangles * (std::int64_t{sizeof(Facet)} + lists) +
           2 * expected_nodes(shadow) * std::int64_t{sizeof(MultiresNode)};
}

/// Lists of what a frame looks up (scope "frame"): by tile, joined, and while the joined one grows.
std::int64_t needed_bytes(const RenderSettings& render, const ShadowSettings& shadow) {
    if (shadow.method != ShadowMethod::compressed || shadow.scope != ShadowScope::frame) return 0;
    // A kernel reaches into four blocks at most; on coarser levels each tap may be a square of its own.
    const std::int64_t per_sample =
        shadow.filter == ShadowFilter::pcf ? 4 : 2 * std::int64_t{shadow.filter_px} * shadow.filter_px;
    const std::int64_t samples = std::int64_t{render.width} * render.height * render.samples;
    return std::min(samples * per_sample, most_needed_squares) * 3 * std::int64_t{sizeof(std::uint64_t)};
}

/// Setup of the camera and of one light at a time, and tables of surfaces.
std::int64_t work_bytes(const Scene& scene) {
    const Mesh& mesh = scene.mesh;
    std::int64_t bytes = view_bytes(mesh, scene.render.width, scene.render.height) +
                         static_cast<std::int64_t>(mesh.triangles.size() * sizeof(SurfaceTriangle) +
                                                   mesh.positions.size() * sizeof(SurfaceVertex));
    std::int64_t light = 0;
    for (const SceneLight& l : scene.lights) {
        bytes += needed_bytes(scene.render, l.shadow);
        if (l.shadow.method == ShadowMethod::map) {
            light = std::max(light, view_bytes(mesh, l.shadow.resolution, l.shadow.resolution));
        } else if (l.shadow.method == ShadowMethod::compressed) {
            light = std::max(light, construction_bytes(mesh, l.shadow));
        }
    }
    return bytes + light + thread_bytes(light > 0);
}

double mib(std::int64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

int shadow_map_count(const SceneLight& light) {
    if (light.shadow.method == ShadowMethod::none) return 0;
    return shadow_view_count(light.light.kind);
}

std::int64_t shadow_map_bytes(const SceneLight& light) {
    const ShadowSettings& s = light.shadow;
    const std::int64_t views = shadow_map_count(light);
    if (s.method == ShadowMethod::map) {
        return views * std::int64_t{s.resolution} * s.resolution * depth_bytes;
    }
    const std::int64_t top =
        s.resolution == auto_resolution ? 0 : std::int64_t{sizeof(TopNode)} << (2 * s.top_levels);
    return views * (expected_nodes(s) * node_bytes + top);
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
    for (const SceneLight& light : scene.lights)
        e.shadow_maps += shadow_map_bytes(light);
    e.frame = picture_bytes(scene.render) + work_bytes(scene) +
              glare_bytes(scene.optics, scene.render, lamp_count(scene));
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
    const RenderSettings render = render_settings_of(document);
    // Lamps are counted when their meshes are there.
    e.frame =
        picture_bytes(render) + glare_bytes(optics_of(document, scene_frames(document).first), render, 0);
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
