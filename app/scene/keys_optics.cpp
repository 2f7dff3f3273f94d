// Keys of the lens as far as it diffracts.

#include "app/scene/keys.h"
#include "app/scene/scene.h"

namespace obscura {
namespace {

KeySpec rotation_key() {
    return number_key("rotation_deg", "Turns the shape, clockwise as the photographer sees it.")
        .in({-36000, 36000})
        .or_else(OpticsSettings{}.shape.rotation_deg)
        .animate();
}

KeySpec blades_key() {
    return integer_key("blades", "How many.")
        .in({3, 64})
        .or_else(std::int64_t{OpticsSettings{}.shape.blades});
}

std::vector<VariantSpec> aperture_variants() {
    static const OpticsSettings d;
    const auto count = [](const char* name, const char* doc, int low, int high, int fallback) {
        return integer_key(name, doc)
            .in({static_cast<double>(low), static_cast<double>(high)})
            .or_else(std::int64_t{fallback});
    };
    return {
        {"iris",
         "Straight or bowed blades around an opening.",
         {blades_key(),
          number_key("bow", "0: straight edges, 1: a circle.").in({0, 1}).or_else(d.shape.bow).animate(),
          rotation_key()}},
        {"circle", "Fully open.", {}},
        {"box",
         "A rectangle.",
         {number_key("aspect", "Height / width.").in({1.0 / 64, 64}).or_else(d.shape.aspect).animate(),
          rotation_key()}},
        {"whirl", "Curved openings around a hub.", {blades_key(), rotation_key()}},
        {"annulus",
         "A telescope: a circle less a central mirror and the vanes that hold it.",
         {number_key("obstruction", "Diameter of the mirror, share of the whole.")
              .in({0, 1, false, true})
              .or_else(d.shape.obstruction)
              .animate(),
          count("vanes", "How many.", 0, 64, d.shape.vanes), rotation_key()}},
        {"slit", "Parallel slits.", {count("slits", "How many.", 1, 1024, d.shape.slits), rotation_key()}},
        {"grating",
         "Lines side by side.",
         {count("lines", "How many.", 1, 4096, d.shape.lines), rotation_key()}},
        {"hexagons",
         "A segmented mirror.",
         {count("rings", "Rings of segments around the missing one in the middle.", 1, 32, d.shape.rings),
          rotation_key()}},
        {"file",
         "A mask; what it leaves open is as wide (its longer side) as the lens.",
         {file_key("file",
                   "PNG, PBM or PGM, relative to the scene file and inside its folder: white is open, black "
                   "closed, no colours, no transparency.")
              .need()}},
    };
}

std::vector<KeySpec> lens_keys() {
    static const OpticsSettings d;
    return {
        number_key("f_number", "Focal length / diameter of the aperture.")
            .in({0.1, 1000})
            .or_else(d.f_number)
            .animate(),
        number_key(
            "focal_length_mm",
            "Of the lens, for cameras that give vfov_deg; together with the angle of view it decides "
            "the size of the sensor, and so what a pixel is. Cameras that give a focal length have said it.")
            .in({0, 1e6, true}),
        number_key(
            "sensor_width_mm",
            "Instead of that; a sensor 24 mm high when neither is given. Both must fit the angle of view.")
            .in({0, 1e6, true}),
        number_key("clip",
                   "Radiance, after exposure, of the brightest that the sensor shows: pixels above it "
                   "(their largest channel) glare.")
            .in({0, 1e9, true})
            .or_else(d.clip)
            .animate(),
        integer_key("mask_px", "Texels a side of a shape's mask.")
            .one_of({64, 128, 256, 512, 1024, 2048, 4096})
            .or_else(std::int64_t{d.mask_px}),
    };
}

KeySpec count_key(const char* name, const char* doc, int most) {
    return integer_key(name, doc).in({0, static_cast<double>(most)}).or_else(std::int64_t{0});
}

std::vector<KeySpec> dirt_keys() {
    static const LensDirt d;
    return {
        integer_key("seed", "Where noise, dust, scratches and eyelashes are follows from it.")
            .in({0, 4294967295.0})
            .or_else(d.seed),
        number_key("noise", "Smears: most of the amplitude that they take away; half of it on average.")
            .in({0, 1})
            .or_else(d.noise),
        number_key("noise_cell", "Size of the largest smears, share of the lens.")
            .in({1.0 / 1024, 1})
            .or_else(d.noise_cell),
        number_key("noise_stretch", "Length / width of smears.").in({1, 64}).or_else(d.noise_stretch),
        number_key("noise_angle_deg", "Direction of their length, clockwise from the right.")
            .in({-36000, 36000})
            .or_else(d.noise_angle_deg),
        count_key(
            "dust",
            "Grains on the lens. Dirt makes the pattern as coarse as mask_px: it fades out near a third of a "
            "cycle per texel.",
            10000),
        number_key("dust_radius", "Of the largest, share of the lens.")
            .in({0, 0.5, true})
            .or_else(d.dust_radius),
        number_key("dust_softness", "0: hard edges, 1: they fade from the middle on.")
            .in({0, 1})
            .or_else(d.dust_softness),
        count_key("scratches", "Dark lines, slightly curved.", 10000),
        number_key("scratch_width", "Of the widest, share of the lens.")
            .in({0, 0.1, true})
            .or_else(d.scratch_width),
        number_key("scratch_length", "Of the longest, share of the lens.")
            .in({0, 2, true})
            .or_else(d.scratch_length),
        number_key("scratch_spread_deg", "Their directions lie this far around the vertical; 180: all.")
            .in({0, 180})
            .or_else(d.scratch_spread_deg),
        count_key("eyelashes", "Hairs that hang down before the lens.", 1000),
        number_key("eyelash_width", "At the root, share of the lens.")
            .in({0, 0.1, true})
            .or_else(d.eyelash_width),
        number_key("eyelash_length", "Of the longest, share of the lens.")
            .in({0, 2, true})
            .or_else(d.eyelash_length),
        choice_key(
            "occluder", {"none", "housing", "disc"},
            "A circle moved over the opening: light passes inside it only (housing: the lens's barrel seen "
            "from the side, a cat's eye) or outside it only (disc).")
            .or_else("none"),
        number_key("occluder_diameter", "Share of the lens.")
            .in({0, 4, true})
            .or_else(d.occluder_diameter)
            .animate(),
        number_key("occluder_x", "Of its middle, to the right of the lens's; share of the lens.")
            .in({-2, 2})
            .or_else(d.occluder_x)
            .animate(),
        number_key("occluder_y", "The same, down.").in({-2, 2}).or_else(d.occluder_y).animate(),
    };
}

std::vector<KeySpec> glare_keys() {
    static const OpticsSettings d;
    return {
        choice_key("light", {"d65", "equal", "blackbody", "sodium", "rgb_led"},
                   "Whose wavelengths the pattern is made of. Sources keep their own colours; this says how "
                   "each channel spreads.")
            .or_else("d65"),
        number_key("temperature_kelvin", "Of light = \"blackbody\".")
            .in({500, 1e6})
            .or_else(d.light.kelvin)
            .animate(),
        integer_key("wavelengths", "How many; \"auto\": as many as radius and tolerance need.")
            .in({1, 4096})
            .or_word("auto")
            .or_else("auto"),
        number_key("tolerance", "Error of the pattern's colours that \"auto\" aims at.")
            .in({1e-4, 0.5})
            .or_else(d.tolerance),
        integer_key("radius_px", "How far light spreads; what would fall farther is counted in by scaling.")
            .in({1, 4096})
            .or_else(std::int64_t{d.radius_px}),
        integer_key("bloom_scale",
                    "More than 1: what lies farther than twice this many pixels from its source is computed "
                    "at this fraction of the resolution.")
            .one_of({1, 2, 4, 8})
            .or_else(std::int64_t{d.bloom_scale}),
        choice_key(
            "visibility", {"open", "exact", "neighbours"},
            "Which part of the lens the lamps see (objects whose material clips by itself). open: all of it. "
            "exact: what the scene's triangles do not hide, from the point that each pixel shows. "
            "neighbours: the pixels around the source stand for the lens, and those that do not clip "
            "hide it; cheap, and right only for lamps far behind what hides them.")
            .or_else("open"),
        integer_key("visibility_samples", "Patterns per lamp at most; pixels share the most similar one.")
            .in({1, 256})
            .or_else(std::int64_t{d.visibility_samples}),
        integer_key("neighbourhood_px", "With \"neighbours\": how far the lens reaches around a pixel.")
            .in({1, 64})
            .or_else(std::int64_t{d.neighbourhood_px}),
        number_key(
            "focus_m",
            "Distance along the view axis that is sharp: sources before and behind it show the near field "
            "of the aperture, with its rings. The picture itself stays sharp. Everything is in focus "
            "when not given.")
            .in({0, 1e9, true})
            .animate(),
        integer_key("focus_steps", "How many near fields at most, over the sources' range of 1 / distance.")
            .in({1, 256})
            .or_else(std::int64_t{d.focus_steps}),
    };
}

}  // namespace

const TableSpec& optics_table() {
    static const TableSpec spec = [] {
        TableSpec s{"[optics]",
                    "The lens as far as it diffracts: pixels brighter than the sensor can show spread by the "
                    "pattern of its aperture, in its true size. There is no glare without this table.",
                    {},
                    "aperture",
                    aperture_variants()};
        std::vector<std::string> names;
        for (const VariantSpec& variant : s.variants)
            names.push_back(variant.name);
        s.keys.push_back(choice_key("aperture", names, "The opening's shape.").or_else("iris"));
        for (KeySpec& key : lens_keys())
            s.keys.push_back(std::move(key));
        for (KeySpec& key : dirt_keys())
            s.keys.push_back(std::move(key));
        for (KeySpec& key : glare_keys())
            s.keys.push_back(std::move(key));
        return s;
    }();
    return spec;
}

}  // namespace obscura
