#pragma once
// Scenes so small that their positions are texels and depths: world and map space are one.

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "raster/record.h"

namespace obscura {

/// The identity as a view of columns x rows texels: (x, y, z) is texel position x, y at depth z.
View texel_view(int columns, int rows);

/// One triangle, an open component.
Mesh one_triangle(Vec3f p, Vec3f q, Vec3f r);

/// The first record that setup_triangles() makes of `mesh`.
TriangleRecord first_record(const Mesh& mesh, const View& view, const Exec& exec);

}  // namespace obscura
