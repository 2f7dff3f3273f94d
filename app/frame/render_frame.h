#pragma once
// From a scene to a frame: setup, shadows, tiles.

#include <optional>
#include <vector>

#include "app/frame/frame.h"
#include "app/frame/frame_sky.h"
#include "app/frame/light_shadow.h"
#include "app/frame/surface_light.h"
#include "app/frame/tile.h"
#include "app/glare/glare.h"
#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "hierarchy/codes/tree_file.h"
#include "raster/exact/casters.h"
#include "raster/surface.h"

namespace obscura {

/// What frames of one sequence share: kept between calls as long as mesh, materials and textures stay (only
/// camera, lights, sky and settings may change). Call forget() when they do not.
struct FrameCache {
    bool prepared = false;
    Bounds bounds;
    SurfaceTables surface;
    /// Of the lights with shadows, in scene order. One is kept while its light stays, colour aside; when it
    /// was built for one picture (scope "frame"), also only while the camera stays.
    std::vector<LightShadow> shadows;
    std::optional<FrameSky> sky;           ///< once the scene's is more than a gradient seen by everything
    std::optional<KeptSurfaceLight> sent;  ///< with bounces
    FileAccess access;                     ///< where shadow caches may lie
    std::optional<TreeFileKey> geometry;   ///< geometry_key() of the mesh, once a cache asks
    std::optional<KeptPsf> psf;            ///< of the lens, once something glared
    RasterScratch camera_scratch, light_scratch;
    CasterScratch caster_scratch;
    void forget() { *this = FrameCache{}; }
};

/// Renders scene.camera's picture, or the crop of it. Checks memory against scene.limits first (LimitError).
/// `frame` may hold an earlier frame: its memory is used again. The same bits for any exec, and a crop's are
/// those of the whole picture (shadows are made for the whole; with a lens so are the pixels, since light
/// comes from anywhere).
void render_frame(const Scene& scene, const FrameOptions& options, const Exec& exec, FrameCache& cache,
                  Frame& frame);

/// The same, nothing kept.
Frame render_frame(const Scene& scene, const FrameOptions& options = {}, const Exec& exec = {});

// The steps that come before the tiles, for traces, tests and lessons: these two, then prepare_shadows()
// (app/frame/shadows.h), which gives the lights their shadows.

/// Fills the cache's tables of surface triangles. Adds to `stats`.
void prepare_scene(const Scene& scene, const Exec& exec, FrameCache& cache, FrameStats& stats);

/// Sets the camera's triangles up, with the margin that glare needs, and gathers what the tiles read; borrows
/// from scene and cache. The lights have no shadows yet.
TileScene prepare_tiles(const Scene& scene, const Exec& exec, FrameCache& cache);

// Its parts, for pictures that are wider than the scene's own or of moved geometry.

/// What the tiles of a width x height picture read beside geometry: the camera's rays (a wider picture shows
/// more to either side), materials, lights without shadows, sky.
TileScene tile_scene(const Scene& scene, int width, int height, int samples);

/// Sets `mesh` up for the view of `tiles`, which borrows from scratch, and for so many pixels around it:
/// theirs lie at negative places and past its width and height.
void set_up_triangles(const Mesh& mesh, const Exec& exec, RasterScratch& scratch, TileScene& tiles,
                      int margin_px = 0);

/// The steps after them: the pixels of prepared tiles, all or options.crop's, with glare. frame.stats.lights
/// are told already.
void render_picture(const Scene& scene, const TileScene& tiles, const FrameOptions& options, const Exec& exec,
                    std::optional<KeptPsf>& psf, Frame& frame);

}  // namespace obscura
