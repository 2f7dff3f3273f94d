// The scene's root, and [frames], whose keys are those of other tables.

#include "app/scene/keys.h"

namespace obscura {
namespace {

/// A table of keyframes: `first` keys, then every animated key of `animated`, none of them required.
TableSpec keyframe_table(std::string path, std::string doc, std::vector<KeySpec> first,
                         const TableSpec& animated) {
    TableSpec spec{std::move(path), std::move(doc), std::move(first), "", {}};
    const auto add = [&](const std::vector<KeySpec>& keys) {
        for (KeySpec key : keys) {
            bool known = !key.animated;
            for (const KeySpec& k : spec.keys)
                known = known || k.name == key.name;
            if (known) continue;
            key.required = false;
            key.fallback.reset();
            spec.keys.push_back(std::move(key));
        }
    };
    add(animated.keys);
    for (const VariantSpec& variant : animated.variants)
        add(variant.keys);
    return spec;
}

KeySpec frame_key() {
    return number_key("frame", "When: a frame number, fractions allowed.").in({0, 1e9}).need();
}

}  // namespace

const TableSpec& frames_table() {
    static const TableSpec camera =
        keyframe_table("[[frames.camera]]", "What the camera is at a frame; keys as in [camera].",
                       {frame_key()}, camera_table());
    static const TableSpec light =
        keyframe_table("[[frames.light]]", "What a light is at a frame; keys as in [[light]].",
                       {frame_key(), name_key("id", "The light.").need()}, light_table());
    static const TableSpec optics =
        keyframe_table("[[frames.optics]]", "What the lens is at a frame; keys as in [optics].",
                       {frame_key()}, optics_table());
    static const TableSpec stereo =
        keyframe_table("[[frames.stereo]]", "What the eyes are at a frame; keys as in [stereo].",
                       {frame_key()}, stereo_table());
    static const TableSpec stereo_edit =
        keyframe_table("[[frames.stereo_edit]]", "What an edit is at a frame; keys as in [[stereo.edit]].",
                       {frame_key(), name_key("id", "The edit.").need()}, stereo_edit_table());
    static const TableSpec spec{
        "[frames]",
        "Which frames there are, and keyframes of camera, lights, optics and stereo. Each key is "
        "interpolated by itself over the keyframes that set it and keeps its first and last value outside "
        "them. Angles are plain numbers: go from 350 to 370 to pass north.",
        {
            text_key("range", "One frame \"7\", a range \"1-48\", or every other of it \"1-48x2\".")
                .or_else("1"),
            choice_key("interpolation", {"linear", "smooth"},
                       "linear: straight lines. smooth: Catmull-Rom, that is cubic Hermite curves whose "
                       "tangents are the slopes between the neighbours; results are clamped to the key's "
                       "range.")
                .or_else("linear"),
            table_list_key("camera", camera),
            table_list_key("light", light),
            table_list_key("optics", optics),
            table_list_key("stereo", stereo),
            table_list_key("stereo_edit", stereo_edit),
        },
        "",
        {}};
    return spec;
}

const TableSpec& scene_schema_root() {
    static const TableSpec spec{
        "",
        "A scene. Right-handed, +Y up, metres; north is -Z, east is +X. Units stand in key names.",
        {
            integer_key("format", "Version of this format.").one_of({1}).need(),
            [] {
                KeySpec k = table_key("camera", camera_table());
                k.required = true;
                return k;
            }(),
            table_list_key("mesh", mesh_table()),
            table_list_key("terrain", terrain_table()),
            table_map_key("material", material_table()),
            table_list_key("light", light_table()),
            table_map_key("shadow", shadow_table()).beside({shadow_cache_key()}),
            table_key("sky", sky_table()),
            table_key("render", render_table()),
            table_key("optics", optics_table()).only_if_given(),
            table_key("stereo", stereo_table()).only_if_given(),
            table_list_key("output", output_table()),
            table_key("frames", frames_table()),
            table_key("limits", limits_table()),
        },
        "",
        {}};
    return spec;
}

}  // namespace obscura
