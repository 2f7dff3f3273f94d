#pragma once
// The whole way from a scene and its edits to two pictures, every step kept for those who want to look.
//
//   scene -> middle view -> system of edits -> solution -> moved triangles -> two eyes
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018 (thesis, figure 4.2).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/pair/eyes.h"
#include "app/pair/realised.h"
#include "app/scene/scene.h"
#include "app/scene/stereo_settings.h"
#include "core/isa.h"
#include "stereo/conflict.h"
#include "stereo/edit.h"
#include "stereo/middle_view.h"
#include "stereo/moved_mesh.h"
#include "stereo/solver/solver.h"

namespace obscura {

/// Wall-clock seconds.
struct StereoTimes {
    double view_s = 0;      ///< the middle view, and finding its margin
    double edit_s = 0;      ///< edits into a system, conflicts; reducing it
    double solve_s = 0;     ///< warm start included
    double upsample_s = 0;  ///< of a solution of lower resolution
    double mesh_s = 0;      ///< vertices' changes and tessellation
    double render_s = 0;    ///< both eyes: shadows, tiles, glare, and the middle's picture if wanted
    double measure_s = 0;   ///< realised disparity
    double total_s = 0;
};

/// How much the change of disparity (optimised minus original) of what both frames show differs from frame to
/// frame: how steady static surfaces stay beside what the camera's own way does to them.
struct TemporalChange {
    DisparityError error;  ///< `within`: at most StereoPairOptions::steady_px
};

struct StereoPairOptions {
    FrameOptions channels;    ///< of both eyes' frames; progress of all; cancel; no crop
    bool measure = true;      ///< realised disparity
    bool pictures = true;     ///< false: only the map; the rest stays empty
    double steady_px = 0.25;  ///< of TemporalChange
};

struct StereoPair {
    MiddleView view;          ///< full resolution
    EditedSystem edited;      ///< of that; without edits where settings ask for a remap
    MiddleView reduced_view;  ///< what was solved where it was not that, map_scale > 1; else empty
    DisparitySystem reduced_system;
    Solution solution;       ///< of what was solved; a remap's curve is taken for solved
    bool warm = false;       ///< began at the last frame's
    DisparityMap optimised;  ///< full resolution, size of `view`
    MovedMesh moved;
    ReprojectStats reprojection;
    EyeFrames eyes;
    RealisedDisparity realised;
    DisparityError left_error, right_error;  ///< picture_error() of both eyes
    std::optional<TemporalChange> temporal;  ///< against the frame before
    StereoTimes times;
    std::int64_t bytes = 0;  ///< estimate, checked before the work and again with the moved triangles
    bool complete = false;   ///< false: cancelled
};

/// What the frames of a sequence share, and edits of one frame: the mesh stays, as in FrameCache.
struct StereoCache {
    struct Last {
        MiddleView view;  ///< of the solution's resolution
        DisparityMap solution;
        MiddleView full_view;
        DisparityMap optimised;
        Camera camera;
    };
    EyesCache eyes;
    std::optional<Last> last;  ///< where the next solve starts
    SolverCache solver;
    void forget() { *this = StereoCache{}; }
};

/// Makes the pair of `scene` at the size of scene.render. Throws UsageError for cameras without perspective,
/// LimitError for what does not fit scene.limits. The same bits for any exec, from an equal cache.
void render_stereo_pair(const Scene& scene, const StereoSettings& settings, const StereoPairOptions& options,
                        const Exec& exec, StereoCache& cache, StereoPair& pair);

/// What is still wrong with the map that the pictures show; EditedSystem has what the edits alone would do.
Conflicts remaining_conflicts(const Scene& scene, const StereoSettings& settings, const StereoPair& pair,
                              const Exec& exec);

/// Bytes that a pair of `scene` takes at once beside what estimate_memory(scene) tells, when moving leaves
/// `triangles` of them (0: a guess from the picture's size)
/// and the view has this margin (auto_margin: the settings', or a guess).
std::int64_t stereo_bytes(const Scene& scene, const StereoSettings& settings, std::int64_t triangles = 0,
                          int margin_px = auto_margin);

}  // namespace obscura
