// Flags of `obscura diffraction`.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "app/cli/diffraction_command.h"
#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/scene/aperture_file.h"
#include "app/scene/dirt_rows.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr double default_decades = 7;

constexpr std::array far_methods = {
    FarFieldMethod::automatic, FarFieldMethod::direct,     FarFieldMethod::shift,
    FarFieldMethod::gemm,      FarFieldMethod::edges,      FarFieldMethod::levels,
    FarFieldMethod::runs,      FarFieldMethod::raster_fft, FarFieldMethod::polygon,
};
constexpr std::array near_methods = {NearFieldMethod::automatic, NearFieldMethod::direct,
                                     NearFieldMethod::two_pass,  NearFieldMethod::edges,
                                     NearFieldMethod::hybrid,    NearFieldMethod::fft};
constexpr std::array far_spectrum_modes = {SpectralMethod::exact, SpectralMethod::lookup,
                                           SpectralMethod::batch};
constexpr std::array near_spectrum_modes = {NearFieldColour::exact, NearFieldColour::scaled};
constexpr std::array shape_kinds = {ApertureKind::iris,    ApertureKind::circle,  ApertureKind::box,
                                    ApertureKind::whirl,   ApertureKind::annulus, ApertureKind::slit,
                                    ApertureKind::grating, ApertureKind::hexagons};

/// The one of `values` that `name_of` calls `text`.
template <class T, std::size_t n, class NameOf>
T named_value(const std::string& flag, const std::string& text, const std::array<T, n>& values,
              NameOf&& name_of) {
    std::vector<std::string> names;
    for (const T value : values) {
        if (text == name_of(value)) return value;
        names.emplace_back(name_of(value));
    }
    throw UsageError(
        fmt::format("{}: '{}' is not one of {}{}", flag, text, fmt::join(names, ", "), hint(text, names)));
}

/// A number in [low, high] or near it: what lies outside is left to a judge who has more to say. No number at
/// all is told that range.
double number_to_judge(const std::string& flag, const std::string& text, double low, double high) {
    try {
        return real_number(flag, text, -1e300, 1e300);
    } catch (const UsageError&) {
        return real_number(flag, text, low, high);
    }
}

/// Numbers of a flag that people give in other units than it says.
double wavelength_value(double nm) {
    if (nm >= 10 && nm <= 1e6) return nm;
    std::string text = fmt::format("--wavelength-nm: {} nm is not from 10 to 1e6", nm);
    for (const double unit : {1e3, 1e9}) {
        if (nm * unit >= 100 && nm * unit <= 1e5) text += fmt::format("; did you mean {:.6g} nm?", nm * unit);
    }
    throw UsageError(text);
}

LightSpectrum spectrum_value(const std::string& flag, const std::string& text) {
    LightSpectrum light;
    if (text == "d65") return light.source = LightSource::d65, light;
    if (text == "equal") return light.source = LightSource::equal, light;
    if (text == "sodium") return light.source = LightSource::sodium, light;
    if (text == "rgb_led") return light.source = LightSource::rgb_led, light;
    const std::string body = "blackbody:";
    if (text.rfind(body, 0) == 0) {
        light.source = LightSource::blackbody;
        light.kelvin = real_number(flag, text.substr(body.size()), 500, 1e6);
        return light;
    }
    throw UsageError(fmt::format("{}: '{}' is not one of d65, equal, blackbody:KELVIN, sodium, rgb_led{}",
                                 flag, text,
                                 hint(text, {"d65", "equal", "blackbody:6500", "sodium", "rgb_led"})));
}

Vec2d centre_value(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) throw UsageError("--centre: '" + text + "' is not like 12.5,-3");
    return {real_number("--centre", text.substr(0, comma), -1e6, 1e6),
            real_number("--centre", text.substr(comma + 1), -1e6, 1e6)};
}

/// What the flags hold before they are judged together.
struct Texts {
    std::string aperture, near, wavelength, spectrum, centre = "0,0", method = "automatic", stats,
                                                      isa = "auto";
    std::string diameter, pitch, occluder = "none", spectrum_mode;
    bool far = false, log = false, linear = false, overwrite = false;
    double decades = 0;
    std::int64_t mask = 1024, size = 1024, finest = 0, blades = 7, lines = 16, slits = 1, vanes = 4,
                 rings = 2, wavelengths = 0, memory = 4096, threads = 0;
    std::map<std::string, std::int64_t> dirt_counts;
};

void add_aperture_flags(Flags& flags, Texts& t, ApertureShape& shape) {
    flags.positional("APERTURE", t.aperture,
                     "iris, circle, box, whirl, annulus, slit, grating or hexagons; or a mask, white = open "
                     "(.png, .pbm, .pgm).");
    flags.group("Aperture");
    flags.whole("--mask-size", "N", t.mask, 1, 32768, "Texels a side of a shape's mask.", "1024");
    flags.text(
        "--diameter-mm", "MM", t.diameter,
        "Diameter of the shape, which takes 0.9 of its mask, or of what a mask leaves open (the longer "
        "side), millimetres.",
        "5");
    flags.text("--pitch-um", "UM", t.pitch, "Instead of that: side of a texel, micrometres.", "none");
    flags.whole("--blades", "N", t.blades, 3, 64, "iris, whirl: number of blades.", "7");
    flags.number("--rotation-deg", "DEG", shape.rotation_deg, -36000, 36000,
                 "Turns the shape, clockwise, degrees.", "0");
    flags.number("--bow", "SHARE", shape.bow, 0, 1, "iris: 0 straight blades, 1 a full circle.", "0");
    flags.number("--aspect", "RATIO", shape.aspect, 1.0 / 64, 64, "box: height / width.", "1");
    flags.number("--obstruction", "SHARE", shape.obstruction, 0, 0.99,
                 "annulus: diameter of the mirror in its middle.", "0.3");
    flags.whole("--vanes", "N", t.vanes, 0, 64, "annulus: how many hold that mirror.", "4");
    flags.whole("--slits", "N", t.slits, 1, 1024, "slit: how many side by side.", "1");
    flags.whole("--lines", "N", t.lines, 1, 4096, "grating: number of openings.", "16");
    flags.whole("--rings", "N", t.rings, 1, 32, "hexagons: rings of segments around the missing one.", "2");
    flags.whole("--finest-level", "N", t.finest, 0, 12,
                "Use the mask at 1 / 2^N of its size, each texel open or closed.", "0");
}

/// A key's default as the help shows it.
std::string flag_default(const SceneValue& value) {
    const auto* word = std::get_if<std::string>(&value.data);
    if (word != nullptr) return *word;
    const auto* whole = std::get_if<std::int64_t>(&value.data);
    return whole != nullptr ? fmt::format("{}", *whole) : fmt::format("{}", std::get<double>(value.data));
}

std::string flag_of(const KeySpec& key) {
    std::string flag = "--" + key.name;
    std::replace(flag.begin(), flag.end(), '_', '-');
    return flag;
}

/// Numbers that a key may only approach begin here.
constexpr double least_share = 1e-6;

/// Counts and the occluder are taken from `t` once the flags are read.
void add_dirt_flags(Flags& flags, Texts& t, LensDirt& dirt) {
    flags.group("Dirt; lengths are shares of the mask's longer side");
    for (const DirtRow& row : dirt_rows()) {
        const KeySpec& key = row.row.key;
        const std::string flag = flag_of(key), shown = flag_default(*key.fallback);
        const auto low = static_cast<std::int64_t>(key.range.lo),
                   high = static_cast<std::int64_t>(key.range.hi);
        if (const auto* real = std::get_if<double LensDirt::*>(&row.member)) {
            flags.number(flag, row.flag_value, dirt.**real, key.range.open_lo ? least_share : key.range.lo,
                         key.range.hi, row.flag_doc, shown);
        } else if (const auto* whole = std::get_if<std::int64_t LensDirt::*>(&row.member)) {
            flags.whole(flag, row.flag_value, dirt.**whole, low, high, row.flag_doc, shown);
        } else if (std::holds_alternative<int LensDirt::*>(row.member)) {
            flags.whole(flag, row.flag_value, t.dirt_counts[key.name], low, high, row.flag_doc, shown);
        } else {
            flags.text(flag, row.flag_value, t.occluder, row.flag_doc, shown);
        }
    }
}

void set_dirt(const Texts& t, LensDirt& dirt) {
    for (const DirtRow& row : dirt_rows()) {
        if (const auto* count = std::get_if<int LensDirt::*>(&row.member))
            dirt.** count = static_cast<int>(t.dirt_counts.at(row.row.key.name));
    }
    std::array<Occluder, std::size(occluder_words)> kinds;
    std::transform(std::begin(occluder_words), std::end(occluder_words), kinds.begin(),
                   [](const Word<Occluder>& word) { return word.value; });
    dirt.occluder = named_value("--occluder", t.occluder, kinds,
                                [](Occluder kind) { return name_of(occluder_words, kind); });
}

void add_pattern_flags(Flags& flags, Texts& t, DiffractionOptions& options) {
    flags.group("Pattern");
    flags.on_off("--far", t.far, "Far field (Fraunhofer), which is the default.");
    flags.text("--near", "MM", t.near,
               "Near field (Fresnel) at this distance, millimetres. The Fresnel number that is told is a^2 / "
               "(wavelength x distance), a half the longer side of what is open: the radius of a round hole.",
               "off");
    flags.text("--wavelength-nm", "NM", t.wavelength, "Light of one wavelength, nanometres.", "550");
    flags.text("--spectrum", "LIGHT", t.spectrum,
               "Light of many: d65, equal, blackbody:KELVIN, sodium or rgb_led; the pattern has colours.",
               "none");
    flags.whole("--wavelengths", "N", t.wavelengths, 1, 4096, "Wavelengths of a spectrum.",
                "as many as the picture needs");
    flags.text(
        "--spectrum-mode", "MODE", t.spectrum_mode,
        "far: exact, full60 (one pattern, looked up at 60 scales) or batch4 (at 15, four at a time); near: "
        "exact or scaled (from one wavelength's).",
        "exact, every wavelength's own pattern");
    flags.whole("--size", "N", t.size, 1, 1048576, "Pixels a side.", "1024");
    flags.number("--zoom", "X", options.zoom, 1e-3, 1e6,
                 "1: far, all frequencies up to half a cycle per texel; near, the longer side of the mask.",
                 "far, a power of two that shows 56 to 112 fringes on either side; near, 1");
    flags.text(
        "--centre", "U,V", t.centre,
        "Middle of the picture, right and down: far, cycles per longer side of the mask; near, such sides.",
        "0,0");
    flags.text("--method", "METHOD", t.method,
               "far: direct, shift, gemm, edges, levels, runs, raster_fft, polygon; near: direct, two_pass, "
               "edges, hybrid, fft.",
               "automatic, the cheapest");
    flags.number("--cull", "SHARE", options.far.cull, 0, 1,
                 "Blocks of pixels that nowhere exceed this share of the brightest become 0.", "0, none");
}

void add_output_flags(Flags& flags, Texts& t, DiffractionOptions& options) {
    flags.group("Output");
    flags.list(
        "-o,--output", "FILE", options.outputs,
        "Picture (.png) or numbers (.pfm: power relative to the whole opening's, or to the open wave's, "
        "or linear sRGB); may be given again. diffraction.png when not given.");
    flags.on_off("--amplitude", options.amplitude,
                 "Also write real and imaginary parts, NAME.re.pfm and so on.");
    flags.on_off("--log", t.log, "PNG shows powers of ten; the default of far fields.");
    flags.on_off("--linear", t.linear, "PNG shows power itself; the default of near fields.");
    flags.number("--decades", "DECADES", t.decades, 0.1, 30, "How many powers of ten --log shows.", "7");
    flags.on_off("--overwrite", t.overwrite, "Replace files that exist; otherwise they are an error.");
    flags.on_off("--plan", options.plan_only, "Only print what would be computed, and how.");
    flags.text("--stats-json", "FILE", t.stats,
               "Write plan, counts and times (s) as JSON; - is standard output, where the plan then is not.",
               "none");
    flags.whole("--limit-memory", "MIB", t.memory, 1, 1 << 24, "Refuse what needs more memory, MiB.", "4096");
    add_exec_flags(flags, t.threads, t.isa);
}

/// Flags of shapes that `shape` does not have, or a mask file, would change nothing.
void check_shape_flags(const Texts& t, const ApertureShape& shape, bool from_file) {
    const ApertureShape plain;
    const auto needs = [&](const char* flag, bool differs, std::initializer_list<ApertureKind> kinds) {
        if (!differs || (!from_file && std::find(kinds.begin(), kinds.end(), shape.kind) != kinds.end()))
            return;
        std::vector<std::string> names;
        for (const ApertureKind kind : kinds)
            names.emplace_back(aperture_kind_name(kind));
        throw UsageError(fmt::format("{} is of {}, not of {}", flag, fmt::join(names, " and "),
                                     from_file ? "mask files" : aperture_kind_name(shape.kind)));
    };
    needs("--blades", t.blades != plain.blades, {ApertureKind::iris, ApertureKind::whirl});
    needs("--bow", shape.bow != plain.bow, {ApertureKind::iris});
    needs("--aspect", shape.aspect != plain.aspect, {ApertureKind::box});
    needs("--obstruction", shape.obstruction != plain.obstruction, {ApertureKind::annulus});
    needs("--vanes", t.vanes != plain.vanes, {ApertureKind::annulus});
    needs("--slits", t.slits != plain.slits, {ApertureKind::slit});
    needs("--lines", t.lines != plain.lines, {ApertureKind::grating});
    needs("--rings", t.rings != plain.rings, {ApertureKind::hexagons});
    if (!from_file) return;
    if (shape.rotation_deg != 0) throw UsageError("--rotation-deg is of shapes, not of mask files");
    if (t.mask != Texts{}.mask) throw UsageError("--mask-size is of shapes, not of mask files");
}

void set_width(const Texts& t, DiffractionOptions& options) {
    if (!t.diameter.empty() && !t.pitch.empty())
        throw UsageError("give either --diameter-mm or --pitch-um, not both");
    if (!t.diameter.empty()) options.diameter_m = 1e-3 * real_number("--diameter-mm", t.diameter, 1e-6, 1e9);
    if (t.pitch.empty()) return;
    if (t.pitch.find_first_of("x,") != std::string::npos)
        throw UsageError(fmt::format("--pitch-um: '{}': texels must be square; give one number", t.pitch));
    options.pitch_m = 1e-6 * real_number("--pitch-um", t.pitch, 1e-6, 1e12);
}

void set_light(const Texts& t, DiffractionOptions& options) {
    if (!t.wavelength.empty() && !t.spectrum.empty())
        throw UsageError("give either --wavelength-nm or --spectrum, not both");
    if (!t.wavelength.empty()) {
        options.wavelength_nm = wavelength_value(number_to_judge("--wavelength-nm", t.wavelength, 10, 1e6));
    }
    if (!t.spectrum.empty()) options.spectrum = spectrum_value("--spectrum", t.spectrum);
    if (t.wavelengths > 0 && t.spectrum.empty()) throw UsageError("--wavelengths needs --spectrum");
    options.wavelengths = static_cast<int>(t.wavelengths);
}

void set_spectrum_mode(const Texts& t, DiffractionOptions& options) {
    if (t.spectrum_mode.empty()) return;
    if (t.spectrum.empty()) throw UsageError("--spectrum-mode needs --spectrum");
    if (options.near_m) {
        options.near_colour =
            named_value("--spectrum-mode", t.spectrum_mode, near_spectrum_modes, near_field_colour_name);
        return;
    }
    options.far_colour =
        named_value("--spectrum-mode", t.spectrum_mode, far_spectrum_modes, spectral_method_name);
    if (options.far_colour != SpectralMethod::exact && t.wavelengths > 0)
        throw UsageError(
            fmt::format("--wavelengths is of --spectrum-mode exact, not of {}", t.spectrum_mode));
}

void set_field(const Texts& t, DiffractionOptions& options) {
    if (!t.near.empty()) {
        if (t.far) throw UsageError("give either --far or --near, not both");
        constexpr double nearest_mm = 1e-9, farthest_mm = 1e15;
        const double z_mm = number_to_judge("--near", t.near, nearest_mm, farthest_mm);
        if (!(z_mm > 0))
            throw UsageError(
                fmt::format("--near: {} mm is not in front of the aperture; give a distance above 0", z_mm));
        options.near_m = 1e-3 * real_number("--near", t.near, nearest_mm, farthest_mm);
        options.near_method = named_value("--method", t.method, near_methods, near_field_method_name);
    } else {
        options.far.method = named_value("--method", t.method, far_methods, far_field_method_name);
    }
    if (t.log && t.linear) throw UsageError("give either --log or --linear, not both");
    if (t.decades > 0 && t.linear) throw UsageError("--decades is of --log, not of --linear");
    options.view.logarithmic = t.log || t.decades > 0 || (!t.linear && !options.near_m);
    options.view.decades = t.decades > 0 ? t.decades : default_decades;
}

}  // namespace

int run_diffraction(const Arguments& arguments) {
    Flags flags(
        "diffraction [options] APERTURE",
        "Computes the pattern of light behind an aperture, far away or at a distance, and prints which "
        "method is the cheapest and why. Coordinates: x right, y down. Flags may have _ for -.");
    DiffractionOptions options;
    Texts t;
    ApertureShape shape;
    add_aperture_flags(flags, t, shape);
    add_dirt_flags(flags, t, options.dirt);
    add_pattern_flags(flags, t, options);
    add_output_flags(flags, t, options);
    Arguments dashed = arguments;
    for (std::string& a : dashed) {
        if (a.rfind("--", 0) == 0)
            std::replace(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.find('='), a.size())),
                         '_', '-');
    }
    if (!flags.parse(dashed)) return 0;

    options.aperture = t.aperture;
    if (names_mask_file(t.aperture)) {
        options.mask_file = t.aperture;
    } else {
        shape.kind = named_value("APERTURE", t.aperture, shape_kinds, aperture_kind_name);
    }
    check_shape_flags(t, shape, names_mask_file(t.aperture));
    shape.blades = static_cast<int>(t.blades);
    shape.vanes = static_cast<int>(t.vanes);
    shape.rings = static_cast<int>(t.rings);
    shape.slits = static_cast<int>(t.slits);
    shape.lines = static_cast<int>(t.lines);
    options.shape = shape;
    set_dirt(t, options.dirt);
    options.mask_px = static_cast<int>(t.mask);
    options.finest_level = static_cast<int>(t.finest);
    options.size_px = static_cast<int>(t.size);
    options.centre = centre_value(t.centre);
    set_width(t, options);
    set_light(t, options);
    set_field(t, options);
    set_spectrum_mode(t, options);
    if (options.outputs.empty()) options.outputs.emplace_back("diffraction.png");
    options.existing = t.overwrite ? Existing::replace : Existing::refuse;
    options.stats_json = t.stats;
    options.memory_mib = t.memory;
    options.exec = {isa_value("--isa", t.isa), static_cast<int>(t.threads)};
    return diffraction_command(options);
}

}  // namespace obscura
