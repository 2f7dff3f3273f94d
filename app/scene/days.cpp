#include "app/scene/days.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/scene/build.h"
#include "app/scene/validate.h"
#include "core/error.h"
#include "hierarchy/terrain/day_shadow.h"
#include "hierarchy/terrain/far_file.h"
#include "hierarchy/terrain/far_parts.h"
#include "raster/heights/height_mesh.h"

namespace obscura {
namespace {

bool has_day(const SceneTable& light) {
    return text(subtable(light, "shadow"), "method") == name_of(shadow_method_words, ShadowMethod::day);
}

/// What the file says that it is, for who has the wrong one.
std::string grid_text(const FarGrid& grid) {
    return fmt::format("{} x {} samples of {:g} x {:g} m", grid.width, grid.height, grid.cell_x_m,
                       grid.cell_y_m);
}

SceneDay day_of(const std::filesystem::path& path, const std::string& named, const Scene& scene) {
    FarFile file = read_far_file(path);
    if (const std::vector<int> missing = missing_groups(file.day); !missing.empty()) {
        throw InputError(named,
                         fmt::format("is of a part of a day, or is altered: {} are missing ('obscura terrain "
                                     "--merge' joins parts)",
                                     suns_text(file.day, missing)));
    }
    for (std::size_t i = 0; i < scene.terrains.size(); ++i) {
        const SceneTerrain& terrain = scene.terrains[i];
        if (!is_of_ground(file.day, file.key.high, *terrain.field)) continue;
        if (!terrain.casts_shadow)
            throw InputError(named, fmt::format("is of terrain '{}', which casts no shadow", terrain.id));
        GroundDay ground{terrain.field, height_pyramid(*terrain.field), std::move(file.day), named};
        return {std::make_shared<const GroundDay>(std::move(ground)), i};
    }
    std::string there;
    for (const SceneTerrain& terrain : scene.terrains) {
        const HeightField& f = *terrain.field;
        there += fmt::format("{} '{}' {}", there.empty() ? "" : ",", terrain.id,
                             grid_text({f.width(), f.height(), f.cell_x_m, f.cell_y_m, f.diagonal}));
    }
    throw InputError(named, fmt::format("has the shadows of other ground, {}; the scene has{}",
                                        grid_text(file.day.grid), there.empty() ? " no [[terrain]]" : there));
}

}  // namespace

void keep_for_days(const SceneDocument& document, const SceneTable& terrain, Vec3d middle_m,
                   HeightField field, const Mesh& mesh, Scene& scene) {
    const auto lights = subtables(document.root, "light");
    if (std::none_of(lights.begin(), lights.end(), [](const SceneTable* l) { return has_day(*l); })) return;
    SceneTerrain t;
    t.id = text(terrain, "id");
    t.middle_m = middle_m;
    t.first_triangle = static_cast<std::uint32_t>(scene.mesh.triangles.size());
    t.ground_triangles =
        static_cast<std::uint32_t>(2 * (field.width() - 1) * std::int64_t{field.height() - 1});
    t.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    t.casts_shadow = boolean(terrain, "casts_shadow");
    t.field = std::make_shared<const HeightField>(std::move(field));
    scene.terrains.push_back(std::move(t));
}

void add_days(const SceneDocument& document, const FileAccess& access, Scene& scene) {
    for (const SceneTable* light : subtables(document.root, "light")) {
        if (!has_day(*light)) continue;
        const SceneTable& shadow = subtable(*light, "shadow");
        const std::string& named = text(shadow, "day_file");
        try {
            scene.days[text(*light, "id")] = day_of(resolve_input(access, named), named, scene);
        } catch (const InputError& error) {
            fail_at(place_of(shadow, "day_file"), document.sources,
                    fmt::format("'{}': {}", named, error.message));
        }
    }
}

}  // namespace obscura
