#include "app/scene/stereo_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "app/scene/aperture_file.h"
#include "app/scene/key_ranges.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"
#include "app/scene/validate.h"
#include "raster/view.h"

namespace obscura {
namespace {

using Wish = std::optional<decltype(StereoEdit::what)>;

// --- targets

KeySpec objects_key() {
    return name_list_key(
        "objects",
        "Meshes by id, or single ones of their objects: \"ID/OBJECT\" of files with several, "
        "\"ID#0\" of instances.");
}

KeySpec materials_key() {
    return name_list_key(
        "materials",
        "Materials by name, or \"ID/SLOT\" for what a shape or a file brings along. Objects and "
        "materials together: pixels of any of them.");
}

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

/// Indices of all that the names of a key mean; fails at a name that means nothing.
template <class Means>
std::vector<std::uint32_t> indices_of(const EditContext& c, const SceneTable& edit, const std::string& key,
                                      const char* what, const std::vector<std::string>& have, Means&& means) {
    std::vector<std::uint32_t> indices;
    if (!edit.has(key)) return indices;
    for (const SceneValue& item : std::get<SceneList>(edit.find(key)->value.data)) {
        const std::string& name = std::get<std::string>(item.data);
        bool found = false;
        for (std::uint32_t i = 0; i < have.size(); ++i) {
            if (!means(name, have[i])) continue;
            found = true;
            indices.push_back(i);
        }
        if (!found) require_known(name, item.place, have, what, c.document.sources);
    }
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    return indices;
}

EditTarget target_of(const EditContext& c, const SceneTable& edit, const std::string& prefix = "") {
    std::vector<std::string> objects, materials;
    for (const Object& object : c.scene.mesh.objects)
        objects.push_back(object.name);
    for (const Material& material : c.scene.materials)
        materials.push_back(material.name);
    const auto equal = [](const std::string& a, const std::string& b) { return a == b; };
    return {indices_of(c, edit, prefix + "objects", "object", objects, means_object),
            indices_of(c, edit, prefix + "materials", "material", materials, equal)};
}

// --- offsets

/// An offset in either unit.
std::vector<KeySpec> offset_keys(const char* doc) {
    return {
        number_key("offset_px", doc).in({-1e5, 1e5}).animate(),
        number_key("offset_percent", "Instead of offset_px: so that it fits pictures of any size.")
            .in({-100, 100})
            .animate(),
    };
}

double offset_of(const EditContext& c, const SceneTable& edit) {
    if (edit.has("offset_px")) return number(edit, "offset_px") * c.px;
    if (edit.has("offset_percent")) return 0.01 * number(edit, "offset_percent") * c.scene.render.width;
    return 0;
}

// --- roundness

KeyRows<RoundnessEdit> roundness_rows() {
    return {
        {objects_key()},
        {materials_key()},
        key_row(&RoundnessEdit::roundness,
                number_key(
                    "roundness",
                    "Scales disparity about the target's centre: 0 flattens, 1 changes nothing, 2 doubles.")
                    .in({0, 100})
                    .need()
                    .animate()),
        key_row(&RoundnessEdit::together,
                boolean_key(
                    "together",
                    "The target is one thing made of several objects: it has one centre, and borders inside "
                    "it are scaled, too.")),
    };
}

Wish read_roundness(const EditContext& c, const SceneTable& table) {
    RoundnessEdit edit;
    read_rows(roundness_rows(), table, edit);
    edit.target = target_of(c, table);
    return edit;
}

// --- anchor

std::vector<KeySpec> anchor_keys() {
    return std::vector<KeySpec>{objects_key(), materials_key()} +
           offset_keys("Towards the viewer when positive; 0 when neither is given.");
}

Wish read_anchor(const EditContext& c, const SceneTable& table) {
    return AnchorEdit{target_of(c, table), offset_of(c, table)};
}

// --- interface

KeyRows<InterfaceEdit> interface_rows() {
    return {
        {objects_key()},
        {materials_key()},
        {name_list_key("second_objects",
                       "The other side of the border, as objects; anything when there is no second.")},
        {name_list_key("second_materials", "The same, as materials.")},
        {file_key("mask",
                  "A picture, stretched over the frame: white counts, black does not. With objects or "
                  "materials it limits these, alone it keeps depth inside objects, too. PNG, PBM or PGM "
                  "without colours, inside the scene's folder.")},
        key_row(&InterfaceEdit::keep,
                boolean_key("keep", "false: lets go of what interfaces = \"original\" would keep.")),
    };
}

Image<float> mask_of(const EditContext& c, const SceneTable& edit) {
    if (!edit.has("mask")) return {};
    const std::string& name = text(edit, "mask");
    std::filesystem::path path;
    try {
        path = resolve_input(c.access, name);
    } catch (const InputError& error) {
        fail_at(place_of(edit, "mask"), c.document.sources, fmt::format("'{}': {}", name, error.message));
    }
    const Limits& limits = c.scene.limits;
    return read_mask(path, name,
                     {limits.texture_px, limits.texture_mib << 20, " (limits.texture_mib raises it)"});
}

Wish read_interface(const EditContext& c, const SceneTable& table) {
    InterfaceEdit edit;
    read_rows(interface_rows(), table, edit);
    edit.first = target_of(c, table);
    edit.second = target_of(c, table, "second_");
    edit.mask = mask_of(c, table);
    return edit;
}

// --- match

/// Points and offset are the frame's: read_match() reads them.
KeyRows<MatchEdit> match_rows() {
    const auto px = [](const char* name, const char* doc) {
        return KeyRow<MatchEdit>{vec2_key(name, doc).in({-1e6, 1e6}).animate()};
    };
    const auto metres = [](const char* name, const char* doc) {
        return KeyRow<MatchEdit>{vec3_key(name, doc).in(key_ranges::anywhere).animate()};
    };
    KeyRows<MatchEdit> rows{
        px("source_px", "Point of the picture whose disparity is taken: right, down from its corner."),
        metres("source_m", "Instead of source_px: a point of the scene."),
        px("destination_px", "Point that gets it."),
        metres("destination_m", "Instead of destination_px: a point of the scene."),
    };
    for (KeySpec& key : offset_keys("Of the destination from the source, towards the viewer."))
        rows.push_back({std::move(key)});
    return rows +
           KeyRows<MatchEdit>{
               key_row(
                   &MatchEdit::radius_px,
                   number_key("radius_px", "Of the disc that moves along; 0: the destination's whole object.")
                       .in({0, 1e5})),
               key_row(&MatchEdit::hold_source,
                       boolean_key(
                           "hold_source",
                           "The source's whole object, or the disc of radius_px around it, keeps its "
                           "distance to the source. Without, the source alone may be drawn out to where the "
                           "destination is.")
                           .or_else(true)),
               key_row(&MatchEdit::any_object,
                       boolean_key("any_object", "With radius_px: other objects within it move along, too.")),
           };
}

/// Pixel of a matching edit's point, which may be outside of the picture; nothing behind the camera.
std::optional<Vec2d> point_of(const EditContext& c, const SceneTable& edit, const std::string& name) {
    if (edit.has(name + "_px")) return vec2(edit, name + "_px") * c.px;
    const Vec3d world = vec3(edit, name + "_m");
    const RenderSettings& render = c.scene.render;
    const Camera& camera = c.scene.camera;
    const Vec3d forward = normalize(camera.look_at - camera.eye);
    if (dot(forward, world - camera.eye) <= camera.near_m) return std::nullopt;
    const Vec3d p = to_map_space(camera_view(camera, render.width, render.height), world);
    return Vec2d{p.x, p.y};
}

Wish read_match(const EditContext& c, const SceneTable& table) {
    const auto source = point_of(c, table, "source"), destination = point_of(c, table, "destination");
    if (!source || !destination) return std::nullopt;
    MatchEdit edit;
    read_rows(match_rows(), table, edit);
    edit.source_px = *source;
    edit.destination_px = *destination;
    edit.offset_px = offset_of(c, table);
    edit.radius_px *= c.px;
    return edit;
}

// --- of every kind

/// Name and kind are said before these.
KeyRows<StereoEdit> edit_rows() {
    return {
        key_row(
            &StereoEdit::weight,
            number_key("weight",
                       "How strongly it is wanted; of roundness and interface the share that is applied, at "
                       "most 1. 0 turns it off.")
                .in({0, 1e6})
                .animate()),
    };
}

KeyRows<WeightFade> fade_rows() {
    return {
        key_row_if_given(
            &WeightFade::angle_deg,
            vec2_key(
                "fade_angle_deg",
                "[full, none]: the weight, and the offset of an anchor, fade out between these angles of the "
                "view from fade_direction.")
                .in({0, 180})),
        key_row_if_given(&WeightFade::direction,
                         vec3_key("fade_direction", "Direction of the view for which fade_angle_deg is 0.")
                             .in(key_ranges::anywhere)),
        key_row_if_given(&WeightFade::distance_m, vec2_key("fade_distance_m",
                                                           "[full, none]: the weight, and the offset of an "
                                                           "anchor, fade out between these distances of the "
                                                           "camera from fade_position_m.")
                                                      .in({0, 1e9})),
        key_row_if_given(
            &WeightFade::position_m,
            vec3_key("fade_position_m", "Where fade_distance_m is measured from.").in(key_ranges::anywhere)),
    };
}

double fade_of(const SceneTable& edit, const Camera& camera) {
    WeightFade fade;
    read_rows(fade_rows(), edit, fade);
    fade.direction = normalize(fade.direction);
    return fade_factor(fade, camera.eye, normalize(camera.look_at - camera.eye));
}

const EditKindRow& edit_kind_of(const SceneTable& edit) {
    return *std::find_if(stereo_edit_kinds().begin(), stereo_edit_kinds().end(),
                         [&](const EditKindRow& kind) { return text(edit, "type") == kind.name; });
}

}  // namespace

const std::vector<EditKindRow>& stereo_edit_kinds() {
    static const std::vector<EditKindRow> all{
        {"roundness", "More or less depth within the target.", keys_of(roundness_rows()), read_roundness},
        {"anchor", "Holds the target at its own disparity (with its roundness), or at an offset from it.",
         anchor_keys(), read_anchor},
        {"interface",
         "Keeps the original depth where two targets meet, or one and anything, or under a mask; or lets it "
         "go.",
         keys_of(interface_rows()), read_interface},
        {"match", "What surrounds the destination takes the disparity of the source.", keys_of(match_rows()),
         read_match},
    };
    return all;
}

const TableSpec& stereo_edit_table() {
    static const TableSpec spec = [] {
        std::vector<VariantSpec> variants;
        std::vector<std::string> names;
        for (const EditKindRow& kind : stereo_edit_kinds()) {
            variants.push_back({kind.name, kind.doc, kind.keys});
            names.emplace_back(kind.name);
        }
        return TableSpec{
            "[[stereo.edit]]",
            "A wish for the disparity of a part of the picture. All of them are weighed against one "
            "another, and against the depths that the scene has.",
            std::vector<KeySpec>{name_key("id", "Name, unique among edits.").need(),
                                 choice_key("type", names, "Kind of edit.").need()} +
                keys_of(edit_rows()) + keys_of(fade_rows()),
            "type", std::move(variants)};
    }();
    return spec;
}

std::optional<StereoEdit> stereo_edit_of(const EditContext& context, const SceneTable& table) {
    Wish wish = edit_kind_of(table).read(context, table);
    if (!wish) return std::nullopt;
    StereoEdit edit;
    read_rows(edit_rows(), table, edit);
    edit.name = text(table, "id");
    const double fade = fade_of(table, context.scene.camera);
    edit.weight *= fade;
    // Pulls of many pixels add up, so that an anchor's weight does nothing for long and everything at the
    // end: what it pulls to goes with it.
    if (auto* anchor = std::get_if<AnchorEdit>(&*wish)) anchor->offset_px *= fade;
    edit.what = std::move(*wish);
    return edit;
}

}  // namespace obscura
