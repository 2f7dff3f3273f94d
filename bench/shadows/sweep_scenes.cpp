#include "bench/shadows/sweep_scenes.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "app/models/obj_file.h"
#include "bench/harness/recipes.h"
#include "core/pnm.h"
#include "core/topology.h"
#include "raster/view.h"
#include "scenes/build.h"

namespace obscura {
namespace {

using Path = std::filesystem::path;

std::string bytes_of(const Path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The number after "key": in a flat JSON text; 0 when there is none.
double number_of(const std::string& json, const std::string& key) {
    const std::size_t at = json.find('"' + key + "\":");
    return at == std::string::npos ? 0 : std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

/// The middle of a grid of elevations as a sheet.
Mesh terrain_mesh(const Path& file) {
    constexpr int most_cells = 300;
    const std::string json = bytes_of(Path(file).replace_extension(".json"));
    const double dx = number_of(json, "cell_size_x_m"), dz = number_of(json, "cell_size_y_m"),
                 scale = number_of(json, "elevation_scale_m");
    const Image<std::uint16_t> samples = decode_pnm(bytes_of(file), file.string()).codes;
    const int columns = std::min(samples.width, most_cells + 1),
              rows = std::min(samples.height, most_cells + 1);
    const int middle_x = columns / 2, middle_z = rows / 2;
    const int x0 = (samples.width - columns) / 2, z0 = (samples.height - rows) / 2;
    Mesh mesh;
    for (int z = 0; z < rows; ++z) {
        for (int x = 0; x < columns; ++x)
            mesh.positions.push_back(
                to_float(Vec3d{(x - middle_x) * dx, samples(x0 + x, z0 + z) * scale, (z - middle_z) * dz}));
    }
    const auto at = [&](int x, int z) { return static_cast<std::uint32_t>(z * columns + x); };
    for (int z = 0; z + 1 < rows; ++z) {
        for (int x = 0; x + 1 < columns; ++x) {
            mesh.triangles.push_back({{at(x, z), at(x, z + 1), at(x + 1, z + 1)}});
            mesh.triangles.push_back({{at(x, z), at(x + 1, z + 1), at(x + 1, z)}});
        }
    }
    compute_normals(mesh, 180);
    return mesh;
}

/// Seen whole from the south-west and above.
ShadowRecipe seen_from_aside(std::string name, std::string what, std::function<Mesh()> make) {
    ShadowRecipe recipe{std::move(name), std::move(what), {}, {}, {}, {}};
    const Bounds b = bounds_of(make());
    const double half = 0.5 * std::max(b.high.x - b.low.x, b.high.z - b.low.z);
    const double middle = 0.5 * (b.high.y - b.low.y) / half, radius = std::max(1.0, std::hypot(middle, 1.0));
    recipe.look_at = {0, middle, 0};
    recipe.eye = Vec3d{-0.9, middle + 0.9, 1.6} * (1.25 * radius);
    recipe.make = std::move(make);
    return recipe;
}

}  // namespace

std::vector<ShadowRecipe> sweep_recipes(const Path& data) {
    std::vector<ShadowRecipe> recipes = shadow_recipes(data, false);
    std::vector<Path> files;
    for (const char* folder : {"cities", "meshes", "terrain"}) {
        if (!std::filesystem::is_directory(data / folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(data / folder))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const Path& file : files) {
        const std::string name = file.stem().string();
        const auto has_name = [&](const ShadowRecipe& r) { return r.name == name; };
        if (std::any_of(recipes.begin(), recipes.end(), has_name)) continue;
        if (file.extension() == ".obj") {
            recipes.push_back(seen_from_aside(name, "on a slab", [file] {
                const FileAccess access{file.parent_path(), {}};
                return copies_on_slab(
                    load_obj(resolve_input(access, file.filename().string()), access, Limits{}).mesh, 1, 1);
            }));
        } else if (file.extension() == ".pgm") {
            recipes.push_back(seen_from_aside(name, "terrain: open", [file] { return terrain_mesh(file); }));
        }
    }
    return recipes;
}

ShadowRecipe with_sun_at(ShadowRecipe recipe, double elevation_deg) {
    const double azimuth = 215 * std::numbers::pi / 180, elevation = elevation_deg * std::numbers::pi / 180;
    const Vec3d to_sun{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                       -std::cos(azimuth) * std::cos(elevation)};
    recipe.sun = -to_sun;
    return recipe;
}

}  // namespace obscura
