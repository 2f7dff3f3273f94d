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
        {file_key("texture", "PNG that multiplies base_color; sRGB, repeated outside [0, 1].")},
        key_row(
            &Material::translucency,
            number_key("translucency", "Share of light that passes thin sheets diffusely, as through leaves.")
                .in(unit_share)),
    };
    return rows;
}

const KeyRows<Sky>& sky_rows() {
    static const KeyRows<Sky> rows{
        key_row(&Sky::zenith,
                vec3_or_number_key("zenith_w_m2_sr", "Radiance straight above.").in(brightness)),
        key_row(&Sky::horizon,
                vec3_or_number_key("horizon_w_m2_sr", "Radiance at the horizon.").in(brightness)),
        key_row(&Sky::ground, vec3_or_number_key("ground_w_m2_sr", "Radiance from below.").in(brightness)),
        key_row(&Sky::ambient,
                number_key("ambient", "Scale of the light the sky sheds on surfaces.").in({0, 1000})),
        key_row(&Sky::visible,
                boolean_key("visible", "false makes the background black; the ambient light stays.")),
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
        "[sky]",
        "A gradient sky: background, and ambient light that reaches every surface without occlusion.",
        keys_of(sky_rows()),
        "",
        {}};
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
