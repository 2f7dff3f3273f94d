// Linear and logarithmic views of diffraction patterns.

#include "optics/pattern_view.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/num.h"
#include "core/parallel.h"
#include "optics/spectrum.h"

namespace obscura {

namespace {

void check_view(const PatternView& view) {
    CHECK(view.white >= 0 && view.decades >= 0.1 && view.decades <= 40);
}

/// Shade in [0, 1], as encoded for a screen, of a power relative to white.
double log_shade(double relative, double decades) {
    if (!(relative > 0)) return 0;
    const double log10_e = 0.43429448190325182765;
    return std::clamp(1 + num::log(relative) * log10_e / decades, 0.0, 1.0);
}

std::uint8_t code_of(double shade) {
    return static_cast<std::uint8_t>(std::floor(255 * shade + 0.5));
}

/// Towards the grey of its luminance `grey` <= 1 until no channel exceeds 1.
Vec3d below_one(Vec3d rgb, double grey) {
    const double most = std::max({rgb.x, rgb.y, rgb.z});
    if (most <= 1) return rgb;
    if (grey >= 1) return {1, 1, 1};
    const double kept = (1 - grey) / (most - grey);
    return Vec3d{grey, grey, grey} + (rgb - Vec3d{grey, grey, grey}) * kept;
}

Rgb8 shown(Vec3d rgb, const PatternView& view, double white) {
    const double luminance = srgb_luminance(rgb) / white;
    if (!(luminance > 0)) return {};
    const double target = view.logarithmic ? srgb_decode(log_shade(luminance, view.decades)) : luminance;
    const Vec3d linear = below_one(into_gamut(rgb) * (target / (luminance * white)), target);
    return {linear_to_srgb8(static_cast<float>(linear.x)), linear_to_srgb8(static_cast<float>(linear.y)),
            linear_to_srgb8(static_cast<float>(linear.z))};
}

template <class T, class Show>
Image<Rgb8> picture_of(ImageView<const T> from, const Exec& exec, Show&& show) {
    Image<Rgb8> picture(from.width, from.height);
    parallel_for(static_cast<std::size_t>(from.height), exec, [&](std::size_t item) {
        const int y = static_cast<int>(item);
        for (int x = 0; x < from.width; ++x)
            picture(x, y) = show(from(x, y));
    });
    return picture;
}

template <class T, class Value>
double white_of(ImageView<const T> from, double wanted, Value&& value) {
    if (wanted > 0) return wanted;
    double largest = 0;
    for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x)
            largest = std::max(largest, value(from(x, y)));
    }
    return largest > 0 ? largest : 1;
}

}  // namespace

Image<Rgb8> view_power(ImageView<const float> power, const PatternView& view, const Exec& exec) {
    check_view(view);
    const double white = white_of(power, view.white, [](float p) { return static_cast<double>(p); });
    return picture_of(power, exec, [&](float p) {
        const double relative = static_cast<double>(p) / white;
        const std::uint8_t grey = view.logarithmic ? code_of(log_shade(relative, view.decades))
                                                   : linear_to_srgb8(static_cast<float>(relative));
        return Rgb8{grey, grey, grey};
    });
}

Image<Rgb8> view_colour(ImageView<const Vec3f> colour, const PatternView& view, const Exec& exec) {
    check_view(view);
    const double white =
        white_of(colour, view.white, [](Vec3f rgb) { return srgb_luminance(to_double(rgb)); });
    return picture_of(colour, exec, [&](Vec3f rgb) { return shown(to_double(rgb), view, white); });
}

}  // namespace obscura
