#pragma once
// Primitive shapes. Every solid is closed: once equal positions are welded, each edge is walked once in each
// direction, counter-clockwise seen from outside, without T-junctions or triangles of no area. Vertices are
// doubled where the surface has a crease (normals) or a texture seam (uvs); the doubles have equal bits.
// uvs are in metres, so that a tiling texture keeps its size; material and object are 0 throughout.

#include <vector>

#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

/// Axis-aligned box from its least to its greatest corner, metres, least < greatest on every axis. 12
/// triangles.
Mesh box(Vec3d least, Vec3d greatest);
/// Box of this size (each > 0) with its centre at the origin.
Mesh box(Vec3d size);

/// Open level sheet that faces +Y at y = 0 with its centre at the origin: cells_x by cells_z (each >= 1)
/// squares of two triangles. The only primitive that is not a solid.
Mesh plane(double width_m, double depth_m, int cells_x = 1, int cells_z = 1);

/// Sphere about the origin: `segments` >= 3 around +Y, `rings` >= 2 from pole to pole; smooth normals.
Mesh sphere(double radius_m, int segments = 64, int rings = 32);

/// Upright cylinder about +Y with its base at y = 0 and flat caps; `segments` >= 3.
Mesh cylinder(double radius_m, double height_m, int segments = 48);
/// The same with a radius at each end; a radius of 0 makes a cone.
Mesh frustum(double base_radius_m, double top_radius_m, double height_m, int segments = 48);

/// Solid of revolution about +Y. The profile is a chain of (radius, y), walked upwards along the outside:
/// either from the axis to the axis (first and last radius 0), or back to its own first point (a ring such as
/// a torus). Corners sharper than crease_deg stay sharp. Neighbouring points differ; only ends may lie on the
/// axis.
Mesh lathe(const std::vector<Vec2d>& profile, int segments = 48, double crease_deg = 35);

/// Ring of radius_m about +Y with a round section of tube_radius_m < radius_m.
Mesh torus(double radius_m, double tube_radius_m, int segments = 48, int sides = 16);

/// Prism: the simple polygon `outline` (counter-clockwise in x, y; may be concave, no three corners in line)
/// pushed from z = back to z = front > back. Outline corners flatter than crease_deg are shaded smooth.
Mesh extrude(const std::vector<Vec2d>& outline, double back, double front, double crease_deg = 35);

/// Solid between two chains of as many points, pushed from z = back to z = front: `lower` and `upper` run
/// towards +x side by side (the chains of an arch: intrados and extrados, or intrados and a level top), and
/// matching points are joined by quads.
Mesh strip(const std::vector<Vec2d>& lower, const std::vector<Vec2d>& upper, double back, double front,
           double crease_deg = 35);

/// One station of a tube.
struct TubePoint {
    Vec3d at;
    double radius_m = 0.01;
};
/// Round tube along a path of at least two points, closed by flat caps; `sides` >= 3. The path must not
/// double back on itself within a radius.
Mesh tube(const std::vector<TubePoint>& path, int sides = 8);

/// A moulding: the profile polygon (counter-clockwise in (outward, up), without three corners in line)
/// carried around the rectangle width_m x depth_m that stands about the origin, with mitred corners.
/// `outward` 0 is the rectangle itself, negative values lie inside it.
Mesh moulding(const std::vector<Vec2d>& profile, double width_m, double depth_m);

}  // namespace obscura
