#include "bench/shadows/scenes.h"

#include <algorithm>

#include "app/models/obj_file.h"
#include "bench/harness/recipes.h"
#include "core/topology.h"
#include "raster/view.h"
#include "scenes/build.h"
#include "scenes/city.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

using Path = std::filesystem::path;

constexpr Vec3d afternoon{0.55, -0.62, -0.38};

Mesh load(const Path& folder, const std::string& file) {
    const FileAccess access{folder, {}};
    return load_obj(resolve_input(access, file), access, Limits{}).mesh;
}

/// The mesh on a closed slab whose top is at the mesh's lowest point.
Mesh on_ground(const Mesh& part) {
    const Bounds b = bounds_of(part);
    const double margin = 0.05 * std::max(b.high.x - b.low.x, b.high.z - b.low.z);
    Mesh mesh = box({b.low.x - margin, b.low.y - 2, b.low.z - margin},
                    {b.high.x + margin, b.low.y, b.high.z + margin});
    add_part(mesh, part, Affine{});
    mesh.uvs.clear();
    return mesh;
}

std::vector<ShadowRecipe> data_recipes(const Path& data) {
    enum class Stand { slab, pedestal, own };  // ground in metres; a slab for the part alone; brings its own
    struct Entry {
        const char *name, *folder, *what;
        Stand stand;
        Vec3d eye, look_at;
    };
    // Streets are seen from above the roofs, so that pixels ask for shadows from near by to far away.
    const Entry entries[] = {
        {"vienna_west",
         "cities",
         "294 closed buildings with real roofs",
         Stand::slab,
         {-0.25, 0.42, 0.75},
         {0.05, 0.0, -0.05}},
        {"city_large",
         "cities",
         "24 districts of real buildings, closed",
         Stand::slab,
         {-0.30, 0.14, 0.42},
         {-0.05, 0.0, -0.10}},
        {"fzk_house",
         "cities",
         "house with rooms, rafters, railings; open in places",
         Stand::own,
         {-1.3, 1.1, 1.7},
         {0.0, 0.3, 0.0}},
        {"armadillo", "meshes", "closed scan", Stand::pedestal, {-0.9, 1.6, 2.5}, {0.0, 0.9, 0.0}},
        {"dragon_res2",
         "meshes",
         "closed scan with 1,405 doubled faces",
         Stand::pedestal,
         {-0.6, 1.1, 1.9},
         {0.0, 0.5, 0.0}},
        {"bunny", "meshes", "scan with holes: open", Stand::pedestal, {-0.7, 1.2, 2.0}, {0.0, 0.6, 0.0}},
        {"ficus_tree",
         "meshes",
         "thousands of leaves without thickness: open",
         Stand::pedestal,
         {-1.2, 2.0, 4.0},
         {0.0, 1.35, 0.0}},
    };
    std::vector<ShadowRecipe> recipes;
    for (const Entry& e : entries) {
        const Path folder = data / e.folder;
        const std::string file = std::string(e.name) + ".obj";
        if (!std::filesystem::exists(folder / file)) continue;
        std::function<Mesh()> make = [folder, file] { return copies_on_slab(load(folder, file), 1, 1); };
        if (e.stand == Stand::slab) make = [folder, file] { return on_ground(load(folder, file)); };
        if (e.stand == Stand::own) make = [folder, file] { return load(folder, file); };
        recipes.push_back({e.name, e.what, afternoon, e.eye, e.look_at, make});
    }
    return recipes;
}

}  // namespace

std::vector<ShadowRecipe> shadow_recipes(const std::optional<Path>& data, bool quick) {
    std::vector<ShadowRecipe> recipes = {
        {"city", "900 closed boxes on a slab", afternoon, {-0.55, 0.40, 0.95}, {0.0, 0.0, 0.05}, [] {
             return box_city(30, 30);
         }}};
    if (quick) return recipes;
    recipes.push_back(
        {"town", "generated town, closed", afternoon, {-0.22, 0.20, 0.48}, {0.0, 0.02, 0.0}, [] {
             return city({594'000, 0, 1}).mesh;
         }});
    if (data) {
        for (ShadowRecipe& recipe : data_recipes(*data))
            recipes.push_back(std::move(recipe));
    }
    return recipes;
}

Scene stage_shadows(const ShadowRecipe& recipe, const PictureSize& size) {
    Scene scene;
    scene.mesh = recipe.make();
    scene.mesh.material.assign(scene.mesh.triangles.size(), 0);
    scene.mesh.object.assign(scene.mesh.triangles.size(), 0);
    scene.mesh.objects = {{"all", true}};
    analyse_topology(scene.mesh);
    scene.materials = {Material{}};

    const Bounds b = bounds_of(scene.mesh);
    const double half = 0.5 * std::max(b.high.x - b.low.x, b.high.z - b.low.z);
    const Vec3d ground{0.5 * (b.low.x + b.high.x), b.low.y, 0.5 * (b.low.z + b.high.z)};
    scene.camera.eye = ground + recipe.eye * half;
    scene.camera.look_at = ground + recipe.look_at * half;
    scene.camera.vfov_deg = 40;
    scene.camera.near_m = 1e-3 * half;
    scene.render = {size.width, size.height, 1, 0.0, ToneCurve::filmic, Receivers::any};

    SceneLight sun;
    sun.light.id = "sun";
    sun.light.direction = normalize(recipe.sun);
    sun.light.color = {3, 3, 3};
    sun.shadow.method = ShadowMethod::none;
    sun.shadow.receivers = Receivers::any;  // as the trees that are built of it
    scene.lights = {sun};
    return scene;
}

SceneLight shadow_light(const Scene& scene, int resolution, int side) {
    SceneLight light = scene.lights[0];
    light.shadow.method = ShadowMethod::map;
    light.shadow.resolution = resolution;
    light.shadow.filter_px = side;
    return light;
}

}  // namespace obscura
