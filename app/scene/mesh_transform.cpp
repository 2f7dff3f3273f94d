#include "app/scene/mesh_transform.h"

#include <utility>

#include "core/edges.h"
#include "core/num.h"
#include "core/planar_faces.h"

namespace obscura {
namespace {

/// Turn in the plane of axes a and b, a towards b.
Affine turn(int a, int b, double degrees) {
    const double c = num::cos_deg(degrees), s = num::sin_deg(degrees);
    Affine r;
    r.m[a][a] = c;
    r.m[a][b] = -s;
    r.m[b][a] = s;
    r.m[b][b] = c;
    return r;
}

Vec3d column(const Affine& map, int c) {
    return {map.m[0][c], map.m[1][c], map.m[2][c]};
}

}  // namespace

Affine placement(Vec3d scale, Vec3d rotate_deg, Vec3d translate_m) {
    const Affine stretch{{{scale.x, 0, 0, 0}, {0, scale.y, 0, 0}, {0, 0, scale.z, 0}}};
    const Affine move{{{1, 0, 0, translate_m.x}, {0, 1, 0, translate_m.y}, {0, 0, 1, translate_m.z}}};
    return move *
           (turn(0, 1, rotate_deg.z) * (turn(2, 0, rotate_deg.y) * (turn(1, 2, rotate_deg.x) * stretch)));
}

void transform_mesh(Mesh& mesh, const Affine& map) {
    if (map == Affine{}) return;
    const bool mirrors = determinant(map) < 0;
    // Adding 0 makes -0 a 0: equal positions shall have equal bits.
    for (Vec3f& p : mesh.positions)
        p = to_float(transform_point(map, to_double(p))) + Vec3f{};
    const Vec3d x = column(map, 0), y = column(map, 1), z = column(map, 2);
    const double side = mirrors ? -1.0 : 1.0;
    for (Vec3f& n : mesh.normals) {
        const Vec3d moved = cross(y, z) * static_cast<double>(n.x) + cross(z, x) * static_cast<double>(n.y) +
                            cross(x, y) * static_cast<double>(n.z);
        n = to_float(normalize(moved * side));
    }
    if (mirrors) {
        for (Triangle& t : mesh.triangles)
            std::swap(t.v[1], t.v[2]);
    }
    find_planar_faces(mesh, relabel(mesh.triangles, weld_positions(mesh.positions)));
}

void flip_faces(Mesh& mesh) {
    for (Triangle& t : mesh.triangles)
        std::swap(t.v[1], t.v[2]);
    for (Vec3f& n : mesh.normals)
        n = -n;
    find_planar_faces(mesh, relabel(mesh.triangles, weld_positions(mesh.positions)));
}

}  // namespace obscura
