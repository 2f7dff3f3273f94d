// [optics]: the lens as far as it diffracts.

#include <algorithm>
#include <optional>

#include "app/scene/build.h"
#include "app/scene/dirt_rows.h"
#include "app/scene/key_row.h"
#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "core/num.h"

namespace obscura {
namespace {

// --- the aperture

/// A value of the key `aperture`.
struct ApertureRow {
    std::optional<ApertureKind> kind;  ///< none: a mask from a file
    const char* doc;
    KeyRows<ApertureShape> keys;

    const char* name() const { return kind ? aperture_kind_name(*kind) : "file"; }
};

const std::vector<ApertureRow>& apertures() {
    using Shape = ApertureShape;
    const KeyRow<Shape> rotation =
        key_row(&Shape::rotation_deg,
                number_key("rotation_deg", "Turns the shape, clockwise as the photographer sees it.")
                    .in({-36000, 36000})
                    .animate());
    const auto count = [](int Shape::*member, const char* name, const char* doc, int low, int high) {
        return key_row(member,
                       integer_key(name, doc).in({static_cast<double>(low), static_cast<double>(high)}));
    };
    const KeyRow<Shape> blades = count(&Shape::blades, "blades", "How many.", 3, 64);
    static const std::vector<ApertureRow> all{
        {ApertureKind::iris,
         "Straight or bowed blades around an opening.",
         {blades,
          key_row(&Shape::bow, number_key("bow", "0: straight edges, 1: a circle.").in({0, 1}).animate()),
          rotation}},
        {ApertureKind::circle, "Fully open.", {}},
        {ApertureKind::box,
         "A rectangle.",
         {key_row(&Shape::aspect, number_key("aspect", "Height / width.").in({1.0 / 64, 64}).animate()),
          rotation}},
        {ApertureKind::whirl, "Curved openings around a hub.", {blades, rotation}},
        {ApertureKind::annulus,
         "A telescope: a circle less a central mirror and the vanes that hold it.",
         {key_row(&Shape::obstruction,
                  number_key("obstruction", "Diameter of the mirror, share of the whole.")
                      .in({0, 1, false, true})
                      .animate()),
          count(&Shape::vanes, "vanes", "How many.", 0, 64), rotation}},
        {ApertureKind::slit,
         "Parallel slits.",
         {count(&Shape::slits, "slits", "How many.", 1, 1024), rotation}},
        {ApertureKind::grating,
         "Lines side by side.",
         {count(&Shape::lines, "lines", "How many.", 1, 4096), rotation}},
        {ApertureKind::hexagons,
         "A segmented mirror.",
         {count(&Shape::rings, "rings", "Rings of segments around the missing one in the middle.", 1, 32),
          rotation}},
        {std::nullopt,
         "A mask; what it leaves open is as wide (its longer side) as the lens.",
         {{file_key("file",
                    "PNG, PBM or PGM, relative to the scene file and inside its folder: white is open, black "
                    "closed, no colours, no transparency.")
               .need()}}},
    };
    return all;
}

void read_aperture(const SceneTable& table, OpticsSettings& o) {
    const ApertureRow& aperture =
        *std::find_if(apertures().begin(), apertures().end(),
                      [&](const ApertureRow& row) { return text(table, "aperture") == row.name(); });
    o.from_file = !aperture.kind;
    if (aperture.kind) o.shape.kind = *aperture.kind;
    read_rows(aperture.keys, table, o.shape);
}

// --- the lens, its dirt, its glare

/// A length of the lens or its sensor, with the camera's angle of view, says how large pixels are.
const KeyRows<OpticsSettings>& lens_rows() {
    static const KeyRows<OpticsSettings> rows{
        key_row(&OpticsSettings::f_number,
                number_key("f_number", "Focal length / diameter of the aperture.").in({0.1, 1000}).animate()),
        {number_key(
             "focal_length_mm",
             "Of the lens, for cameras that give vfov_deg; together with the angle of view it decides "
             "the size of the sensor, and so what a pixel is. Cameras that give a focal length have said it.")
             .in({0, 1e6, true})},
        {number_key(
             "sensor_width_mm",
             "Instead of that; a sensor 24 mm high when neither is given. Both must fit the angle of view.")
             .in({0, 1e6, true})},
        key_row(
            &OpticsSettings::clip,
            number_key("clip",
                       "Radiance, after exposure, of the brightest that the sensor shows: pixels above it "
                       "(their largest channel) glare, the more of their light the brighter they are, all "
                       "of it from twice as much on.")
                .in({0, 1e9, true})
                .animate()),
        key_row(&OpticsSettings::mask_px, integer_key("mask_px", "Texels a side of a shape's mask.")
                                              .one_of({64, 128, 256, 512, 1024, 2048, 4096})),
    };
    return rows;
}

KeyRows<LensDirt> dirt_keys() {
    KeyRows<LensDirt> keys;
    for (const DirtRow& dirt : dirt_rows())
        keys.push_back(dirt.row);
    return keys;
}

KeyRows<OpticsSettings> light_rows() {
    static const Word<LightSource> source_words[] = {
        {light_source_name(LightSource::d65), LightSource::d65},
        {light_source_name(LightSource::equal), LightSource::equal},
        {light_source_name(LightSource::blackbody), LightSource::blackbody},
        {light_source_name(LightSource::sodium), LightSource::sodium},
        {light_source_name(LightSource::rgb_led), LightSource::rgb_led},
    };
    return rows_within(
        &OpticsSettings::light,
        KeyRows<LightSpectrum>{
            word_row(
                &LightSpectrum::source, source_words, "light",
                "Whose wavelengths the pattern is made of. Sources keep their own colours; this says how "
                "each channel spreads."),
            key_row(&LightSpectrum::kelvin,
                    number_key("temperature_kelvin", "Of light = \"blackbody\".").in({500, 1e6}).animate()),
        });
}

constexpr Word<PupilVisibility> visibility_words[] = {{"open", PupilVisibility::open},
                                                      {"exact", PupilVisibility::exact},
                                                      {"neighbours", PupilVisibility::neighbours}};

const KeyRows<OpticsSettings>& glare_rows() {
    static const KeyRows<OpticsSettings> rows =
        light_rows() +
        KeyRows<OpticsSettings>{
            count_or_word_row(
                &OpticsSettings::wavelengths, "auto", 0,
                integer_key("wavelengths", "How many; \"auto\": as many as radius and tolerance need.")
                    .in({1, 4096})
                    .or_else("auto")),
            key_row(&OpticsSettings::tolerance,
                    number_key("tolerance", "Error of the pattern's colours that \"auto\" aims at.")
                        .in({1e-4, 0.5})),
            key_row(&OpticsSettings::radius_px,
                    integer_key("radius_px",
                                "How far light spreads; what would fall farther is counted in by scaling.")
                        .in({1, 4096})),
            count_or_word_row(
                &OpticsSettings::margin_px, "auto", auto_glare_margin,
                integer_key(
                    "margin_px",
                    "How much wider the picture is rendered on every side before it glares, so that what is "
                    "just outside of it glares into it. \"auto\": until what lies farther away cannot add a "
                    "500th of clip any more, an eighth of the picture's shorter side at most.")
                    .in({0, 4096})
                    .or_else("auto")),
            key_row(
                &OpticsSettings::bloom_scale,
                integer_key(
                    "bloom_scale",
                    "More than 1: what lies farther than twice this many pixels from its source is computed "
                    "at this fraction of the resolution.")
                    .one_of({1, 2, 4, 8})),
            word_row(
                &OpticsSettings::visibility, visibility_words, "visibility",
                "Which part of the lens the lamps see (objects whose material clips by itself). open: all of "
                "it. exact: what the scene's triangles do not hide, from the point that each pixel shows. "
                "neighbours: the pixels around the source stand for the lens, and those that do not clip "
                "hide it; cheap, and right only for lamps far behind what hides them."),
            key_row(&OpticsSettings::visibility_samples,
                    integer_key("visibility_samples",
                                "Patterns per lamp at most; pixels share the most similar one.")
                        .in({1, 256})),
            key_row(&OpticsSettings::neighbourhood_px,
                    integer_key("neighbourhood_px",
                                "With \"neighbours\": how far the lens reaches around a pixel.")
                        .in({1, 64})),
            key_row_if_given(
                &OpticsSettings::focus_m,
                number_key(
                    "focus_m",
                    "Distance along the view axis that is sharp: sources before and behind it show the near "
                    "field of the aperture, with its rings. The picture itself stays sharp. Everything is in "
                    "focus when not given.")
                    .in({1e-6, 1e9})
                    .animate()),
            key_row(&OpticsSettings::focus_steps,
                    integer_key("focus_steps",
                                "How many near fields at most, over the sources' range of 1 / distance.")
                        .in({1, 256})),
        };
    return rows;
}

const KeyRows<OpticsSettings>& optics_rows() {
    static const KeyRows<OpticsSettings> rows =
        lens_rows() + rows_within(&OpticsSettings::dirt, dirt_keys()) + glare_rows();
    return rows;
}

/// The angle of view is the camera's; one more length makes it a lens and a sensor.
void set_lens(const SceneTable& table, const SceneTable& camera, const RenderSettings& render,
              OpticsSettings& o) {
    if (camera.has("focal_length_mm")) {
        o.focal_length_mm = number(camera, "focal_length_mm");
        o.sensor_height_mm = number(camera, "sensor_height_mm");
        return;
    }
    const double height_per_focal = 2 * num::tan(number(camera, "vfov_deg") * (num::pi / 360));
    if (table.has("focal_length_mm")) {
        o.focal_length_mm = number(table, "focal_length_mm");
        o.sensor_height_mm = o.focal_length_mm * height_per_focal;
        return;
    }
    if (table.has("sensor_width_mm"))
        o.sensor_height_mm = number(table, "sensor_width_mm") * render.height / render.width;
    o.focal_length_mm = o.sensor_height_mm / height_per_focal;
}

}  // namespace

const TableSpec& optics_table() {
    static const TableSpec spec = [] {
        TableSpec s{"[optics]",
                    "The lens as far as it diffracts: pixels brighter than the sensor can show spread by the "
                    "pattern of its aperture, in its true size. There is no glare without this table.",
                    {},
                    "aperture",
                    {}};
        std::vector<std::string> names;
        for (const ApertureRow& aperture : apertures()) {
            s.variants.push_back({aperture.name(), aperture.doc, keys_of(aperture.keys)});
            names.emplace_back(aperture.name());
        }
        s.keys = {choice_key("aperture", names, "The opening's shape.")
                      .or_else(aperture_kind_name(ApertureShape{}.kind))};
        s.keys = s.keys + keys_of(optics_rows());
        return s;
    }();
    return spec;
}

OpticsSettings optics_of(const SceneDocument& document, double frame) {
    OpticsSettings o;
    if (!document.root.has("optics")) return o;
    const SceneTable table = optics_at(document, frame), camera = camera_at(document, frame);
    o.enabled = true;
    read_aperture(table, o);
    read_rows(optics_rows(), table, o);
    set_lens(table, camera, render_settings_of(document), o);
    return o;
}

}  // namespace obscura
