#include "lessons/texel_space.h"

#include "core/error.h"
#include "core/topology.h"
#include "raster/setup.h"

namespace obscura {

View texel_view(int columns, int rows) {
    View view;
    view.width = columns;
    view.height = rows;
    return view;
}

Mesh one_triangle(Vec3f p, Vec3f q, Vec3f r) {
    Mesh mesh;
    mesh.positions = {p, q, r};
    mesh.triangles = {{{0, 1, 2}}};
    analyse_topology(mesh);
    return mesh;
}

TriangleRecord first_record(const Mesh& mesh, const View& view, const Exec& exec) {
    TriangleSetup setup;
    setup_triangles(mesh, view, {}, exec, setup);
    CHECK(!setup.blocks.empty() && setup.blocks.front().count > 0);
    return setup.records[setup.blocks.front().begin];
}

}  // namespace obscura
