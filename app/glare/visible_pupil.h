#pragma once
// What the scene leaves of the lens's opening, as seen from a point of light.
//
// L. Scandolo: thesis, 2019, section 3.4.4: the geometry between light and lens is projected from the light's
// point onto the plane of the entrance pupil. Coverage is the rasterizer's: a texel is hidden when the line
// from the point to its centre meets a triangle.

#include <cstdint>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "core/image.h"
#include "core/mesh.h"

namespace obscura {

/// The entrance pupil: a square of the given side around the eye, across the viewing direction.
struct PupilPlane {
    Vec3d centre, right, down, forward;  ///< unit vectors; forward looks into the scene
    double side_m = 0;
    double near_m = 0;  ///< nothing nearer than this hides anything: the camera does not see it either
};
/// `offset_m`: of its centre from the camera's eye, world.
PupilPlane pupil_plane(const Camera& camera, double side_m, Vec3d offset_m = {});

/// Triangles that may come between the pupil and a ball that holds the points asked for.
std::vector<std::uint32_t> between(const Mesh& mesh, const PupilPlane& pupil, Vec3d centre, double radius);

/// size x size texels of the pupil, row 0 up: 1 where the light of `point` arrives, else 0. Surfaces within a
/// ten thousandth of the point's distance are the light itself and hide nothing. The point lies in front.
Image<std::uint8_t> visible_pupil(const Mesh& mesh, std::span<const std::uint32_t> triangles,
                                  const PupilPlane& pupil, Vec3d point, int size);

}  // namespace obscura
