#pragma once
// Aiming the views of a stack together: sheared, or off-axis, so that one plane keeps its texels in all of
// them.
//
// What lies in the plane then does not move from map to map, what lies near it little, and the octree finds
// the same depths again (measured in README.md). The off-axis frustum is the one of P. Heckbert, M. Herf,
// "Simulating Soft Shadows with Graphics Hardware", CMU-CS-97-104, 1997; the directional twin is a shear. All
// maps end at one near plane, parallel to the plane of focus: one that clipped in some maps only would make
// them differ.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/types.h"
#include "hierarchy/stack/light_samples.h"
#include "hierarchy/stack/stack_frame.h"

namespace obscura {

struct FocusParams {
    Vec3d plane_point{0, 0, 0};
    Vec3d plane_normal{0, 1, 0};  ///< to the light's side, not unit
    int resolution = 1024;        ///< texels a side: a power of two, to 2^16
    /// Of lights that stand somewhere: the near plane lies so far below the lowest sample, as a share of its
    /// height above the plane, or where the highest caster is, if that is lower.
    double near_share = 1.0 / 16;
};

/// The views of all samples.
struct FocusedViews {
    StackFrame frame;  ///< for points in the world
    std::vector<SliceView> slices;
    int resolution = 0;

    /// The map of sample k, as builders take it.
    LightView view(int k) const;
};

/// Whether views can be aimed at this plane: every sample stands above it, or its light falls on it at more
/// than about 1.1 degrees.
bool can_focus(const LightSamples& samples, const FocusParams& params);

/// The maps hold, of all that casts shadows below the near plane, all shadows on the plane: what lies outside
/// of them is lit. can_focus() must hold.
FocusedViews focused_views(const Mesh& mesh, const LightSamples& samples, const FocusParams& params);

/// The plane with this normal that has as much of what receives below as above it: through the median height
/// of the mesh's area, from the triangles that face the normal's side and are lower than `below`, metres
/// along the unit normal from the origin.
Vec3d median_plane_point(const Mesh& mesh, Vec3d normal, double below = 1e300);

/// The longest way, in texels, that anything of the mesh below the near plane moves from one map to the next.
double parallax_texels(const Mesh& mesh, const FocusedViews& views);

}  // namespace obscura
