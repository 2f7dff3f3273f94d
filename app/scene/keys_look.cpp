// [material.NAME] and [sky]: what surfaces and the background look like.

#include "app/scene/build.h"
#include "app/scene/key_ranges.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"
#include "core/color.h"

namespace obscura {
namespace {

using namespace key_ranges;

/// The texture is loaded by whoever builds the scene.
const KeyRows<Material>& material_rows() {
    static const KeyRows<Material> rows{
        {choice_key("color_space", {"srgb", "linear"}, "How base_color is meant.").or_else("linear")},
        key_row(&Material::base_color,
                vec3_or_number_key("base_color", "Share of light reflected, per channel.").in(unit_share)),
        key_row(&Material::roughness,
                number_key("roughness", "Perceptual roughness (GGX alpha is its square).").in({0.02, 1})),
        key_row(&Material::metallic,
                number_key("metallic", "0 for dielectrics, 1 for metals.").in(unit_share)),
        key_row(&Material::emission,
                vec3_or_number_key("emission_w_m2_sr", "Radiance the surface gives off, per channel.")
                    .in(brightness)),
        {file_key(
            "texture",
            "PNG, of 8 or 16 bits a sample, that multiplies base_color; sRGB, repeated outside [0, 1].")},
        key_row(
            &Material::translucency,
            number_key("translucency", "Share of light that passes thin sheets diffusely, as through leaves.")
                .in(unit_share)),
    };
    return rows;
}

constexpr Word<SkyKind> sky_kind_words[] = {{"gradient", SkyKind::gradient},
                                            {"clear", SkyKind::clear},
                                            {"overcast", SkyKind::overcast},
                                            {"image", SkyKind::image}};

const KeyRows<Sky>& sky_rows() {
    static const KeyRows<Sky> rows{
        word_row(
            &Sky::kind, sky_kind_words, "model",
            "gradient: a mix of the three colours below. clear: computed from the air, for where the sun "
            "stands, dusk included; a sun without irradiance_w_m2 then has the colour that this air "
            "leaves it. overcast: three times as bright above as at the horizon, as bright as a day of "
            "that sun; such a sun then sheds no light of its own. The disc of a clear sky is 0.53 degrees "
            "wide. image: a picture of all directions, from `file`."),
        {file_key(
            "file",
            "Image: PFM, linear radiance in W/(m2 sr), twice as wide as high: the top row looks straight "
            "up, and columns run clockwise as seen from above.")},
        {number_key("file_scale", "Image: what the file's numbers are multiplied by; 1 when not given.")
             .in({0, 1e6, true})},
        {number_key(
             "left_edge_azimuth_deg",
             "Image: where its left and right edges look; 180, when not given, has north in the middle.")
             .in({-360, 360})},
        key_row(
            &Sky::turbidity,
            number_key("turbidity", "Clear: how hazy the air is; 2 is very clear, 6 hazy.").in({1.7, 10})),
        key_row(&Sky::ground_albedo, vec3_or_number_key("ground_albedo",
                                                        "Clear and overcast: share of light that the ground "
                                                        "around sends back, per channel.")
                                         .in(unit_share)),
        key_row_if_given(&Sky::sun,
                         name_key("sun",
                                  "Clear and overcast: id of the light whose direction the sky follows; "
                                  "the first sun, else the first directional light, when not given.")),
        key_row(&Sky::bounces,
                integer_key("bounces",
                            "Occlusion: how often surfaces send on the light of lights and sky that reaches "
                            "them; what hides a direction of the sky then stands for it. 0: it is black.")
                    .in({0, 4})),
        key_row(
            &Sky::samples,
            integer_key("samples",
                        "Occlusion: directions above the horizon that each pixel asks, shared out among its "
                        "own samples; half as many lie below, with bounces = 0 a sixteenth, at least 4.")
                .one_of({16, 64, 256, 1024})),
        key_row(&Sky::zenith,
                vec3_or_number_key("zenith_w_m2_sr", "Gradient: radiance straight above.").in(brightness)),
        key_row(&Sky::horizon,
                vec3_or_number_key("horizon_w_m2_sr", "Gradient: radiance at the horizon.").in(brightness)),
        key_row(&Sky::ground,
                vec3_or_number_key("ground_w_m2_sr", "Gradient: radiance from below.").in(brightness)),
        key_row(&Sky::ambient,
                number_key("ambient", "Scale of the light the sky sheds on surfaces.").in({0, 1000})),
        key_row(&Sky::visible,
                boolean_key("visible", "false makes the background black; the ambient light stays.")),
        key_row_if_given(
            &Sky::occlusion,
            boolean_key("occlusion",
                        "Whether what stands before the sky keeps its light off. true, the default of all "
                        "but gradients: light comes from `samples` directions, with exact shadows; what is "
                        "mirrored of it is dimmed as much of it as is hidden. false: it reaches every "
                        "surface, in closed rooms, too, as if nothing stood anywhere, and costs nothing.")),
    };
    return rows;
}

}  // namespace

const TableSpec& material_table() {
    static const TableSpec spec{
        "[material.NAME]",
        "A surface: Lambert and GGX with the metallic-roughness parameters. Meshes name it by NAME.",
        keys_of(material_rows()),
        "",
        {}};
    return spec;
}

const TableSpec& sky_table() {
    static const TableSpec spec{
        "[sky]", "The sky: background, and the light that it sheds.", keys_of(sky_rows()), "", {}};
    return spec;
}

Material material_of(const std::string& name, const SceneTable& table) {
    Material m;
    m.name = name;
    read_rows(material_rows(), table, m);
    if (text(table, "color_space") == "srgb") {
        const Vec3d c = vec3(table, "base_color");
        m.base_color = to_float(Vec3d{srgb_decode(c.x), srgb_decode(c.y), srgb_decode(c.z)});
    }
    return m;
}

Sky sky_of(const SceneDocument& document) {
    Sky sky;
    read_rows(sky_rows(), subtable(document.root, "sky"), sky);
    return sky;
}

}  // namespace obscura
