#pragma once
// Apertures of optics/limits.md, and measures of error.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "core/pixel.h"
#include "filters/metrics.h"
#include "optics/aperture_shapes.h"
#include "optics/far_field.h"
#include "optics/pattern_view.h"

namespace obscura::diffraction_cases {

inline float hash_unit(int x, int y, int seed) {
    auto h = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(y) * 0x85EBCA77u ^
             static_cast<std::uint32_t>(seed) * 0xC2B2AE3Du;
    h = (h ^ h >> 15) * 0x2C1B3C6Du;
    h = (h ^ h >> 12) * 0x297A2D39u;
    return static_cast<float>((h ^ h >> 15) >> 8) / 16777216.0f;
}

/// As a photograph: detail of every size, amplitude in proportion to size, 256 greys.
inline Image<float> photograph(int size) {
    Image<float> picture(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            float sum = 0, share = 0.5f;
            for (int cell = size / 4; cell >= 1; cell /= 2, share *= 0.5f) {
                const int i = x / cell, j = y / cell;
                const float fx = static_cast<float>(x % cell) / static_cast<float>(cell),
                            fy = static_cast<float>(y % cell) / static_cast<float>(cell);
                const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
                sum += share * mix(mix(hash_unit(i, j, cell), hash_unit(i + 1, j, cell), fx),
                                   mix(hash_unit(i, j + 1, cell), hash_unit(i + 1, j + 1, cell), fx), fy);
            }
            picture(x, y) = std::floor(std::min(sum, 1.0f) * 255) / 255;
        }
    }
    return picture;
}

inline Image<float> threshold(Image<float> picture, float level) {
    for (float& texel : picture.pixels)
        texel = texel >= level ? 1.0f : 0.0f;
    return picture;
}

inline Aperture of_mask(Image<float> mask) {
    Aperture a;
    a.mask = std::move(mask);
    a.pitch_m = 1e-5;
    return a;
}

/// Texels of at least half coverage; no outline.
inline Aperture binary_shape(ApertureKind kind, int size, int blades = 7) {
    ApertureShape shape;
    shape.kind = kind;
    shape.blades = blades;
    return of_mask(threshold(make_aperture(shape, size, size * 1e-5).mask, 0.5f));
}

/// Greys of a logarithmic view.
inline Image<Rgb8> log_view(ImageView<const float> power, double white, double decades = 6) {
    PatternView view;
    view.logarithmic = true;
    view.white = white;
    view.decades = decades;
    return view_power(power, view, Exec{});
}

struct Likeness {
    double ssim = 0, psnr_db = 0;
};
/// Of two pictures by their first channel.
inline Likeness likeness(const Image<Rgb8>& a, const Image<Rgb8>& b) {
    const auto plane = [](const Image<Rgb8>& picture) {
        Image<float> p(picture.width, picture.height);
        for (std::size_t i = 0; i < p.pixels.size(); ++i)
            p.pixels[i] = static_cast<float>(picture.pixels[i].r);
        return p;
    };
    const ImageDifference d = compare_images({plane(a)}, {plane(b)}, {}, Exec{});
    return {d.ssim, d.psnr_db};
}

/// Sum of |a - b| over the sum of |b|.
inline double mean_relative(ImageView<const float> a, ImageView<const float> b) {
    double difference = 0, all = 0;
    for (int y = 0; y < b.height; ++y) {
        for (int x = 0; x < b.width; ++x) {
            difference += std::fabs(static_cast<double>(a(x, y)) - static_cast<double>(b(x, y)));
            all += std::fabs(static_cast<double>(b(x, y)));
        }
    }
    return difference / all;
}
inline double mean_relative(const Image<Vec3f>& a, const Image<Vec3f>& b) {
    double difference = 0, all = 0;
    for (std::size_t i = 0; i < b.pixels.size(); ++i) {
        for (const auto channel : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
            difference += std::fabs(static_cast<double>(a.pixels[i].*channel - b.pixels[i].*channel));
            all += std::fabs(static_cast<double>(b.pixels[i].*channel));
        }
    }
    return difference / all;
}

}  // namespace obscura::diffraction_cases
