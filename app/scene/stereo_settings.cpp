#include "app/scene/stereo_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "app/scene/aperture_file.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/stereo_rows.h"
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

/// Where the screen stands when the scene does not say.
double zero_parallax_m(const SceneTable& table, const Camera& camera) {
    return table.has("zero_parallax_m") ? number(table, "zero_parallax_m")
                                        : length(camera.look_at - camera.eye);
}

/// The limit in pixels that either unit gives; `limit` stays when neither does.
template <class Limit>
void set_limit(const SceneTable& table, const std::string& name, const StereoRig& rig, int width,
               Limit& limit) {
    if (table.has(name + "_percent")) {
        limit = 0.01 * number(table, name + "_percent") * width;
    } else if (table.has(name + "_deg")) {
        limit = disparity_of_vergence(number(table, name + "_deg"), width, rig);
    }
}

void set_remap_pixels(const SceneTable& table, int width, RangeRemap& r) {
    const auto pixels = [&](const char* key) { return 0.01 * number(table, key) * width; };
    if (r.curvature == 0 && r.kind == RemapKind::logarithmic) r.kind = RemapKind::linear;
    r.nearest_px = pixels("remap_near_percent");
    r.farthest_px = pixels("remap_far_percent");
    r.first_px = pixels("remap_first_percent");
    r.second_px = pixels("remap_second_percent");
    r.matched_px = pixels("remap_matched_percent");
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
    read_rows(stereo_rows(), table, s);
    s.rig.zero_parallax_m = zero_parallax_m(table, scene.camera);
    if (s.margin_px != auto_margin)
        s.margin_px = static_cast<int>(static_cast<double>(s.margin_px) * r.px + 0.5);
    s.solver.tolerance_rms_px = 0.4 * s.solver.tolerance_max_px;
    set_limit(table, "comfort_near", s.rig, scene.render.width, s.edit.comfort.nearest_px);
    set_limit(table, "comfort_far", s.rig, scene.render.width, s.edit.comfort.farthest_px);
    // Vergence comes back as pixels with rounding, or as infinite where eyes cannot turn so far.
    s.edit.comfort.nearest_px = std::max(s.edit.comfort.nearest_px, 0.0);
    s.edit.comfort.farthest_px = std::min(s.edit.comfort.farthest_px, 0.0);
    set_remap_pixels(table, scene.render.width, s.compare_remap);
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
