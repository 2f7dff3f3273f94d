#pragma once
// Both eyes' pictures of a scene whose surfaces an edited disparity map has moved.
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis 4.3.4,
// "Disparity-aware rendering"): every vertex is drawn from the middle camera, half its disparity to either
// side. What the paper leaves open is how the two pictures are shaded. Ours share everything that light does:
// a sample is shaded at the point of the surface where it truly is, towards the eye in the middle, with the
// lights and shadows there; moved triangles decide only where it is seen, what hides it, and how large a
// pixel is on its texture. Highlights and shadows so lie at the depth of the surface that they lie on, and
// follow its edits.

#include <optional>
#include <vector>

#include "app/frame/render_frame.h"
#include "app/scene/scene.h"
#include "app/scene/stereo_settings.h"
#include "core/isa.h"
#include "raster/surface.h"
#include "stereo/middle_view.h"
#include "stereo/moved_mesh.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// An eye's geometry, ready for tiles.
struct EyeStage {
    std::vector<Vec3f> seen;  ///< eye_positions()
    RasterScratch scratch;
};

/// Sets up what one eye sees. stage.seen: where it sees the vertices of `moved`, from the middle camera.
/// `tables`: surface_tables() of moved.mesh. Lights have no shadows yet. Borrows from everything.
TileScene eye_tiles(const Scene& scene, const MovedMesh& moved, const SurfaceTables& tables,
                    const StereoRig& rig, Eye eye, const Exec& exec, EyeStage& stage);

/// What an eye sees through the centres of its pixels. Disparities are of the pictures as they are: where
/// the point stands in the left one minus where in the right one.
struct EyeMap {
    Image<float> depth_m;           ///< infinity where nothing is
    Image<std::uint32_t> triangle;  ///< of the scene's mesh; nothing_seen where nothing is
    DisparityMap disparity;         ///< as edited; of infinity where nothing is
    DisparityMap original;          ///< as the rig alone has it
    std::int64_t cracks = 0;  ///< pixels where nothing is, between two of one triangle or of two with an edge
                              ///< in common: what a torn surface would leave
};
EyeMap eye_map(const Scene& scene, const TileScene& tiles, const MovedMesh& moved, const StereoRig& rig,
               Eye eye, const Exec& exec);

/// What pairs of one sequence share.
struct EyesCache {
    FrameCache frame;      ///< of the scene: surfaces, shadows, the lens's pattern
    SurfaceTables tables;  ///< of the moved mesh
    EyeStage left, right;
    RasterScratch middle;
};

struct EyeFrames {
    Frame left, right;
    std::optional<Frame> middle;  ///< with margins
    EyeMap left_map, right_map;
    FrameStats shared;  ///< what all pictures took together before their tiles, and notices
};

/// Where the eyes see the vertices of a moved mesh.
struct EyePositions {
    std::vector<Vec3f> left, right;
};

struct EyesWanted {
    EyeShading shading = EyeShading::eyes;
    FrameOptions channels;      ///< without crop
    int middle_margin_px = -1;  ///< >= 0: the middle camera's picture, too, with so many columns more
};

/// Renders both eyes' pictures, scene.render in size. Shadows are made once for all of them (what eyes see
/// past an edge is asked for, too); glare is added to each. False when cancelled. Memory is the caller's to
/// check: `other_bytes` are not for shadows. The same bits for any exec.
bool render_eyes(const Scene& scene, const MovedMesh& moved, EyePositions positions, const StereoRig& rig,
                 const EyesWanted& wanted, std::int64_t other_bytes, const Exec& exec, EyesCache& cache,
                 EyeFrames& out);

}  // namespace obscura
