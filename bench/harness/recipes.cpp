#include "bench/harness/recipes.h"

#include <algorithm>

#include "app/models/obj_file.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/city.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

constexpr double copy_height_m = 10.0;

Mesh load_bunny(const std::filesystem::path& data) {
    const FileAccess access{data / "meshes", {}};
    return load_obj(resolve_input(access, "bunny.obj"), access, Limits{}).mesh;
}

}  // namespace

Mesh copies_on_slab(const Mesh& part, int copies, int columns) {
    const Bounds bounds = bounds_of(part);
    const Vec3d size = bounds.high - bounds.low, centre = (bounds.high + bounds.low) * 0.5;
    const double scale = copy_height_m / size.y;
    const double cell = 1.3 * scale * std::max(size.x, size.z);
    const int rows = (copies + columns - 1) / columns;
    const Affine to_origin =
        scaling({scale, scale, scale}) * translation(-centre.x, -bounds.low.y, -centre.z);

    const double half_x = 0.5 * cell * columns, half_z = 0.5 * cell * rows;
    Mesh mesh = box({-half_x, -0.05 * copy_height_m, -half_z}, {half_x, 0, half_z});
    for (int i = 0; i < copies; ++i) {
        const int column = i % columns, row = i / columns;
        const double x = (column + 0.5) * cell - half_x, z = (row + 0.5) * cell - half_z;
        add_part(mesh, part, translation(x, 0, z) * rotation_y(45.0 * i) * to_origin);
    }
    mesh.uvs.clear();  // scans have none
    return mesh;
}

Mesh box_city(int columns, int rows) {
    const double cell = 20.0;
    const double half_x = 0.5 * cell * columns, half_z = 0.5 * cell * rows;
    Mesh mesh = box({-half_x, -2, -half_z}, {half_x, 0, half_z});
    Random random(2016);
    for (int i = 0; i < columns * rows; ++i) {
        const int column = i % columns, row = i / columns;
        const double x = (column + 0.5) * cell - half_x, z = (row + 0.5) * cell - half_z;
        const double width = random.range(0.25, 0.45) * cell, depth = random.range(0.25, 0.45) * cell;
        // Mostly low houses, now and then a tower.
        const double tall = random.uniform();
        const double height = 5.0 + 45.0 * tall * tall * tall * tall;
        add_part(mesh, box({x - width, 0, z - depth}, {x + width, height, z + depth}), Affine{});
    }
    mesh.uvs.clear();
    return mesh;
}

std::vector<BenchRecipe> bench_recipes(const std::optional<std::filesystem::path>& data, bool quick) {
    std::vector<BenchRecipe> recipes = {{"city", [] { return box_city(30, 30); }}};
    if (quick) return recipes;
    recipes.push_back({"bigcity", [] { return box_city(225, 220); }});
    recipes.push_back({"town", [] { return city({594'000, 0, 1}).mesh; }});
    if (data && std::filesystem::exists(*data / "meshes" / "bunny.obj")) {
        recipes.push_back({"bunny", [data] { return copies_on_slab(load_bunny(*data), 1, 1); }});
        recipes.push_back({"bunny8", [data] { return copies_on_slab(load_bunny(*data), 8, 3); }});
    }
    return recipes;
}

}  // namespace obscura
