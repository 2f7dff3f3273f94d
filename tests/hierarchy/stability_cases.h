#pragma once
// What shadow trees find hard, small enough to be understood.

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "app/models/obj_file.h"
#include "bench/harness/recipes.h"
#include "core/topology.h"
#include "raster/view.h"
#include "scenes/shapes.h"
#include "tests/core/shared_folder.h"
#include "tests/raster/raster_solids.h"

namespace obscura::stability {

inline Mesh analysed(Mesh mesh) {
    analyse_topology(mesh);
    return mesh;
}

/// An open sheet that the light from above sees at a slope, over a closed floor.
inline Mesh sloped_sheet() {
    Mesh mesh;
    solids::add(mesh, box({-6, -3.5, -6}, {6, -3, 6}));
    solids::add(mesh, solids::moved(plane(8, 8), solids::rotation({0.3, 0, 1}, 0.3)));
    return mesh;
}

/// The same sheet with a back on it: closed, without thickness.
inline Mesh sloped_fin() {
    Mesh mesh;
    solids::add(mesh, box({-6, -3.5, -6}, {6, -3, 6}));
    Mesh sheet = solids::moved(plane(8, 8), solids::rotation({0.3, 0, 1}, 0.3));
    const std::vector<Triangle> front = sheet.triangles;
    for (const Triangle& t : front)
        sheet.triangles.push_back({{t.v[0], t.v[2], t.v[1]}});
    sheet.material.clear();
    sheet.object.clear();
    sheet.objects.clear();
    solids::add(mesh, sheet);
    return mesh;
}

/// The same sheet as a plate of this thickness.
inline Mesh sloped_plate(double thickness_m) {
    Mesh mesh;
    solids::add(mesh, box({-6, -3.5, -6}, {6, -3, 6}));
    solids::add(mesh, solids::moved(box({8, thickness_m, 8}), solids::rotation({0.3, 0, 1}, 0.3)));
    return mesh;
}

/// Two blocks side by side, wall on wall but for a gap (negative: they overlap), turned as one.
inline Mesh party_wall(double gap_m) {
    Mesh mesh;
    const Affine turn = solids::rotation({0.2, 1, 0.4}, 0.35);
    solids::add(mesh, solids::moved(box({-3, -2, -2}, {0, 2, 2}), turn));
    solids::add(mesh, solids::moved(box({gap_m, -2, -2}, {3, 2, 2}), turn));
    return mesh;
}

/// A lamp in the middle of a room: of a solid without a hollow, or of one with walls of half a metre.
inline Mesh lamp_room(bool hollow) {
    Mesh mesh;
    solids::add(mesh, box({-3, -3, -3}, {3, 3, 3}));
    if (hollow) solids::add(mesh, solids::flipped(box({-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5})));
    return mesh;
}
inline LightView lamp_view(int side) {
    return perspective_light_view({0.2, 0.1, 0.3}, normalize(Vec3d{1, -0.4, 0.5}), 90, 0.05, 20, side);
}

/// 100 boxes on a slab, moved along x.
inline Mesh small_city(double shift_m) {
    Mesh mesh = box_city(10, 10);
    if (shift_m != 0) mesh = solids::shifted(mesh, {shift_m, 0, 0});
    return analysed(mesh);
}

/// The way light travels from this many degrees above the horizon.
inline Vec3d sun_at(double elevation_deg) {
    const double t = elevation_deg * 3.14159265358979323846 / 180;
    return {0.8 * std::cos(t), -std::sin(t), 0.6 * std::cos(t)};
}

/// A plain ten kilometres wide, one metre thick, and far from its middle rows of cubes of this size.
constexpr int cubes_a_side = 20;
inline Vec3d cube_base(int i, double size_m) {
    return {4700 + (i % cubes_a_side) * 7.3 * size_m, 0, 4600 + (i / cubes_a_side) * 7.1 * size_m};
}
inline Mesh plain_with_cubes(double size_m) {
    Mesh mesh;
    solids::add(mesh, box({-5000, -1, -5000}, {5000, 0, 5000}));
    for (int i = 0; i < cubes_a_side * cubes_a_side; ++i) {
        const Vec3d p = cube_base(i, size_m), half{0.5 * size_m, 0, 0.5 * size_m};
        solids::add(mesh, box(p - half, p + half + Vec3d{0, size_m, 0}));
    }
    return mesh;
}

/// Thousands of leaves without thickness; nothing without the shared data.
inline std::optional<Mesh> ficus() {
    const std::filesystem::path data = shared_folder("data");
    if (!std::filesystem::exists(data / "meshes/ficus_tree.obj")) return {};
    const FileAccess access{data, {}};
    return load_obj(resolve_input(access, "meshes/ficus_tree.obj"), access, Limits{}).mesh;
}

inline LightView sun_view(const Mesh& mesh, Vec3d sun, int side) {
    return orthographic_light_view(bounds_of(mesh), normalize(sun), side);
}

}  // namespace obscura::stability
