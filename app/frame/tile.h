#pragma once
// One 64 x 64 tile of a frame, stage by stage: visibility, surface, textures, shadow lookups, shading,
// resolve. Between the stages lie plain buffers, so that a test, a lesson or a trace can stop there.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/frame/day_tile.h"
#include "app/frame/frame.h"
#include "app/frame/soft_light.h"
#include "app/frame/stack_tile.h"
#include "app/scene/scene.h"
#include "core/sky/sky_model.h"
#include "filters/pcf.h"
#include "raster/depth_map.h"
#include "raster/exact/exact.h"
#include "raster/gbuffer.h"
#include "raster/sample_pattern.h"
#include "raster/shade.h"

namespace obscura {

class ExactTile;
struct SurfaceLight;

/// A light that shines on this frame.
struct TileLight {
    ShadeLight shade;
    // Shadows looked up in a map or in trees, and those of the samples themselves. With both, light must pass
    // both: a tree of what stands still, the samples' own of what moves; or a day's of ground, and the
    // samples' own of what stands on it. With none, nothing casts any.
    std::optional<PcfLight> pcf;
    std::optional<ExactLight> exact;
    std::optional<DayLight> day;
    std::optional<StackLight> stack;  ///< of a light with a size: alone, in place of `shade`, too
    std::size_t scene_light = 0;      ///< index into Scene::lights
    std::size_t shadow = 0;           ///< and among those with shadows, when it casts some
    double solid_angle_sr = 0;        ///< of a part of the sky

    bool casts_shadows() const { return pcf || exact || day || stack; }
};

/// Everything the tiles of one frame have in common. Borrows; read only. The picture is the view; the tiles
/// are those of bins->region, which reaches past it on all sides by the margin that glare is taken from.
struct TileScene {
    const TriangleSetup* setup = nullptr;
    const TileBins* bins = nullptr;
    const Mesh* mesh = nullptr;
    const Mesh* casters = nullptr;  ///< what casts exact shadows: the scene's own, where `mesh` is moved, too
    View view;
    CameraRays rays;
    SurfaceMesh surface;
    std::vector<ShadeMaterial> materials;
    std::span<const Texture> textures;
    std::vector<TileLight> lights;
    std::vector<SoftLight> soft;     ///< lights with a size, which are not among `lights`
    const SoftPass* pass = nullptr;  ///< the tiles add what `lights` shed to a picture that is there
    ShadeSky sky;
    const SurfaceLight* sent = nullptr;   ///< what hides a part of the sky sends instead; null: nothing
    const SkyModel* sky_model = nullptr;  ///< what is seen behind everything; null: `sky`
    std::span<const SamplePosition> pattern;
    bool textured = false;  ///< some material has a texture

    /// Whether the pixel is the picture's, not one of its margin.
    bool in_picture(int x, int y) const { return x >= 0 && y >= 0 && x < view.width && y < view.height; }

    /// Lights that Frame::shadow is the mean of.
    int shadow_lights() const {
        const auto own =
            std::count_if(lights.begin(), lights.end(), [](const TileLight& l) { return l.casts_shadows(); });
        const auto sized =
            std::count_if(soft.begin(), soft.end(), [](const SoftLight& l) { return !l.is_sky; });
        return static_cast<int>(own + sized);
    }

    /// Whether the lights are parts of a sky and what hides them sends light instead.
    bool gathers() const { return sent != nullptr && pass != nullptr && pass->light->is_sky; }

    bool has_exact() const {
        return std::any_of(lights.begin(), lights.end(),
                           [](const TileLight& l) { return l.exact.has_value(); });
    }
};

/// Working memory of one tile: about 140 KiB, not initialised but for the last.
struct TileWork {
    alignas(64) float depth[frame_tile_side * frame_tile_side];
    alignas(64) std::uint32_t triangle[frame_tile_side * frame_tile_side];
    SurfaceBlock surface;
    ShadeBlock shade;
    alignas(64) float visibility[block_samples];
    alignas(64) float shadow_sum[block_samples];
    ShadeSent sent;
    alignas(64) float r[frame_tile_side * frame_tile_side];
    alignas(64) float g[frame_tile_side * frame_tile_side];
    alignas(64) float b[frame_tile_side * frame_tile_side];
    std::span<double> lookup_s;  ///< seconds in shadow lookups are added here, per light; empty: not measured
    ExactCounts exact_counts;    ///< of exact shadows, all lights
};

/// Stage 1: nearest triangle of one sample of every pixel of tile (column, row).
TileRect tile_visibility(const TileScene& scene, int column, int row, SamplePosition sample, Isa isa,
                         TileWork& work);

/// Stage 2: surfaces of the block of rows from first_row on.
void block_geometry(const TileScene& scene, const TileRect& tile, int first_row, Isa isa, TileWork& work);

/// Stages 2 and 3: surfaces and texels of the block of rows from first_row on.
void block_surface(const TileScene& scene, const TileRect& tile, int first_row, Isa isa, TileWork& work);

/// Samples of the block beyond its first `width` columns and `rows` rows count as not covered.
void uncover_outside(int width, int rows, SurfaceBlock& surface);

/// Stages 1 and 2 of tile `index` for one sample of every pixel; calls visit(tile, first_row) with the
/// surfaces of each block of rows in work.surface. Samples outside of the margin count as not covered.
template <class Visit>
void walk_blocks(const TileScene& scene, std::size_t index, SamplePosition sample, Isa isa, TileWork& work,
                 Visit&& visit) {
    const int columns = scene.bins->columns;
    const auto i = static_cast<int>(index);
    const Region inside = scene.bins->inside(index);
    const TileRect tile = tile_visibility(scene, i % columns, i / columns, sample, isa, work);
    for (int first_row = 0; first_row < inside.height; first_row += block_rows) {
        block_geometry(scene, tile, first_row, isa, work);
        uncover_outside(inside.width, inside.height - first_row, work.surface);
        visit(tile, first_row);
    }
}

/// The same, sample by sample: calls visit(x, y, at) for each pixel of the picture and its margin whose
/// sample is on a surface: sample `at` of work.surface.
template <class Visit>
void walk_tile(const TileScene& scene, std::size_t index, SamplePosition sample, Isa isa, TileWork& work,
               Visit&& visit) {
    walk_blocks(scene, index, sample, isa, work, [&](const TileRect& tile, int first_row) {
        for (int group = 0; group < block_groups; ++group) {
            for (std::uint32_t left = work.surface.covered[group]; left != 0; left &= left - 1) {
                const int at = group * 16 + std::countr_zero(left);
                visit(tile.x0 + at % frame_tile_side, tile.y0 + first_row + at / frame_tile_side, at);
            }
        }
    });
}

/// Where a block's exact shadows are: of the k-th sample that `tile` holds, from first_row on.
struct ExactBlock {
    const ExactTile* tile = nullptr;
    int k = 0, first_row = 0;
};

/// Stages 4 and 5: shadow lookups and shading. `shadow`: also sum visibilities into work.shadow_sum. `exact`:
/// of lights that have exact shadows.
void block_shade(const TileScene& scene, const ExactBlock& exact, Isa isa, bool shadow, TileWork& work);

/// All stages; writes the tile's pixels into `frame`. Returns the number of covered samples. `exact`: memory
/// for exact shadows, needed where a light has some.
std::int64_t render_tile(const TileScene& scene, int column, int row, const FrameOptions& options, Isa isa,
                         TileWork& work, ExactTile* exact, Frame& frame);

/// A pass (scene.pass): adds what its lights shed to the tile's pixels, and to frame.shadow.
void add_tile(const TileScene& scene, int column, int row, bool shadow, Isa isa, TileWork& work,
              ExactTile& exact, Frame& frame);

}  // namespace obscura
