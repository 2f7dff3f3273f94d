#pragma once
// From the checked text of an OBJ file to a mesh.

#include <vector>

#include "app/scene/obj_text.h"
#include "core/mesh.h"
#include "core/topology.h"

namespace obscura {

/// A mesh as an OBJ text describes it.
struct ObjMesh {
    Mesh mesh;     ///< about `origin`
    Vec3d origin;  ///< whole numbers; add it for the file's own frame
    TopologyReport topology;
    std::vector<bool>
        without_uv;  ///< triangle by triangle, whether a corner has no vt; empty: none lacks one
    std::size_t merged =
        0;  ///< triangles whose corners differ in the file, but not as floats about the origin
};

/// Where floats count from, so that they are fine enough for a mesh: 0 along axes whose numbers lie near 0 or
/// on both sides of it, else a whole number in their middle. Surveyors' coordinates have seven digits before
/// the point, which leaves half a metre to a float.
Vec3d origin_of(const ObjText& text);

/// Triangles of all faces in file order: polygons are cut by triangulate_polygon(), corners that agree in
/// position, texture coordinate and normal share a vertex, unused elements are dropped. Mesh::material is
/// material_names' index, material_names.size() for faces before any usemtl. Objects without faces are left
/// out; faces before any o belong to one called `name`. uvs are filled if any corner has one (0 for the
/// others). Positions are rounded to floats about origin_of(). Topology is analysed on the file's own
/// position indices; normals are the file's, made unit, and compute_normals() fills the gaps.
ObjMesh build_obj_mesh(const ObjText& text, const std::string& name, double crease_angle_deg);

}  // namespace obscura
