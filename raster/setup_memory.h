#pragma once
// What setting up a view takes: setup_triangles(), bin_records() and surface_tables().

#include <algorithm>
#include <cstdint>

#include "core/mesh_memory.h"
#include "raster/map_vertex.h"
#include "raster/setup.h"
#include "raster/surface.h"

namespace obscura {

/// Vertices, records (clipping adds some where a triangle crosses the near plane), planes.
constexpr std::int64_t setup_bytes(const MeshSize& mesh) {
    constexpr std::int64_t face = sizeof(DepthPlane) + 2 * sizeof(std::int32_t);
    return mesh.vertices * std::int64_t{sizeof(MapVertex)} +
           mesh.triangles * std::int64_t{sizeof(TriangleRecord)} + mesh.faces * face;
}

/// Lists of tiles and the counts of every block of triangles. Most triangles lie in one tile: two entries
/// each are expected, more where triangles are larger than tiles.
constexpr std::int64_t bin_bytes(std::int64_t triangles, std::int64_t width, std::int64_t height,
                                 std::int64_t tile) {
    const std::int64_t tiles = ((width + tile - 1) / tile) * ((height + tile - 1) / tile);
    const std::int64_t blocks = std::min<std::int64_t>(triangles / 4096 + 1, 64);
    const std::int64_t entries = triangles * std::min<std::int64_t>(tiles, 2);
    return (tiles * (blocks + 1) + entries) * std::int64_t{sizeof(std::uint32_t)};
}

constexpr std::int64_t surface_table_bytes(const MeshSize& mesh) {
    return mesh.triangles * std::int64_t{sizeof(SurfaceTriangle)} +
           mesh.vertices * std::int64_t{sizeof(SurfaceVertex)};
}

}  // namespace obscura
