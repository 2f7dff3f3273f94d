#pragma once
// Vertices that must move together: a file splits a vertex for each normal and texture coordinate that meets
// there, and the surface tears where the copies do not get the same disparity, bit for bit.

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "stereo/map_projection.h"

namespace obscura {

struct SurfacePoint {
    Vec3f position;            ///< world, metres
    std::uint32_t object = 0;  ///< of its triangles: nothing_seen where it has none; of several the first's
    std::uint32_t component = 0;  ///< likewise
    MapPoint map;
    float change_px = 0;  ///< optimised minus original disparity
    bool seen = false;    ///< the map shows it
};

struct SurfacePoints {
    std::vector<SurfacePoint> points;      ///< by their first vertex
    std::vector<std::uint32_t> of_vertex;  ///< per vertex: its point
};

/// One point for vertices that stand at one position and have triangles of one object, or of one connected
/// component: solids that merely touch may part, the surface of none may tear. Changes are not yet filled.
SurfacePoints surface_points(const Mesh& mesh, const MapProjection& projection, const Exec& exec);

/// Makes one of points at one position whose changes differ by no more than `within_px`: solids that touch
/// and were not told to part. Each would follow the map as well alone, but not to the bit, and between the
/// two an eye would see what is behind. What is seen counts before what is guessed, of both kinds the mean.
void join_touching(const Mesh& mesh, double within_px, SurfacePoints& surface);

}  // namespace obscura
