// What a stereo pair takes beside a frame.

#include <algorithm>

#include "app/frame/tile.h"
#include "app/glare/glare_margin.h"
#include "app/pair/pair.h"
#include "core/mesh_memory.h"
#include "raster/setup_memory.h"

namespace obscura {
namespace {

// Per pixel of the map. The middle view: depth, normal, three ids, disparity; it is there once more as the
// last frame's.
constexpr std::int64_t view_bytes = 4 + 12 + 3 * 4 + 4;
// The system (six maps, two masks), D~ and what finding conflicts keeps; the optimised map, and the last
// one.
constexpr std::int64_t system_bytes = 6 * 4 + 2 + 16 + 2 * 4;
// Vectors of the solver: eight on the finest level, a third more on all others together, and coefficients.
// Before a sky, while poles are taken out: the system once more, two maps in double, order and counts.
constexpr std::int64_t solver_bytes = (8 + 6) * 4 * 4 / 3 + 26 + 16 + 12 + 3;
// Per pixel of an eye's picture: radiance, the map of what it sees, codes while it is encoded.
constexpr std::int64_t eye_bytes = 12 + 16 + 24;

/// Triangles that moving leaves: the scene's own, and as many more as pixels that their tolerance asks to
/// follow. A model, not a bound: a smooth map asks for one in some dozens of pixels.
std::int64_t expected_triangles(const Scene& scene) {
    constexpr std::int64_t pixels_per_triangle = 16;
    return static_cast<std::int64_t>(scene.mesh.triangles.size()) +
           std::int64_t{scene.render.width} * scene.render.height / pixels_per_triangle;
}

/// The moved mesh with its tables, both eyes' positions, setups and lists of tiles, and the mesh of the eye
/// that is being set up. Every triangle has a plane of its own.
std::int64_t moved_bytes(std::int64_t triangles, std::int64_t vertices, const RenderSettings& render) {
    const MeshSize moved{vertices, triangles, triangles};
    const std::int64_t eyes =
        2 * (setup_bytes(moved) + bin_bytes(triangles, render.width, render.height, frame_tile_side) +
             vertices * std::int64_t{sizeof(Vec3f)});
    const std::int64_t sources = triangles * std::int64_t{sizeof(std::uint32_t)},
                       changes = vertices * std::int64_t{sizeof(float)};
    // While triangles are cut: themselves, their edges and who uses these, points, what each misses.
    constexpr std::int64_t cutting = 200;
    return 2 * mesh_bytes(moved) + surface_table_bytes(moved) + eyes + sources + changes +
           triangles * cutting;
}

}  // namespace

std::int64_t stereo_bytes(const Scene& scene, const StereoSettings& settings, std::int64_t triangles,
                          int margin_px) {
    const RenderSettings& render = scene.render;
    // An automatic margin is a quarter of the picture at most, but comfortable pairs have less than this.
    const std::int64_t margin =
        margin_px != auto_margin
            ? margin_px
            : (settings.margin_px == auto_margin ? render.width / 16 : settings.margin_px);
    const std::int64_t map = (render.width + 2 * margin) * render.height;
    const std::int64_t scale = std::max(settings.map_scale, 1);
    const std::int64_t solved = map / (scale * scale) + 1;
    const std::int64_t picture = std::int64_t{render.width} * render.height;
    const std::int64_t pictures = 2 * picture * eye_bytes + (settings.middle_picture ? map * eye_bytes : 0);
    const std::int64_t left = triangles == 0 ? expected_triangles(scene) : triangles;
    const auto own_triangles = static_cast<std::int64_t>(scene.mesh.triangles.size());
    // What cutting adds shares vertices: half as many as triangles.
    const std::int64_t vertices = static_cast<std::int64_t>(scene.mesh.positions.size()) +
                                  std::max<std::int64_t>(left - own_triangles, 0);
    return map * (2 * view_bytes + 8) + solved * (2 * view_bytes + system_bytes + solver_bytes) + pictures +
           moved_bytes(left, vertices, widened(render, glare_margin(scene)));
}

}  // namespace obscura
