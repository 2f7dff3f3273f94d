#include "app/scene/keys.h"

#include "app/scene/scene.h"

namespace obscura {
namespace {

constexpr double far_away_m = 1e9;
constexpr Range positive{0, far_away_m, true, false};
constexpr Range anywhere{-far_away_m, far_away_m};
constexpr Range turns{-36000, 36000};
constexpr Range brightness{0, 1e9};
constexpr Range unit_share{0, 1};

const TableSpec& material_table() {
    static const Material d;
    static const TableSpec spec{
        "[material.NAME]",
        "A surface: Lambert and GGX with the metallic-roughness parameters. Meshes name it by NAME.",
        {
            choice_key("color_space", {"srgb", "linear"}, "How base_color is meant.").or_else("linear"),
            vec3_or_number_key("base_color", "Share of light reflected, per channel.")
                .in(unit_share)
                .or_else(d.base_color),
            number_key("roughness", "Perceptual roughness (GGX alpha is its square).")
                .in({0.02, 1})
                .or_else(0.8),
            number_key("metallic", "0 for dielectrics, 1 for metals.").in(unit_share).or_else(0.0),
            vec3_or_number_key("emission_w_m2_sr", "Radiance the surface gives off, per channel.")
                .in(brightness)
                .or_else(d.emission),
            file_key("texture", "PNG that multiplies base_color; sRGB, repeated outside [0, 1]."),
            number_key("translucency", "Share of light that passes thin sheets diffusely, as through leaves.")
                .in(unit_share)
                .or_else(0.0),
        },
        "",
        {}};
    return spec;
}

const TableSpec& sky_table() {
    static const Sky d;
    static const TableSpec spec{
        "[sky]",
        "A gradient sky: background, and ambient light that reaches every surface without occlusion.",
        {
            vec3_or_number_key("zenith_w_m2_sr", "Radiance straight above.").in(brightness).or_else(d.zenith),
            vec3_or_number_key("horizon_w_m2_sr", "Radiance at the horizon.")
                .in(brightness)
                .or_else(d.horizon),
            vec3_or_number_key("ground_w_m2_sr", "Radiance from below.").in(brightness).or_else(d.ground),
            number_key("ambient", "Scale of the light the sky sheds on surfaces.").in({0, 1000}).or_else(1.0),
            boolean_key("visible", "false makes the background black; the ambient light stays.")
                .or_else(d.visible),
        },
        "",
        {}};
    return spec;
}

const TableSpec& render_table() {
    static const RenderSettings d;
    static const TableSpec spec{
        "[render]",
        "The picture.",
        {
            size_key("size_px", "Width and height.").in({1, 1048576}).or_else(Size2{d.width, d.height}),
            integer_key("samples", "Samples per pixel.").one_of({1, 4, 16}).or_else(std::int64_t{d.samples}),
            number_key("exposure_ev", "Radiance is scaled by 2^exposure_ev.")
                .in({-30, 30})
                .or_else(d.exposure_ev),
            choice_key("tone", {"linear", "filmic"}, "Tone curve; linear clips at 1.").or_else("filmic"),
            choice_key("receivers", {"any", "static"},
                       "Who receives shadows: \"static\", the scene's own surfaces, which is everyone in a "
                       "picture; or \"any\" point outside solids, for trees that are kept for receivers "
                       "which the scene does not have, such as moving objects added later. Of \"any\", a "
                       "map of open surfaces (a plane, leaves, scans) may take a node for every texel. What "
                       "lights use that do not say otherwise.")
                .or_else("static"),
        },
        "",
        {}};
    return spec;
}

const TableSpec& output_table() {
    static const TableSpec spec{
        "[[output]]",
        "A file to write per frame.",
        {
            choice_key("aov", {"beauty", "depth", "normal", "albedo", "object", "shadow"}, "What to write.")
                .or_else("beauty"),
            file_key(
                "file",
                "Name ending in .png (8-bit sRGB) or .pfm (linear float), relative to the current folder and "
                "inside it; #### stands for the frame number, padded to as many digits.")
                .need(),
        },
        "",
        {}};
    return spec;
}

const TableSpec& limits_table() {
    static const Limits d;
    const auto limit = [](const char* name, const char* doc, std::int64_t fallback) {
        return integer_key(name, doc).in({1, 1e12}).or_else(fallback);
    };
    static const TableSpec spec{
        "[limits]",
        "Bounds that are checked before anything is allocated; beyond one, the program stops with exit code "
        "4.",
        {
            limit("memory_mib", "Estimated memory for meshes, textures, shadow maps and the frame.",
                  d.memory_mib),
            limit("triangles", "Triangles of all meshes and instances together.", d.triangles),
            limit("texture_px", "Longest side of a texture.", d.texture_px),
            limit("texture_mib", "All decoded textures together.", d.texture_mib),
            limit("frames", "Frames in the range.", d.frames),
            limit("image_px", "Longest side of a frame.", d.image_px),
        },
        "",
        {}};
    return spec;
}

}  // namespace

const TableSpec& camera_table() {
    static const TableSpec spec{
        "[camera]",
        "Where the picture is taken from. Perspective cameras give either vfov_deg or focal_length_mm.",
        {
            choice_key("projection", {"perspective", "orthographic"}, "Kind of camera.")
                .or_else("perspective"),
            vec3_key("eye_m", "Position.").in(anywhere).need().animate(),
            vec3_key("look_at_m", "Point in the middle of the picture; not the eye.")
                .in(anywhere)
                .need()
                .animate(),
            vec3_key("up", "Direction that is up in the picture; not the viewing direction.")
                .in(anywhere)
                .or_else(Vec3d{0, 1, 0})
                .animate(),
            number_key("near_m", "Nothing nearer than this is seen.").in(positive).or_else(Camera{}.near_m),
        },
        "projection",
        {
            {"perspective",
             "",
             {
                 number_key("vfov_deg",
                            "Full vertical angle of view; 40 when no focal length is given either.")
                     .in({0, 180, true, true})
                     .animate(),
                 number_key("focal_length_mm", "Instead of vfov_deg: focal length of a lens.")
                     .in({0, 1e6, true})
                     .animate(),
                 number_key("sensor_height_mm", "Height of the sensor behind that lens; 24 when not given.")
                     .in({0, 1e6, true}),
             }},
            {"orthographic",
             "",
             {number_key("height_m", "World height of the picture.").in(positive).need().animate()}},
        }};
    return spec;
}

namespace {

std::vector<KeySpec> directional_keys() {
    return {
        number_key("azimuth_deg", "Where the light comes from, clockwise from north: 90 is east.")
            .in(turns)
            .need()
            .animate(),
        number_key("elevation_deg", "Height above the horizon of where the light comes from.")
            .in({-90, 90})
            .need()
            .animate(),
        vec3_or_number_key("irradiance_w_m2", "On a surface that faces the light, per channel.")
            .in(brightness)
            .or_else(Vec3d{3, 3, 3})
            .animate(),
    };
}

std::vector<KeySpec> sun_keys() {
    return {
        number_key("latitude_deg", "North is positive.").in({-90, 90}).need(),
        number_key("longitude_deg", "East is positive.").in({-180, 180}).need(),
        date_time_key("time", "Date and time with offset from UTC, as in 2026-06-21T18:00:00+02:00.")
            .need()
            .animate(),
        number_key(
            "extraterrestrial_w_m2",
            "Irradiance per channel above the atmosphere, in the scene's scale. What arrives is dimmed and "
            "reddened by clear air: exp(-depth * air mass), with depths 0.12, 0.19, 0.31 for red, green, "
            "blue "
            "and the air mass of Kasten and Young (1989).")
            .in(brightness)
            .or_else(5.0)
            .animate(),
        vec3_or_number_key(
            "irradiance_w_m2",
            "Instead of that: what arrives on a surface that faces the sun. Below the horizon there is "
            "no sun either way.")
            .in(brightness)
            .animate(),
    };
}

std::vector<KeySpec> point_keys() {
    return {
        vec3_key("position_m", "Position.").in(anywhere).need().animate(),
        vec3_or_number_key("intensity_w_sr", "Radiant intensity, per channel.")
            .in(brightness)
            .need()
            .animate(),
        number_key("near_m", "Nothing nearer to the light than this casts a shadow.")
            .in(positive)
            .or_else(Light{}.near_m),
        number_key("range_m", "The light ends smoothly at this distance.")
            .in(positive)
            .or_else(Light{}.range_m),
    };
}

std::vector<KeySpec> spot_keys() {
    std::vector<KeySpec> keys = point_keys();
    keys.push_back(vec3_key("look_at_m", "Point on the axis of the cone.").in(anywhere).need().animate());
    keys.push_back(number_key("inner_cone_deg", "Half angle of the cone of full power.")
                       .in({0, 85})
                       .or_else(Light{}.inner_cone_deg)
                       .animate());
    keys.push_back(number_key("outer_cone_deg",
                              "Half angle beyond which there is no light; not less than inner_cone_deg.")
                       .in({0, 85, true})
                       .or_else(Light{}.outer_cone_deg)
                       .animate());
    return keys;
}

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

const TableSpec& light_table() {
    static const TableSpec spec{
        "[[light]]",
        "A light. Directions: north is -Z, east is +X, up is +Y.",
        {
            name_key("id", "Name, unique among lights.").need(),
            choice_key("type", {"directional", "sun", "point", "spot"}, "Kind of light.").need(),
            table_key("shadow", shadow_table()),
        },
        "type",
        {
            {"directional", "Parallel light from a given direction.", directional_keys()},
            {"sun", "Parallel light from where the sun stands at a place and time.", sun_keys()},
            {"point", "Light from a point to all sides.", point_keys()},
            {"spot", "Light from a point into a cone.", spot_keys()},
        }};
    return spec;
}

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
        "interpolated "
        "by itself over the keyframes that set it and keeps its first and last value outside them. Angles "
        "are plain numbers: go "
        "from 350 "
        "to 370 to pass north.",
        {
            text_key("range", "One frame \"7\", a range \"1-48\", or every other of it \"1-48x2\".")
                .or_else("1"),
            choice_key("interpolation", {"linear", "smooth"},
                       "linear: straight lines. smooth: Catmull-Rom, that is cubic Hermite curves whose "
                       "tangents are "
                       "the slopes between the neighbours; results are clamped to the key's range.")
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
