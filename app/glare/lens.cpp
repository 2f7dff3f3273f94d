#include "app/glare/lens.h"

#include <optional>

#include "app/scene/aperture_file.h"
#include "core/error.h"
#include "core/num.h"
#include "optics/aperture_dirt.h"
#include "optics/aperture_shapes.h"

namespace obscura {
double pupil_m(const OpticsSettings& optics) {
    return 1e-3 * optics.focal_length_mm / optics.f_number;
}

double pixel_m(const OpticsSettings& optics, const RenderSettings& render) {
    return 1e-3 * optics.sensor_height_mm / render.height;
}

Aperture lens_aperture(const OpticsSettings& optics) {
    Aperture aperture;
    if (optics.from_file) {
        aperture = scaled_aperture(square_opening(optics.mask.view()), {std::nullopt, pupil_m(optics)});
    } else {
        aperture = make_aperture(optics.shape, optics.mask_px, pupil_m(optics));
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
    params.light = optics.light;
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
