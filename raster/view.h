#pragma once
// Views: how cameras and lights look at the world (see View in core/types.h).

#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "core/types.h"

namespace obscura {

/// Axis-aligned box; empty when low > high.
struct Bounds {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    bool empty() const { return low.x > high.x; }
};
Bounds bounds_of(const Mesh& mesh);

/// Orthographic view along `direction` (unit, the way the light travels) that just holds `bounds`:
/// resolution x resolution square texels. Depth 0 and 1 lie a little outside the bounds.
LightView orthographic_light_view(const Bounds& bounds, Vec3d direction, int resolution);

/// Extent of what casts shadows along the axes of parallel light, metres: right and up of
/// look_basis(direction, +Y), and forward.
Bounds caster_box(const Mesh& mesh, Vec3d direction);

/// Orthographic view along `direction` that just holds `box`, given along the light's axes: resolution x
/// resolution texels, which need not be square: as much longer one way as the box is, up to 16 times. Around
/// the box lies one texel of margin. Depth 0 and 1 lie a little outside.
LightView fitted_light_view(const Bounds& box, Vec3d direction, int resolution);

/// Perspective view from `position` along `direction` with full angle `angle_deg` in (0, 180) both ways.
LightView perspective_light_view(Vec3d position, Vec3d direction, double angle_deg, double near_m,
                                 double far_m, int resolution);

/// The same by the tangent of half the angle.
LightView tangent_light_view(Vec3d position, Vec3d direction, double tangent, double near_m, double far_m,
                             int resolution);

/// How much wider the tangent of half the angle must be for `margin_texels` around what it was meant for:
/// resolution / (resolution - 2 margin_texels).
double margin_factor(int resolution, int margin_texels);

/// The six faces of a cube around `position`, in the order +X -X +Y -Y +Z -Z: 90 degrees each and
/// `margin_texels` more on every side, so that filter kernels at a face's border find texels of their own
/// face.
std::vector<LightView> cube_light_views(Vec3d position, double near_m, double far_m, int resolution,
                                        int margin_texels);
/// Which of the six faces sees direction d.
int cube_face(Vec3f d);

/// Depth range of orthographic cameras, from the near plane: far beyond any scene; floats stay dense there.
constexpr double orthographic_camera_range_m = 1e6;

/// The camera's view of a width x height picture (Z = -near/z for perspective, else (z - near)
/// / orthographic_camera_range_m): nothing nearer than camera.near_m is in it.
View camera_view(const Camera& camera, int width, int height);

/// Orthonormal right, up, forward; `up` may not be parallel to `forward` (another up is then chosen).
struct Basis {
    Vec3d right, up, forward;
};
Basis look_basis(Vec3d forward, Vec3d up);

/// Position in map space: (X, Y, Z), X and Y in texels. w <= 0 gives points behind the viewer.
Vec3d to_map_space(const View& view, Vec3d world);

}  // namespace obscura
