#pragma once
// What near fields are checked against: every texel's share as a product of differences of Fresnel integrals,
// all in double, and measures of error.

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "optics/field/aperture.h"
#include "optics/field/fresnel.h"
#include "optics/near_field.h"

namespace obscura::near_field_oracle {

using Complex = std::complex<double>;

struct Plane {
    int width = 0, height = 0;
    std::vector<Complex> values;
    Complex operator()(int x, int y) const { return values[static_cast<std::size_t>(y * width + x)]; }
};

/// share[i * texels + j]: of texel j at pixel i, an integral of the normalised chirp: 1 for an infinite
/// texel.
inline std::vector<Complex> shares(int texels, int pixels, double first, double step, double turns) {
    std::vector<Complex> share;
    for (int i = 0; i < pixels; ++i) {
        Complex before;
        for (int j = 0; j <= texels; ++j) {
            const FresnelValue v =
                fresnel_integral(2 * std::sqrt(turns) * (j - 0.5 * texels - first - i * step));
            const Complex here = Complex(v.c, v.s) / Complex(1, 1);
            if (j > 0) share.push_back(here - before);
            before = here;
        }
    }
    return share;
}

inline Plane exact_field(const Aperture& a, const PlaneGrid& grid, const NearFieldParams& params) {
    const double turns = a.pitch_m * a.pitch_m / (2 * params.wavelength_m * params.distance_m);
    const int columns = a.mask.width, rows = a.mask.height;
    const auto at_x = shares(columns, grid.width, grid.first_x, grid.step, turns),
               at_y = shares(rows, grid.height, grid.first_y, grid.step, turns);
    // Rows first: what each row of the mask sends to each x'.
    std::vector<Complex> by_row(static_cast<std::size_t>(rows * grid.width));
    for (int y = 0; y < rows; ++y) {
        for (int i = 0; i < grid.width; ++i) {
            Complex sum;
            for (int x = 0; x < columns; ++x)
                sum += static_cast<double>(a.mask(x, y)) * at_x[static_cast<std::size_t>(i * columns + x)];
            by_row[static_cast<std::size_t>(y * grid.width + i)] = sum;
        }
    }
    Plane plane{grid.width, grid.height, {}};
    for (int k = 0; k < grid.height; ++k) {
        for (int i = 0; i < grid.width; ++i) {
            Complex sum;
            for (int y = 0; y < rows; ++y)
                sum += by_row[static_cast<std::size_t>(y * grid.width + i)] *
                       at_y[static_cast<std::size_t>(k * rows + y)];
            plane.values.push_back(sum);
        }
    }
    return plane;
}

struct Difference {
    double largest = 0, peak = 0;
};
inline Difference compare(const Field& field, const Plane& exact) {
    Difference d;
    for (int y = 0; y < exact.height; ++y) {
        for (int x = 0; x < exact.width; ++x) {
            const Complex u(static_cast<double>(field.re(x, y)), static_cast<double>(field.im(x, y)));
            d.largest = std::max(d.largest, std::abs(u - exact(x, y)));
            d.peak = std::max(d.peak, std::abs(exact(x, y)));
        }
    }
    return d;
}

/// The distance at which the aperture has this Fresnel number.
inline NearFieldParams at_fresnel_number(const Aperture& a, double number) {
    NearFieldParams params;
    params.distance_m = 1;
    params.distance_m = fresnel_number(a, params) / number;
    return params;
}

/// A mask whose texel (x, y) is open where open(x, y) says so; coordinates of texel centres from the mask's
/// centre.
template <class Open>
Aperture aperture_where(int width, int height, Open open, double pitch_m = 1e-5) {
    Aperture a;
    a.pitch_m = pitch_m;
    a.mask = Image<float>(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            a.mask(x, y) = static_cast<float>(open(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height));
    }
    return a;
}

inline Aperture disc(int size, double radius) {
    return aperture_where(size, size, [&](double x, double y) { return x * x + y * y < radius * radius; });
}

/// Nothing symmetric, several runs in rows and columns.
inline Aperture blades(int width, int height) {
    return aperture_where(width, height, [&](double x, double y) {
        const double r = std::hypot(x, y), angle = std::atan2(y, x) + 0.04 * r;
        return r > 3 && r < 0.48 * std::min(width, height) && std::sin(5 * angle) > 0.1;
    });
}

/// The same with every open texel of its own grey.
inline Aperture grey_blades(int width, int height) {
    Aperture a = blades(width, height);
    std::mt19937 random(7);
    for (float& v : a.mask.pixels)
        v *= static_cast<float>(random() % 1000) / 999.0f;
    return a;
}

}  // namespace obscura::near_field_oracle
