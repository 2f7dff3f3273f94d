#include "app/frame/lens.h"

#include <array>
#include <optional>
#include <utility>

#include "app/scene/aperture_file.h"
#include "core/error.h"
#include "core/num.h"
#include "optics/aperture_dirt.h"
#include "optics/aperture_shapes.h"

namespace obscura {
namespace {

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

}  // namespace obscura
