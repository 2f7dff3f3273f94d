#include "lessons/plane_fields.h"

#include <algorithm>
#include <cmath>

#include "optics/far_field.h"

namespace obscura {

Aperture full_aperture(ApertureKind kind, int size) {
    ApertureShape shape;
    shape.kind = kind;
    shape.diameter = 1;
    return make_aperture(shape, size, 0.01);
}

NearFieldParams at_fresnel_number(const Aperture& aperture, double fresnel) {
    NearFieldParams params;
    const double radius_m = 0.5 * aperture.mask.width * aperture.pitch_m;
    params.distance_m = radius_m * radius_m / (params.wavelength_m * fresnel);
    params.method = NearFieldMethod::edges;
    return params;
}

OnAxis on_axis(const Aperture& aperture, double fresnel, const Exec& exec) {
    const Field u = near_field(aperture, {1, 1, 0, 0, 1}, at_fresnel_number(aperture, fresnel), exec);
    const auto re = static_cast<double>(u.re(0, 0)), im = static_cast<double>(u.im(0, 0));
    return {re * re + im * im, (1 - re) * (1 - re) + im * im};
}

Image<float> behind_disc(const Aperture& aperture, const PlaneGrid& plane, double fresnel, const Exec& exec) {
    const Field u = near_field(aperture, plane, at_fresnel_number(aperture, fresnel), exec);
    Image<float> power(plane.width, plane.height);
    for (std::size_t i = 0; i < power.pixels.size(); ++i) {
        const float re = 1 - u.re.pixels[i], im = u.im.pixels[i];
        power.pixels[i] = re * re + im * im;
    }
    return power;
}

Image<float> far_intensity(const Aperture& aperture, const PlaneGrid& plane, double fresnel,
                           const Exec& exec) {
    const double radius = 0.5 * aperture.mask.width, lambda_z = radius * radius / fresnel;
    const FrequencyGrid grid{
        plane.width,           plane.height,         plane.first_x / lambda_z, plane.first_y / lambda_z,
        plane.step / lambda_z, plane.step / lambda_z};
    FarFieldParams params;
    params.method = FarFieldMethod::edges;
    Image<float> power = far_field_power(aperture, grid, params, exec);
    const auto scale = static_cast<float>(1 / (lambda_z * lambda_z));
    for (float& p : power.pixels)
        p *= scale;
    return power;
}

double share_of_peak(const Image<float>& a, const Image<float>& b) {
    float most = 0, peak = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        most = std::max(most, std::fabs(a.pixels[i] - b.pixels[i]));
        peak = std::max(peak, b.pixels[i]);
    }
    return static_cast<double>(most) / static_cast<double>(peak);
}

}  // namespace obscura
