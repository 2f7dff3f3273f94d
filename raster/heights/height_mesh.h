#pragma once
// Elevation models as meshes: the surface that height_sweep.h shades, closed to a solid.

#include <cstdint>

#include "core/mesh.h"
#include "core/vec.h"
#include "raster/heights/height_field.h"

namespace obscura {

struct HeightMeshParams {
    Vec3d middle_m;       ///< where height 0 of the grid's middle stands; north is -Z
    double skirt_m = 10;  ///< how far the floor lies below the least height; > 0
};

/// Triangles that height_mesh() makes.
constexpr std::int64_t height_mesh_triangles(std::int64_t width, std::int64_t height) {
    const std::int64_t border = 2 * (width + height - 2);
    return 2 * (width - 1) * (height - 1) + 3 * border;
}

/// Bytes of the mesh that height_mesh() makes, with a material and an object for every triangle; while it is
/// made it takes less than twice that.
constexpr std::int64_t height_mesh_bytes(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t vertex = 2 * sizeof(Vec3f) + sizeof(Vec2f);
    constexpr std::int64_t triangle = sizeof(Triangle) + 4 * sizeof(std::uint32_t) + sizeof(Plane);
    return (width * height + 10 * (width + height)) * vertex +
           height_mesh_triangles(width, height) * triangle;
}

/// The field's triangles, walls along its border down to a level floor, and that: one closed component. All
/// that analyse_topology() fills is filled, from what a grid is: no two triangles are compared. Every
/// triangle is a planar face of its own. Normals of the ground are means of the triangles around a sample, by
/// area; walls and floor have their own. uvs have the samples at the middles of the texels of a texture of
/// width x height. A field of 2 x 2 samples or more.
Mesh height_mesh(const HeightField& field, const HeightMeshParams& params);

}  // namespace obscura
