#include "app/scene/stereo_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "app/scene/aperture_file.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/validate.h"
#include "raster/view.h"

namespace obscura {
namespace {

/// What reading one document at one frame needs.
struct Reader {
    const SceneDocument& document;
    const Scene& scene;
    const FileAccess& access;
    double px = 1;  ///< pixels of the scene's picture per pixel of the document's
    StereoSettings settings;
};

/// [stereo] at the frame, or its defaults.
SceneTable stereo_table_at(const SceneDocument& document, double frame) {
    if (document.root.has("stereo")) return stereo_at(document, frame);
    return validate_table({}, {}, stereo_table(), document.sources);
}

StereoRig rig_of(const SceneTable& table, const Camera& camera) {
    StereoRig rig;
    rig.interaxial_m = number(table, "interaxial_m");
    rig.zero_parallax_m =
        table.has("zero_parallax_m") ? number(table, "zero_parallax_m") : length(camera.look_at - camera.eye);
    rig.screen_width_m = number(table, "screen_width_m");
    rig.viewing_distance_m = number(table, "viewing_distance_m");
    rig.eye_separation_m = number(table, "eye_separation_m");
    return rig;
}

SolverParams solver_of(const SceneTable& table) {
    static const std::map<std::string, SolverMethod> methods = {{"multigrid", SolverMethod::multigrid},
                                                                {"fmg", SolverMethod::fmg},
                                                                {"vcycle", SolverMethod::vcycle},
                                                                {"cascade", SolverMethod::cascade}};
    SolverParams p;
    p.method = methods.at(text(table, "solver"));
    p.tolerance_max_px = number(table, "tolerance_px");
    p.tolerance_rms_px = 0.4 * p.tolerance_max_px;
    p.max_iterations = static_cast<int>(integer(table, "max_iterations"));
    p.sweeps = static_cast<int>(integer(table, "cascade_sweeps"));
    p.half_storage = boolean(table, "half_storage");
    return p;
}

EditParams edit_params_of(const SceneTable& table, const StereoRig& rig, int width) {
    EditParams p;
    p.gradient_weight = number(table, "gradient_weight");
    p.anchor_weight = number(table, "anchor_weight");
    p.match_weight = number(table, "match_weight");
    p.epsilon = number(table, "regularization");
    p.comfort_weight = number(table, "comfort_weight");
    p.window_weight = number(table, "window_weight");
    p.interfaces =
        text(table, "interfaces") == "edited" ? InterfaceGradients::edited : InterfaceGradients::original;
    p.window_inherited = boolean(table, "window_inherited");
    p.limit_folds = boolean(table, "limit_folds");
    p.reset_inversions = boolean(table, "reset_inversions");
    if (table.has("comfort_near_percent")) {
        p.comfort.nearest_px = 0.01 * number(table, "comfort_near_percent") * width;
    } else if (table.has("comfort_near_deg")) {
        p.comfort.nearest_px = disparity_of_vergence(number(table, "comfort_near_deg"), width, rig);
    }
    if (table.has("comfort_far_percent")) {
        p.comfort.farthest_px = 0.01 * number(table, "comfort_far_percent") * width;
    } else if (table.has("comfort_far_deg")) {
        p.comfort.farthest_px = disparity_of_vergence(number(table, "comfort_far_deg"), width, rig);
    }
    return p;
}

RangeRemap remap_of(const SceneTable& table, int width) {
    const auto pixels = [&](const char* key) { return 0.01 * number(table, key) * width; };
    RangeRemap r;
    r.curvature = number(table, "remap_curvature");
    r.kind = r.curvature == 0 && text(table, "remap") == "log" ? RemapKind::linear
                                                               : *parse_remap(text(table, "remap"));
    r.nearest_px = pixels("remap_near_percent");
    r.farthest_px = pixels("remap_far_percent");
    r.strength = number(table, "remap_strength");
    r.first_px = pixels("remap_first_percent");
    r.second_px = pixels("remap_second_percent");
    r.matched_px = pixels("remap_matched_percent");
    return r;
}

// --- targets

/// Whether `name` of a scene file means the object: it, a part of it, or an instance of all its parts.
bool means_object(std::string_view name, std::string_view object) {
    if (object.starts_with(name)) {
        const std::string_view rest = object.substr(name.size());
        if (rest.empty() || rest.front() == '/' || rest.front() == '#') return true;
    }
    const std::size_t number = name.rfind('#');
    if (number == std::string_view::npos) return false;
    const std::string_view id = name.substr(0, number);
    return object.starts_with(id) && object.substr(id.size()).starts_with('/') &&
           object.ends_with(name.substr(number));
}

const SceneList& list_of(const SceneTable& edit, const char* key) {
    static const SceneList none;
    return edit.has(key) ? std::get<SceneList>(edit.find(key)->value.data) : none;
}

/// Indices of all that are meant; fails at a name that means nothing.
template <class Means>
std::vector<std::uint32_t> indices_of(const Reader& r, const SceneList& wanted, const char* what,
                                      const std::vector<std::string>& have, Means&& means) {
    std::vector<std::uint32_t> indices;
    for (const SceneValue& item : wanted) {
        const std::string& name = std::get<std::string>(item.data);
        bool found = false;
        for (std::uint32_t i = 0; i < have.size(); ++i) {
            if (!means(name, have[i])) continue;
            found = true;
            indices.push_back(i);
        }
        if (!found) require_known(name, item.place, have, what, r.document.sources);
    }
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    return indices;
}

EditTarget target_of(const Reader& r, const SceneTable& edit, const std::string& prefix) {
    std::vector<std::string> objects, materials;
    for (const Object& object : r.scene.mesh.objects)
        objects.push_back(object.name);
    for (const Material& material : r.scene.materials)
        materials.push_back(material.name);
    const auto equal = [](const std::string& a, const std::string& b) { return a == b; };
    return {indices_of(r, list_of(edit, (prefix + "objects").c_str()), "object", objects, means_object),
            indices_of(r, list_of(edit, (prefix + "materials").c_str()), "material", materials, equal)};
}

Image<float> mask_of(const Reader& r, const SceneTable& edit) {
    if (!edit.has("mask")) return {};
    const std::string& name = text(edit, "mask");
    std::filesystem::path path;
    try {
        path = resolve_input(r.access, name);
    } catch (const InputError& error) {
        fail_at(place_of(edit, "mask"), r.document.sources, fmt::format("'{}': {}", name, error.message));
    }
    const Limits& limits = r.scene.limits;
    return read_mask(path, name,
                     {limits.texture_px, limits.texture_mib << 20, " (limits.texture_mib raises it)"});
}

// --- edits

double offset_of(const Reader& r, const SceneTable& edit) {
    if (edit.has("offset_px")) return number(edit, "offset_px") * r.px;
    if (edit.has("offset_percent")) return 0.01 * number(edit, "offset_percent") * r.scene.render.width;
    return 0;
}

/// Pixel of a matching edit's point, which may be outside of the picture; nothing behind the camera.
std::optional<Vec2d> point_of(const Reader& r, const SceneTable& edit, const std::string& name) {
    if (edit.has(name + "_px")) return vec2(edit, name + "_px") * r.px;
    const Vec3d world = vec3(edit, name + "_m");
    const RenderSettings& render = r.scene.render;
    const Camera& camera = r.scene.camera;
    const Vec3d forward = normalize(camera.look_at - camera.eye);
    if (dot(forward, world - camera.eye) <= camera.near_m) return std::nullopt;
    const Vec3d p = to_map_space(camera_view(camera, render.width, render.height), world);
    return Vec2d{p.x, p.y};
}

WeightFade fade_of(const SceneTable& edit) {
    WeightFade fade;
    if (edit.has("fade_angle_deg")) {
        const Vec2d ends = vec2(edit, "fade_angle_deg");
        fade.angle_deg = {ends.x, ends.y};
        fade.direction = normalize(vec3(edit, "fade_direction"));
    }
    if (edit.has("fade_distance_m")) {
        const Vec2d ends = vec2(edit, "fade_distance_m");
        fade.distance_m = {ends.x, ends.y};
        fade.position_m = vec3(edit, "fade_position_m");
    }
    return fade;
}

/// What the edit asks for; nothing when a point of it is behind the camera.
std::optional<decltype(StereoEdit::what)> wish_of(const Reader& r, const SceneTable& edit) {
    const std::string& type = text(edit, "type");
    if (type == "roundness")
        return RoundnessEdit{target_of(r, edit, ""), number(edit, "roundness"), boolean(edit, "together")};
    if (type == "anchor") return AnchorEdit{target_of(r, edit, ""), offset_of(r, edit)};
    if (type == "interface")
        return InterfaceEdit{target_of(r, edit, ""), target_of(r, edit, "second_"), mask_of(r, edit),
                             boolean(edit, "keep")};
    const auto source = point_of(r, edit, "source"), destination = point_of(r, edit, "destination");
    if (!source || !destination) return std::nullopt;
    return MatchEdit{*source,
                     *destination,
                     offset_of(r, edit),
                     number(edit, "radius_px") * r.px,
                     boolean(edit, "any_object"),
                     boolean(edit, "hold_source")};
}

void add_edit(Reader& r, const SceneTable& edit) {
    const Camera& camera = r.scene.camera;
    StereoEdit result;
    result.name = text(edit, "id");
    const double fade = fade_factor(fade_of(edit), camera.eye, normalize(camera.look_at - camera.eye));
    result.weight = number(edit, "weight") * fade;
    auto wish = wish_of(r, edit);
    if (!wish) {
        r.settings.notes.push_back(fmt::format(
            "edit '{}' does nothing in this frame: its source or destination is behind the camera",
            result.name));
        return;
    }
    // Pulls of many pixels add up, so that an anchor's weight does nothing for long and everything at the
    // end: what it pulls to goes with it.
    if (auto* anchor = std::get_if<AnchorEdit>(&*wish)) anchor->offset_px *= fade;
    result.what = std::move(*wish);
    r.settings.edits.push_back(std::move(result));
}

}  // namespace

StereoSettings stereo_settings(const SceneDocument& document, const Scene& scene, double frame,
                               const FileAccess& access) {
    const SceneTable table = stereo_table_at(document, frame);
    const Size2 size = size2(subtable(document.root, "render"), "size_px");
    Reader r{document, scene, access, static_cast<double>(scene.render.width) / size.width, {}};
    StereoSettings& s = r.settings;
    s.rig = rig_of(table, scene.camera);
    const auto* margin = std::get_if<std::int64_t>(&table.find("margin_px")->value.data);
    if (margin != nullptr) s.margin_px = static_cast<int>(static_cast<double>(*margin) * r.px + 0.5);
    s.map_scale = static_cast<int>(integer(table, "map_scale"));
    s.warm_start = boolean(table, "warm_start");
    s.edit = edit_params_of(table, s.rig, scene.render.width);
    s.solver = solver_of(table);
    s.compare_remap = remap_of(table, scene.render.width);
    s.reproject.tolerance_px = number(table, "tessellation_px");
    for (const SceneTable* edit : subtables(table, "edit"))
        add_edit(r, stereo_edit_at(document, *edit, frame));
    return std::move(r.settings);
}

std::string stereo_text(const StereoSettings& settings, const Scene& scene) {
    const StereoRig& rig = settings.rig;
    const int width = scene.render.width;
    const DisparityLaw law = disparity_law(rig, scene.camera, scene.render.height);
    std::string out = fmt::format(
        "stereo    eyes {:.4g} mm apart, screen at {:.4g} m; what is far away has {:.4g} px of disparity "
        "({:.3g} % of the width, {:.3g} degrees)\n",
        1e3 * rig.interaxial_m, rig.zero_parallax_m, -law.offset, percent_of_width(-law.offset, width),
        vergence_deg(-law.offset, width, rig));
    constexpr const char* kinds[] = {"roundness", "anchor", "interface", "match"};
    for (const StereoEdit& edit : settings.edits)
        out += fmt::format("edit      {}: {}, weight {:.4g}\n", edit.name, kinds[edit.what.index()],
                           edit.weight);
    for (const std::string& note : settings.notes)
        out += fmt::format("note      {}\n", note);
    return out;
}

}  // namespace obscura
