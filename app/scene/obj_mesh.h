#pragma once
// From the checked text of an OBJ file to a mesh.

#include "app/scene/obj_text.h"
#include "core/mesh.h"
#include "core/topology.h"

namespace obscura {

/// Triangles of all faces in file order: polygons are cut by triangulate_polygon(), corners that agree in
/// position, texture coordinate and normal share a vertex, unused elements are dropped. Mesh::material is
/// material_names' index, material_names.size() for faces before any usemtl. Objects without faces are left
/// out; faces before any o belong to one called `name`. uvs are filled if any corner has one (0 for the
/// others). Topology is analysed on the file's own position indices; normals are the file's, made unit, and
/// compute_normals() fills the gaps. `report` receives the topology report.
Mesh build_obj_mesh(const ObjText& text, const std::string& name, double crease_angle_deg,
                    TopologyReport& report);

}  // namespace obscura
