#pragma once
// The scene's triangles, finer where needed, with the change of disparity that every vertex carries (thesis
// 4.3.4, "Disparity reprojection" and "Disparity-aware rendering").

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

/// A conforming refinement of a mesh. Its triangles lie in those of the original; objects, materials, corner
/// attributes are inherited. Vertices are shared as in the original: no T-junctions.
struct MovedMesh {
    Mesh mesh;  ///< with material, object, component, face, faces of the original's. What is closed stays
                ///< closed; Component::open_edges counts those of the original
    std::vector<std::uint32_t> source;  ///< per triangle: the original's
    std::vector<float> change_px;       ///< per vertex: optimised minus original disparity
};

struct ReprojectParams {
    double tolerance_px = 0.1;  ///< piecewise-linear disparity against the map, at visible pixels
    int max_splits = 20;        ///< bisections of one triangle; a few more where neighbours ask for it
    std::int64_t max_triangles = 50'000'000;  ///< no cut is begun beyond
    int radius_px = 2;                        ///< of the cross-bilateral gather
};

struct ReprojectStats {
    /// Points, copies of a vertex counted once, those of cuts included. Hidden: by the difference rule.
    std::int64_t vertices_seen = 0, vertices_hidden = 0;
    std::int64_t triangles_in = 0, triangles_out = 0;
    int rounds = 0;
    double within = 0;  ///< share of visible pixels within the tolerance, as tessellated
};

/// Gathers vertex changes from `optimised` minus view.disparity and refines until the tolerance holds. The
/// view is of full resolution and of `mesh`; the map is finite where it shows something. The same for any
/// exec.
MovedMesh moved_mesh(const Mesh& mesh, const Camera& camera, const MiddleView& view,
                     const DisparityMap& optimised, const ReprojectParams& params, const Exec& exec,
                     ReprojectStats& stats);

enum class Eye { left, right };

/// Positions as one eye sees them, as if they stood before the middle camera: at the same depth, moved along
/// the camera's right by +half (left eye) or -half (right eye) of the disparity times z / focal_px, so that
/// they project half a disparity away. Finite and linear in z behind the camera too.
std::vector<Vec3f> eye_positions(const MovedMesh& moved, const Camera& camera, int picture_height,
                                 const StereoRig& rig, Eye eye);

}  // namespace obscura
