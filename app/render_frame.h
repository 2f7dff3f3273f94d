#pragma once
// From a scene to a frame: shadow maps, setup, tiles.

#include <vector>

#include "app/frame.h"
#include "app/frame_tile.h"
#include "core/isa.h"
#include "core/scene.h"
#include "raster/shadow_map.h"
#include "raster/surface.h"

namespace obscura {

/// What frames of one sequence share: kept between calls as long as mesh, materials and textures stay (only
/// camera, lights, sky and settings may change). Call forget() when they do not.
struct FrameCache {
    struct Shadow {
        Light light;  ///< the map is kept while this stays, colour aside
        ShadowMap map;
    };
    bool prepared = false;
    Bounds bounds;
    SurfaceTables surface;
    std::vector<Shadow> shadows;  ///< of the lights with shadows, in scene order
    RasterScratch camera_scratch, light_scratch;
    void forget() { *this = FrameCache{}; }
};

/// Renders scene.camera's picture, or the crop of it. Checks memory against scene.limits first (LimitError).
/// `frame` may hold an earlier frame: its memory is used again. The same bits for any exec.
void render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec, FrameCache& cache,
                  Frame& frame);

/// The same, nothing kept.
Frame render_frame(const Scene& scene, const FrameOptions& options = {}, const Exec& exec = {});

// The two steps that come before the tiles, for traces, tests and lessons.

/// Fills the cache: surface triangles and shadow maps. Adds to `stats`. False when `cancel` was set before
/// the maps were done.
bool prepare_scene(const Scene& scene, const Exec& exec, FrameCache& cache, FrameStats& stats,
                   const std::atomic<bool>* cancel = nullptr);

/// Sets the camera's triangles up and gathers what the tiles read; borrows from scene and cache.
TileScene prepare_tiles(const Scene& scene, const Exec& exec, FrameCache& cache);

}  // namespace obscura
