#pragma once
// From the checked faces of a model file to a mesh.

#include <string>
#include <vector>

#include "app/models/indexed_faces.h"
#include "app/models/model.h"
#include "core/mesh.h"
#include "core/topology.h"

namespace obscura {

/// A mesh as a file's faces describe it.
struct FacesMesh {
    Mesh mesh;     ///< about `origin`
    Vec3d origin;  ///< whole numbers; add it for the file's own frame
    TopologyReport topology;
    std::vector<bool> without_uv;  ///< triangle by triangle, whether a corner has no texture coordinates;
                                   ///< empty: none lacks one
    /// Triangles whose corners differ in the file, but not as floats about the origin.
    std::size_t merged = 0;
};

/// Where floats count from, so that they are fine enough for a mesh: 0 along axes whose numbers lie near 0 or
/// on both sides of it, else a whole number in their middle. Surveyors' coordinates have seven digits before
/// the point, which leaves half a metre to a float.
Vec3d origin_of(const IndexedFaces& text);

/// Triangles of all faces in file order: polygons are cut by triangulate_polygon(), corners that agree in
/// position, texture coordinate and normal share a vertex, unused elements are dropped. Mesh::material is
/// material_names' index, material_names.size() for faces without one. Objects without faces are left out;
/// faces without an object belong to one called `name`. uvs are filled if any corner has one (0 for the
/// others). Positions are rounded to floats about origin_of(). Topology is analysed on the file's own
/// position indices; normals are the file's, made unit, and compute_normals() fills the gaps.
FacesMesh build_faces_mesh(const IndexedFaces& text, const std::string& name, double crease_angle_deg);

/// All of a model whose file has no materials: everything is "default". Its one object, where the faces name
/// none, is called as `file` is without its ending; notes tell when there are no triangles, or some collapse.
Model model_of_faces(const IndexedFaces& faces, const std::string& file, double crease_angle_deg);

/// Leaves the first forty notes, and how many more there were.
void keep_few(std::vector<std::string>& notes, const std::string& file);

/// The notes of a mesh without triangles, and of triangles that collapse.
void note_mesh(const FacesMesh& mesh, const std::string& file, std::vector<std::string>& notes);

}  // namespace obscura
