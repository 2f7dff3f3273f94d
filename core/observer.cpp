// The CIE 1931 observer and linear sRGB.
//
// C. Wyman, P.-P. Sloan, P. Shirley: Simple analytic approximations to the CIE XYZ color matching functions,
// JCGT 2(2), 2013, listing 1 (multi-lobe, piecewise Gaussian). sRGB: IEC 61966-2-1:1999.

#include "core/observer.h"

#include <algorithm>

#include "core/num.h"

namespace obscura {

namespace {

/// A Gaussian whose halves have inverse widths `below` and `above` the middle.
double lobe(double x, double middle, double below, double above) {
    const double t = (x - middle) * (x < middle ? below : above);
    return num::exp(-0.5 * t * t);
}

struct Matrix {
    Vec3d row[3];
};

constexpr Vec3d product(const Matrix& m, Vec3d v) {
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}

constexpr Matrix inverse_of(const Matrix& m) {
    const Vec3d a = cross(m.row[1], m.row[2]), b = cross(m.row[2], m.row[0]), c = cross(m.row[0], m.row[1]);
    const double scale = 1 / dot(m.row[0], a);
    return {{Vec3d{a.x, b.x, c.x} * scale, Vec3d{a.y, b.y, c.y} * scale, Vec3d{a.z, b.z, c.z} * scale}};
}

/// IEC 61966-2-1, as printed there (four digits); the other direction is its exact inverse.
constexpr Matrix from_srgb = {{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
constexpr Matrix to_srgb = inverse_of(from_srgb);

}  // namespace

Vec3d observer_xyz(double wavelength_nm) {
    const double w = wavelength_nm;
    return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

Vec3d srgb_from_xyz(Vec3d xyz) {
    return product(to_srgb, xyz);
}

Vec3d xyz_from_srgb(Vec3d rgb) {
    return product(from_srgb, rgb);
}

double srgb_luminance(Vec3d rgb) {
    return dot(from_srgb.row[1], rgb);
}

Vec3d into_gamut(Vec3d rgb) {
    const double grey = srgb_luminance(rgb);
    const double least = std::min({rgb.x, rgb.y, rgb.z});
    if (least >= 0) return rgb;
    if (!(grey > 0)) return {};
    const double kept = grey / (grey - least);
    const auto moved = [&](double channel) { return std::max(0.0, grey + kept * (channel - grey)); };
    return {moved(rgb.x), moved(rgb.y), moved(rgb.z)};
}

}  // namespace obscura
