#include "app/scene/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>

#include "app/scene/key_ranges.h"
#include "app/scene/keyframe_rules.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/light_kinds.h"
#include "app/scene/rules_optics.h"
#include "app/scene/rules_shadow.h"
#include "app/scene/rules_stereo.h"
#include "app/scene/shapes.h"
#include "app/scene/validate.h"
#include "core/error.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

std::string line_text(const Place& place) {
    return place.source == 0 && place.line > 0 ? fmt::format(" (first in line {})", place.line) : "";
}

/// The ids of a list, which must differ.
std::vector<std::string> unique_ids(const SceneTable& root, const char* list, const Sources& sources) {
    std::vector<std::string> ids;
    std::map<std::string, Place> first;
    for (const SceneTable* table : subtables(root, list)) {
        const auto [it, is_new] = first.try_emplace(text(*table, "id"), place_of(*table, "id"));
        if (!is_new) {
            fail_at(place_of(*table, "id"), sources,
                    fmt::format("two {} entries have the id '{}'{}", list, it->first, line_text(it->second)));
        }
        ids.push_back(it->first);
    }
    return ids;
}

std::vector<std::string> keys_of(const SceneTable& table) {
    std::vector<std::string> keys;
    for (const SceneEntry& entry : table.entries)
        keys.push_back(entry.key);
    return keys;
}

// --- camera

/// Where the viewing direction comes from, when it is wrong: the later of its keys that someone wrote.
void check_camera(const SceneTable& camera, const Sources& sources) {
    const Vec3d eye = vec3(camera, "eye_m"), target = vec3(camera, "look_at_m"), up = vec3(camera, "up");
    if (eye == target)
        fail_at(place_of(camera, "look_at_m"), sources, "'look_at_m' is the same point as 'eye_m'");
    if (length(target - eye) < key_ranges::least_distance_m) {
        fail_at(place_of(camera, "look_at_m"), sources,
                fmt::format("'look_at_m' is nearer to 'eye_m' than {:g} m", key_ranges::least_distance_m));
    }
    if (length(up) < 1e-9) fail_at(place_of(camera, "up"), sources, "'up' has no direction");
    const Vec3d view = normalize(target - eye), above = normalize(up);
    if (length(cross(view, above)) < 1e-6) {
        const Place up_place = place_of(camera, "up");
        fail_at(up_place.source >= 0 ? up_place : place_of(camera, "look_at_m"), sources,
                "'up' is parallel to the view from 'eye_m' to 'look_at_m'; give another 'up'");
    }
}

/// One definition of the lens, and its defaults.
void complete_lens(SceneTable& camera, const Sources& sources) {
    if (text(camera, "projection") != "perspective") return;
    if (camera.has("vfov_deg") && camera.has("focal_length_mm")) {
        fail_at(place_of(camera, "focal_length_mm"), sources,
                "give either 'vfov_deg' or 'focal_length_mm', not both");
    }
    if (!camera.has("focal_length_mm") && camera.has("sensor_height_mm")) {
        fail_at(place_of(camera, "sensor_height_mm"), sources, "'sensor_height_mm' needs 'focal_length_mm'");
    }
    if (camera.has("focal_length_mm")) {
        if (!camera.has("sensor_height_mm")) camera.set("sensor_height_mm", value_of(24.0));
    } else if (!camera.has("vfov_deg")) {
        camera.set("vfov_deg", value_of(40.0));
    }
}

// --- meshes

/// What is scaled by less has no size that single precision can hold beside anything else.
constexpr double least_scale = 1e-9;

/// Where the first key stands that a message about a mesh names and that someone wrote; else its id.
Place place_of_problem(const SceneTable& mesh, const std::string& problem) {
    for (std::size_t at = problem.find('\''); at != std::string::npos; at = problem.find('\'', at + 1)) {
        const std::string key = problem.substr(at + 1, problem.find('\'', at + 1) - at - 1);
        if (mesh.has(key) && place_of(mesh, key).source >= 0) return place_of(mesh, key);
    }
    return place_of(mesh, "id");
}

void check_mesh(const SceneTable& mesh, const std::vector<std::string>& materials, const Sources& sources) {
    if (mesh.has("material")) {
        require_known(text(mesh, "material"), place_of(mesh, "material"), materials, "material", sources);
    }
    if (mesh.has("material") && !subtable(mesh, "materials").entries.empty()) {
        fail_at(place_of(mesh, "materials"), sources, "give either 'material' or 'materials', not both");
    }
    for (const SceneEntry& slot : subtable(mesh, "materials").entries) {
        require_known(std::get<std::string>(slot.value.data), slot.value.place, materials, "material",
                      sources);
    }
    const auto check_scale = [&](const SceneTable& table) {
        const Vec3d s = vec3(table, "scale");
        const double least = std::min({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)});
        if (least == 0) fail_at(place_of(table, "scale"), sources, "'scale' must not be 0");
        if (least < least_scale)
            fail_at(place_of(table, "scale"), sources,
                    fmt::format("'scale' must not be nearer to 0 than {:g}", least_scale));
    };
    check_scale(mesh);
    for (const SceneTable* instance : subtables(mesh, "instance"))
        check_scale(*instance);
    const ShapeSpec* shape = find_shape(text(mesh, "shape"));
    if (shape == nullptr || !shape->problem) return;
    const std::string problem = shape->problem(mesh);
    if (!problem.empty()) fail_at(place_of_problem(mesh, problem), sources, problem);
}

void check_terrain(const SceneTable& terrain, const std::vector<std::string>& materials,
                   const Sources& sources) {
    if (terrain.has("material"))
        require_known(text(terrain, "material"), place_of(terrain, "material"), materials, "material",
                      sources);
    for (const char* key : {"cell_x_m", "cell_y_m"}) {
        if (terrain.has(key) && terrain.has("latitude_deg"))
            fail_at(
                place_of(terrain, "latitude_deg"), sources,
                fmt::format("give either '{}' or 'latitude_deg', which says how large cells in degrees are",
                            key));
    }
}

void check_triangles(const SceneDocument& document) {
    const std::int64_t limit = integer(subtable(document.root, "limits"), "triangles");
    std::int64_t total = 0;
    for (const SceneTable* mesh : subtables(document.root, "mesh"))
        total += max_triangles(*mesh);
    if (total > limit) {
        throw LimitError(fmt::format("{}: shapes of up to {} triangles, more than limits.triangles = {}",
                                     document.sources[0], total, limit));
    }
}

// --- frames and outputs

void check_outputs(const SceneTable& root, int frames, const Sources& sources) {
    const std::vector<const SceneTable*> lights = subtables(root, "light");
    const bool has_sun = std::any_of(lights.begin(), lights.end(), [](const SceneTable* light) {
        return light_kind_of(*light).kind == LightKind::sun;
    });
    std::vector<std::filesystem::path> files;
    for (const SceneTable* output : subtables(root, "output")) {
        const Place place = place_of(*output, "file");
        const std::filesystem::path path(text(*output, "file"));
        if (text(*output, "aov") == "sun_hours" && !has_sun)
            fail_at(place_of(*output, "aov"), sources, "'aov' = \"sun_hours\" needs a light of type \"sun\"");
        std::string ending = path.extension().string();
        std::transform(ending.begin(), ending.end(), ending.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (ending != ".png" && ending != ".pfm") {
            fail_at(place, sources, "'file' must end in .png or .pfm");
        }
        const bool leaves = std::find(path.begin(), path.end(), "..") != path.end();
        if (path.is_absolute() || leaves)
            fail_at(place, sources, "'file' must stay inside the current folder");
        if (frames > 1 && path.filename().string().find('#') == std::string::npos) {
            fail_at(place, sources,
                    fmt::format("'file' needs #### for the frame number: there are {} frames", frames));
        }
        const std::filesystem::path plain = path.lexically_normal();
        if (std::find(files.begin(), files.end(), plain) != files.end()) {
            fail_at(place, sources, "another output has the same 'file'");
        }
        files.push_back(plain);
    }
}

/// Keyframes of the lens, and the lens at every frame.
void check_optics_frames(const SceneDocument& document, const FrameRange& range) {
    const Sources& sources = document.sources;
    const std::vector<const SceneTable*> keyframes = subtables(subtable(document.root, "frames"), "optics");
    if (!document.root.has("optics")) {
        if (!keyframes.empty())
            fail_at(place_of(*keyframes.front(), "frame"), sources, "there is no [optics] to be animated");
        return;
    }
    const SceneTable& optics = subtable(document.root, "optics");
    check_keyframes(keyframes, optics, "[optics]", {}, sources);
    const Size2 size = size2(subtable(document.root, "render"), "size_px");
    for (int i = 0; i < range.count(); ++i)
        check_lens(optics, camera_at(document, range.at(i)), size, sources);
}

void check_frames(const SceneDocument& document, const std::vector<std::string>& light_ids) {
    const Sources& sources = document.sources;
    const SceneTable& frames = subtable(document.root, "frames");
    const auto range = parse_frame_range(text(frames, "range"));
    if (!range)
        fail_at(place_of(frames, "range"), sources, "'range' must be like \"7\", \"1-48\" or \"1-48x2\"");
    const std::int64_t limit = integer(subtable(document.root, "limits"), "frames");
    if (range->count() > limit) {
        throw LimitError(
            fmt::format("{}: {} frames, more than limits.frames = {}", sources[0], range->count(), limit));
    }
    check_outputs(document.root, range->count(), sources);

    const SceneTable& camera = subtable(document.root, "camera");
    check_keyframes(subtables(frames, "camera"), camera, "[camera]", {}, sources);
    for (const SceneTable* keyframe : subtables(frames, "light")) {
        require_known(text(*keyframe, "id"), place_of(*keyframe, "id"), light_ids, "light", sources);
    }
    for (const SceneTable* light : subtables(document.root, "light")) {
        std::vector<const SceneTable*> own = subtables(frames, "light");
        std::erase_if(own, [&](const SceneTable* k) { return text(*k, "id") != text(*light, "id"); });
        check_keyframes(own, *light, fmt::format("light '{}'", text(*light, "id")),
                        variant_of(*light, light_table())->keys, sources);
        const LightKindRow& kind = light_kind_of(*light);
        for (int i = 0; i < (own.empty() ? 1 : range->count()); ++i) {
            if (kind.check != nullptr) kind.check(light_at(document, *light, range->at(i)), sources);
        }
    }
    check_optics_frames(document, *range);
    const bool camera_moves = !subtables(frames, "camera").empty();
    for (int i = 0; i < (camera_moves ? range->count() : 1); ++i) {
        check_camera(camera_at(document, range->at(i)), sources);
    }
}

/// A sky that follows the sun needs one, and an image a file.
void check_sky(const SceneTable& root, const std::vector<std::string>& light_ids, const Sources& sources) {
    const SceneTable& sky = subtable(root, "sky");
    const std::string model = text(sky, "model");
    for (const char* key : {"file", "file_scale", "left_edge_azimuth_deg"}) {
        if (sky.has(key) && model != "image")
            fail_at(place_of(sky, key), sources, fmt::format("'{}' needs 'model' = \"image\"", key));
    }
    if (model == "image" && !sky.has("file"))
        fail_at(place_of(sky, "model"), sources, "'model' = \"image\" needs 'file'");
    if (model == "image" && sky.has("sun"))
        fail_at(place_of(sky, "sun"), sources, "'sun' needs 'model' = \"clear\" or \"overcast\"");
    if (model == "gradient" || model == "image") return;
    const std::string id = sky.has("sun") ? text(sky, "sun") : "";
    if (!id.empty()) require_known(id, place_of(sky, "sun"), light_ids, "light", sources);
    bool found = false;
    for (const SceneTable* light : subtables(root, "light")) {
        const bool parallel = is_parallel(light_kind_of(*light).kind);
        if (!id.empty() && text(*light, "id") == id && !parallel) {
            fail_at(place_of(sky, "sun"), sources,
                    fmt::format("light '{}' has no direction that the sky could follow; it must be a sun or "
                                "directional",
                                id));
        }
        found = found || parallel;
    }
    if (!found) {
        fail_at(place_of(sky, "model"), sources,
                fmt::format("'model' = \"{}\" needs a light of type \"sun\" or \"directional\" to follow",
                            text(sky, "model")));
    }
}

/// What is computed from where the sun stands arrives with occlusion; a gradient is light for speed.
void complete_sky(SceneTable& sky) {
    if (!sky.has("occlusion")) sky.set("occlusion", value_of(text(sky, "model") != "gradient"));
}

void check_size(const SceneDocument& document) {
    const Size2 size = size2(subtable(document.root, "render"), "size_px");
    const std::int64_t limit = integer(subtable(document.root, "limits"), "image_px");
    if (std::max(size.width, size.height) > limit) {
        throw LimitError(fmt::format("{}: a frame of {} x {} pixels is larger than limits.image_px = {}",
                                     document.sources[0], size.width, size.height, limit));
    }
}

}  // namespace

void apply_rules(SceneDocument& document) {
    SceneTable& root = document.root;
    const Sources& sources = document.sources;
    complete_lens(std::get<SceneTable>(root.find("camera")->value.data), sources);
    check_size(document);
    check_optics(root, sources);

    const std::vector<std::string> mesh_ids = unique_ids(root, "mesh", sources);
    const std::vector<std::string> materials =
        root.has("material") ? keys_of(subtable(root, "material")) : std::vector<std::string>{};
    for (const SceneTable* mesh : subtables(root, "mesh"))
        check_mesh(*mesh, materials, sources);
    unique_ids(root, "terrain", sources);
    for (const SceneTable* terrain : subtables(root, "terrain"))
        check_terrain(*terrain, materials, sources);
    check_triangles(document);

    const std::vector<std::string> light_ids = unique_ids(root, "light", sources);
    merge_shadows(root, light_ids, sources);
    check_sky(root, light_ids, sources);
    complete_sky(std::get<SceneTable>(root.find("sky")->value.data));
    check_frames(document, light_ids);
    check_stereo(document, mesh_ids, materials);
}

}  // namespace obscura
