#pragma once
// Where points of the scene lie in the middle view's map.

#include "core/scene.h"
#include "core/types.h"
#include "core/vec.h"
#include "stereo/middle_view.h"

namespace obscura {

/// A point of the map, homogeneous: column times z, row times z, z in metres along the view axis. Pixel (i,
/// j) covers columns [i, i + 1) and rows [j, j + 1). Finite for points beside and behind the camera, too.
struct MapPoint {
    double xz = 0, yz = 0, z = 0;
    double column() const { return xz / z; }
    double row() const { return yz / z; }
};

struct MapProjection {
    View view;                 ///< of the whole map, margins included
    Vec3d eye;                 ///< world
    Vec3d ray0, ray_x, ray_y;  ///< from the eye to (column, row) at 1 m: ray0 + column ray_x + row ray_y
    double focal_px = 0;
    double near_m = 0;
    MapPoint project(Vec3f world) const;
    Vec3d ray(double column, double row) const { return ray0 + ray_x * column + ray_y * row; }
    /// Whether it has a place on the map. Nothing before near_m is drawn; triangles that reach behind the
    /// camera are cut at cut_m(), so that rounding leaves the cut on the safe side of both.
    bool in_front(const MapPoint& p) const { return p.z >= 0.5 * near_m; }
    double cut_m() const { return 0.75 * near_m; }
    /// Whether the map reaches there. What lies beside it, or behind the camera, no eye sees.
    bool on_map(const MapPoint& p) const {
        return in_front(p) && p.xz >= 0 && p.yz >= 0 && p.xz <= view.width * p.z && p.yz <= view.height * p.z;
    }
};

/// CHECKs that the camera is perspective and the view at full resolution.
MapProjection map_projection(const Camera& camera, const MiddleView& view);

}  // namespace obscura
