#include "app/lens.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "app/aperture_file.h"
#include "app/progress.h"
#include "core/error.h"
#include "core/num.h"
#include "optics/aperture_dirt.h"
#include "optics/aperture_shapes.h"

namespace obscura {
namespace {

constexpr double mean_wavelength_m = 550e-9;

ApertureKind kind_of(const std::string& name) {
    for (const ApertureKind kind :
         {ApertureKind::iris, ApertureKind::circle, ApertureKind::box, ApertureKind::whirl,
          ApertureKind::annulus, ApertureKind::slit, ApertureKind::grating, ApertureKind::hexagons}) {
        if (name == aperture_kind_name(kind)) return kind;
    }
    CHECK(false, "no aperture " + name);
    return {};
}

/// The mask's side is the pupil's diameter, so shapes fill it.
ApertureShape shape_of(const OpticsSettings& o) {
    ApertureShape shape;
    shape.kind = kind_of(o.aperture);
    shape.diameter = 1;
    shape.rotation_deg = o.rotation_deg;
    shape.blades = o.blades;
    shape.bow = o.bow;
    shape.aspect = o.aspect;
    shape.obstruction = o.obstruction;
    shape.vanes = o.vanes;
    shape.slits = o.slits;
    shape.lines = o.lines;
    shape.rings = o.rings;
    return shape;
}

LightSource source_of(const std::string& name) {
    constexpr std::array<std::pair<const char*, LightSource>, 5> names = {
        {{"d65", LightSource::d65},
         {"equal", LightSource::equal},
         {"blackbody", LightSource::blackbody},
         {"sodium", LightSource::sodium},
         {"rgb_led", LightSource::rgb_led}}};
    for (const auto& [text, source] : names) {
        if (name == text) return source;
    }
    CHECK(false, "no light " + name);
    return {};
}

std::string duration(double ms) {
    return ms < 1000 ? fmt::format("{:.2g} ms", ms) : duration_text(1e-3 * ms);
}

std::string aperture_text(const OpticsSettings& o) {
    const char* dirt = has_dirt(o.dirt) ? ", not clean" : "";
    if (o.aperture == "file")
        return fmt::format("mask of {} x {} texels{}", o.mask.width, o.mask.height, dirt);
    if (o.aperture == "iris" || o.aperture == "whirl")
        return fmt::format("{} of {} blades{}", o.aperture, o.blades, dirt);
    return o.aperture + dirt;
}

double mib(std::int64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

double pupil_m(const OpticsSettings& optics) {
    return 1e-3 * optics.focal_length_mm / optics.f_number;
}

double pixel_m(const OpticsSettings& optics, const RenderSettings& render) {
    return 1e-3 * optics.sensor_height_mm / render.height;
}

Aperture lens_aperture(const OpticsSettings& optics) {
    Aperture aperture;
    if (optics.aperture == "file") {
        aperture = scaled_aperture(square_opening(optics.mask.view()), {std::nullopt, pupil_m(optics)});
    } else {
        aperture = make_aperture(shape_of(optics), optics.mask_px, pupil_m(optics));
    }
    add_dirt(optics.dirt, aperture);
    if (!(open_area(aperture.mask.view()) > 0))
        throw InputError("[optics]", "the aperture is closed: no texel lets light through");
    return aperture;
}

PsfParams psf_params(const OpticsSettings& optics, const RenderSettings& render) {
    PsfParams params;
    params.focal_length_m = 1e-3 * optics.focal_length_mm;
    params.f_number = optics.f_number;
    params.pixel_m = pixel_m(optics, render);
    params.radius_px = optics.radius_px;
    params.light.source = source_of(optics.light);
    params.light.kelvin = optics.temperature_kelvin;
    params.wavelengths = optics.wavelengths;
    params.tolerance = optics.tolerance;
    return params;
}

GlareParams glare_params(const OpticsSettings& optics, const RenderSettings& render) {
    return {optics.clip * num::exp2(-render.exposure_ev), optics.bloom_scale};
}

int kernel_side(const OpticsSettings& optics) {
    return 2 * optics.radius_px + 1;
}

std::string lens_text(const OpticsSettings& o, const RenderSettings& render) {
    if (!o.enabled) return "";
    const PsfParams params = psf_params(o, render);
    const double cycles = params.pixel_m / (mean_wavelength_m * params.f_number);
    std::string out = fmt::format(
        "optics    {}, {:.4g} mm at f/{:.4g} (pupil {:.4g} mm), sensor {:.4g} x {:.4g} mm, pixels of {:.4g} "
        "um\n",
        aperture_text(o), o.focal_length_mm, o.f_number, 1e3 * pupil_m(o),
        o.sensor_height_mm * render.width / render.height, o.sensor_height_mm, 1e6 * params.pixel_m);
    const int side = kernel_side(o);
    out += fmt::format(
        "glare     above {:.4g} after exposure: {} x {} pixels, {:.4g} cycles of the pupil a pixel "
        "(550 nm), {} light\n",
        o.clip, side, side, cycles, o.light);
    const PsfPlan plan = plan_far_field_psf(lens_aperture(o), params);
    out += fmt::format(
        "          its pattern: {} at {:.4g} million frequencies, {} wavelengths, about {} on one thread\n",
        far_field_method_name(plan.method), 1e-6 * static_cast<double>(plan.frequencies), plan.wavelengths,
        duration(plan.cost_ms));
    const GlareCost cost = most_glare(render.width, render.height, side, glare_params(o, render));
    return out + fmt::format(
                     "          at most {:.4g} ms and {:.4g} MiB to spread it (one thread, every pixel "
                     "bright); nothing when none is\n",
                     cost.ms, mib(cost.bytes));
}

}  // namespace obscura
