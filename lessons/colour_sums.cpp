#include "lessons/colour_sums.h"

#include <algorithm>
#include <cmath>

#include "optics/pattern_view.h"

namespace obscura {

Image<Vec3f> colour_of(const Aperture& aperture, const FrequencyGrid& grid, int wavelengths,
                       const Exec& exec) {
    PsfParams params;
    params.wavelengths = wavelengths;
    return far_field_colour(aperture, grid, colour_reference_nm, params, exec);
}

Image<Vec3f> looked_up_colour(const Aperture& aperture, const FrequencyGrid& grid, int wavelengths,
                              double step, PowerInterpolation interpolation, const Exec& exec) {
    const std::vector<SpectralSample> samples = spectral_samples({}, wavelengths);
    const auto scale_of = [](const SpectralSample& s) { return colour_reference_nm / s.wavelength_nm; };
    double least = 1, most = 1, luminance = 0;
    for (const SpectralSample& s : samples) {
        least = std::min(least, scale_of(s));
        most = std::max(most, scale_of(s));
        luminance += s.xyz.y * scale_of(s) * scale_of(s);
    }
    PowerImage power;
    power.grid = scaled_cover(grid, least, most, step);
    power.power = far_field_power(aperture, power.grid, {}, exec);
    const double peak = open_area(aperture.mask.view());
    Image<Vec3f> sum(grid.width, grid.height);
    for (const SpectralSample& s : samples) {
        const double scale = scale_of(s);
        add_scaled_power(power, grid, scale, s.rgb * (scale * scale / (luminance * peak * peak)),
                         interpolation, sum, exec);
    }
    return sum;
}

double colour_error(const Image<Vec3f>& a, const Image<Vec3f>& b, const FrequencyGrid& grid, double least,
                    double most) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < grid.height; ++y) {
        for (int x = 0; x < grid.width; ++x) {
            const double u = grid.first_u + x * grid.step_u, v = grid.first_v + y * grid.step_v;
            const double radius = std::sqrt(u * u + v * v);
            if (radius < least || radius >= most) continue;
            const Vec3d of_a = xyz_from_srgb(to_double(a(x, y))), of_b = xyz_from_srgb(to_double(b(x, y)));
            const Vec3d d = of_a - of_b;
            sum += (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z)) / (of_b.x + of_b.y + of_b.z);
            ++count;
        }
    }
    return sum / count;
}

Image<Rgb8> log_picture(const Image<Vec3f>& colour, double decades, const Exec& exec) {
    PatternView view;
    view.logarithmic = true;
    view.white = 1;
    view.decades = decades;
    Image<Rgb8> picture = view_colour(colour.view(), view, exec);
    for (Rgb8& pixel : picture.pixels) {
        for (std::uint8_t* code : {&pixel.r, &pixel.g, &pixel.b})
            *code = static_cast<std::uint8_t>((*code + 2) / 5 * 5);
    }
    return picture;
}

Rgb8 hue_of(const SpectralSample& sample) {
    const Vec3d rgb = into_gamut(sample.rgb);
    const double most = std::max({rgb.x, rgb.y, rgb.z});
    Image<Vec3f> pixel(1, 1, to_float(rgb * (1 / most)));
    PatternView view;
    view.white = 1;
    return view_colour(pixel.view(), view, {})(0, 0);
}

}  // namespace obscura
