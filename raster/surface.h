#pragma once
// What the surface stage keeps of a mesh and its materials.

#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/scene.h"
#include "raster/gbuffer.h"

namespace obscura {

/// A mesh and the flags of its materials, ready for the surface stage.
struct SurfaceTables {
    Buffer<SurfaceTriangle> triangles;
    Buffer<SurfaceVertex> vertices;
};

/// Tables of `mesh`, which needs its topology and normals; materials are indexed by mesh.material. They
/// depend on neither camera nor lights.
void surface_tables(const Mesh& mesh, const std::vector<Material>& materials, const Exec& exec,
                    SurfaceTables& out);

/// Pointers into `mesh` and `tables`, which must outlive the result.
SurfaceMesh surface_mesh(const Mesh& mesh, const SurfaceTables& tables);

/// Barycentric weights of corners 1 and 2 (corner 0 has the rest), each in [0, 1], together at most 1.
struct Barycentrics {
    float b1 = 0, b2 = 0;
};

namespace ref {
/// Where the ray origin + z dir meets the plane of the triangle, clamped to the triangle; corners are
/// relative to the same point as the origin.
Barycentrics barycentrics(const Vec3f (&corner)[3], Vec3f origin, Vec3f dir);
}  // namespace ref

}  // namespace obscura
