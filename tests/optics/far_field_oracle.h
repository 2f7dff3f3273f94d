#pragma once
// The far field of a mask by its definition, in double: texel by texel, closed form, one axis after the
// other.

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <vector>

#include "core/image.h"
#include "optics/aperture_shapes.h"
#include "optics/far_field.h"

namespace obscura::far_field_oracle {

using Complex = std::complex<double>;

/// Integral of e^(-2 pi i u x) over the texel [i, i + 1), x from the middle of `extent` texels.
inline Complex texel(double u, int i, int extent) {
    const double centre = i + 0.5 - extent / 2.0;
    const double t = M_PI * u;
    const double sinc = std::fabs(t) < 1e-6 ? 1 - t * t / 6 : std::sin(t) / t;
    const double turns = u * centre;
    return sinc * std::polar(1.0, -2 * M_PI * (turns - std::round(turns)));
}

inline std::vector<Complex> exact(ImageView<const float> mask, const FrequencyGrid& grid) {
    const auto columns = static_cast<std::size_t>(grid.width);
    std::vector<Complex> rows(columns * static_cast<std::size_t>(mask.height));
    std::vector<Complex> phase(static_cast<std::size_t>(std::max(mask.width, mask.height)));
    for (int c = 0; c < grid.width; ++c) {
        for (int x = 0; x < mask.width; ++x)
            phase[static_cast<std::size_t>(x)] = texel(grid.first_u + c * grid.step_u, x, mask.width);
        for (int y = 0; y < mask.height; ++y) {
            Complex sum = 0;
            for (int x = 0; x < mask.width; ++x)
                sum += static_cast<double>(mask(x, y)) * phase[static_cast<std::size_t>(x)];
            rows[static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(c)] = sum;
        }
    }
    std::vector<Complex> field(columns * static_cast<std::size_t>(grid.height));
    for (int r = 0; r < grid.height; ++r) {
        for (int y = 0; y < mask.height; ++y)
            phase[static_cast<std::size_t>(y)] = texel(grid.first_v + r * grid.step_v, y, mask.height);
        for (std::size_t c = 0; c < columns; ++c) {
            Complex sum = 0;
            for (std::size_t y = 0; y < static_cast<std::size_t>(mask.height); ++y)
                sum += rows[y * columns + c] * phase[y];
            field[static_cast<std::size_t>(r) * columns + c] = sum;
        }
    }
    return field;
}

/// Largest |difference| over the grid, relative to the open area; infinity where sizes differ or a value is
/// not finite.
inline double amplitude_error(const Field& field, const std::vector<Complex>& truth, double area) {
    if (field.re.pixels.size() != truth.size() || field.im.pixels.size() != truth.size()) return INFINITY;
    double worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const Complex value(static_cast<double>(field.re.pixels[i]), static_cast<double>(field.im.pixels[i]));
        const double error = std::abs(value - truth[i]);
        if (!(error <= worst)) worst = std::isfinite(error) ? error : INFINITY;
    }
    return worst / area;
}

/// The same for powers: difference of magnitudes.
inline double power_error(const Image<float>& power, const std::vector<Complex>& truth, double area) {
    if (power.pixels.size() != truth.size()) return INFINITY;
    double worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double value = static_cast<double>(power.pixels[i]);
        const double error = value >= 0 ? std::fabs(std::sqrt(value) - std::abs(truth[i])) : INFINITY;
        if (!(error <= worst)) worst = std::isfinite(error) ? error : INFINITY;
    }
    return worst / area;
}

struct NamedMask {
    std::string name;
    Aperture aperture;
};

/// Masks that find mistakes: the paper's four, odd and oblong sizes, grey, noise, borders, single texels.
inline std::vector<NamedMask> hard_masks(int size) {
    std::vector<NamedMask> masks;
    const auto shape = [&](const char* name, ApertureKind kind, int texels) {
        ApertureShape s;
        s.kind = kind;
        masks.push_back({name, make_aperture(s, texels, 1.0)});
    };
    shape("box", ApertureKind::box, size);
    shape("circle", ApertureKind::circle, size);
    shape("iris", ApertureKind::iris, size);
    shape("whirl", ApertureKind::whirl, size);
    shape("iris, odd", ApertureKind::iris, size - 1);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    const auto custom = [&](const char* name, int width, int height, auto&& value) {
        Aperture a;
        a.pitch_m = 1;
        a.mask = Image<float>(width, height);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                a.mask(x, y) = value(x, y);
        }
        masks.push_back({name, a});
    };
    custom("noise", size, size, [&](int, int) { return uniform(random); });
    custom("checkerboard", size, size, [](int x, int y) { return static_cast<float>((x + y) % 2); });
    custom("full", size, size, [](int, int) { return 1.0f; });
    custom("oblong noise", size / 2 + 3, size - 5,
           [&](int, int) { return uniform(random) < 0.4f ? 1.0f : 0.0f; });
    custom("same top and bottom", size, size, [&](int x, int y) {
        return (x * x + 3 * x + (2 * y - size + 1) * (2 * y - size + 1) / 8) % 7 < 3 ? 1.0f : 0.0f;
    });
    custom("one texel", 1, 1, [](int, int) { return 0.5f; });
    custom("one hole", 9, 7, [](int x, int y) { return x == 3 && y == 4 ? 0.0f : 1.0f; });
    return masks;
}

}  // namespace obscura::far_field_oracle
