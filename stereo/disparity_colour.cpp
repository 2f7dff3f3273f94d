// Disparity in a diverging colour map; see disparity_colour.h.

#include "stereo/disparity_colour.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/color.h"
#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// CIELAB in polar coordinates: length, angle from the grey axis, hue (Moreland's Msh).
struct PolarLab {
    double length, saturation, hue;
};

// Moreland's ends and middle. The ends' hues turn away from white by `spin`, so that steps near white are
// steps of colour and not of hue: s sqrt(M_white^2 - M^2) / (M sin s).
constexpr PolarLab cool{80, 1.08, -1.1}, warm{80, 1.08, 0.5};
constexpr double white_length = 88, spin = 0.561;

double lab_inverse(double t) {
    constexpr double knee = 6.0 / 29;
    return t > knee ? t * t * t : 3 * knee * knee * (t - 4.0 / 29);
}

/// By way of CIE XYZ under D65, to linear Rec. 709.
Rgb8 coded(const PolarLab& c) {
    const double l = c.length * num::cos(c.saturation), radius = c.length * num::sin(c.saturation);
    const double fy = (l + 16) / 116;
    const double x = 0.95047 * lab_inverse(fy + radius * num::cos(c.hue) / 500);
    const double y = lab_inverse(fy);
    const double z = 1.08883 * lab_inverse(fy - radius * num::sin(c.hue) / 200);
    const auto code = [](double v) { return linear_to_srgb8(static_cast<float>(v)); };
    return {code(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
            code(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
            code(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

/// t in [-1, 1].
PolarLab diverging(double t) {
    const PolarLab& end = t < 0 ? cool : warm;
    const double white_hue = t < 0 ? cool.hue - spin : warm.hue + spin;
    const double a = std::abs(t);
    return {white_length + a * (end.length - white_length), a * end.saturation,
            white_hue + a * (end.hue - white_hue)};
}

constexpr int half_steps = 512;
constexpr Rgb8 unknown{24, 24, 24}, tick_colour{16, 16, 16};

std::size_t entry(int step) {
    const int index = step + half_steps;
    return static_cast<std::size_t>(index);
}

const std::array<Rgb8, 2 * half_steps + 1>& table() {
    static const auto colours = [] {
        std::array<Rgb8, 2 * half_steps + 1> t;
        for (int i = -half_steps; i <= half_steps; ++i)
            t[entry(i)] = coded(diverging(i / static_cast<double>(half_steps)));
        return t;
    }();
    return colours;
}

Rgb8 darker(Rgb8 c) {
    const auto part = [](int code) { return static_cast<std::uint8_t>(code * 2 / 5); };
    return {part(c.r), part(c.g), part(c.b)};
}

/// The colour with stripes where comfort ends.
Rgb8 marked(double d, const DisparityColours& colours, int x, int y) {
    const Rgb8 c = disparity_colour(d, colours);
    constexpr int period = 8, width = 3;
    if (d > colours.comfort_near_px) return (x + y) % period < width ? darker(c) : c;
    if (d < colours.comfort_far_px) return (x + (period - 1) * y) % period < width ? darker(c) : c;
    return c;
}

/// The least of 1, 2, 5 times a power of ten that is >= x > 0.
double round_step(double x) {
    double step = 1;
    while (step > x)
        step /= 10;
    while (step * 10 <= x)
        step *= 10;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * step >= x) return factor * step;
    return 10 * step;
}

}  // namespace

DisparityColours colours_for(const DisparityMap& map) {
    double low = -1, high = 1;
    for (const float d : map.pixels) {
        if (!std::isfinite(d)) continue;
        low = std::min(low, static_cast<double>(d));
        high = std::max(high, static_cast<double>(d));
    }
    return {.far_px = std::floor(low), .near_px = std::ceil(high)};
}

Rgb8 disparity_colour(double disparity_px, const DisparityColours& colours) {
    CHECK(colours.far_px < colours.near_px);
    if (!(disparity_px == disparity_px)) return unknown;
    const double d = std::clamp(disparity_px, colours.far_px, colours.near_px);
    const double end = std::max(std::abs(colours.far_px), std::abs(colours.near_px));
    const auto step = static_cast<int>(std::floor(d / end * half_steps + 0.5));
    return table()[entry(step)];
}

Image<Rgb8> disparity_picture(const DisparityMap& map, const DisparityColours& colours, const Exec& exec) {
    Image<Rgb8> picture(map.width, map.height);
    parallel_blocks(static_cast<std::size_t>(map.height), 16, exec, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < map.width; ++x)
                picture(x, y) = marked(static_cast<double>(map(x, y)), colours, x, y);
    });
    return picture;
}

DisparityScale disparity_scale(int width, int height, const DisparityColours& colours) {
    CHECK(width >= 16 && height >= 4 && colours.far_px < colours.near_px);
    DisparityScale scale;
    scale.strip = Image<Rgb8>(width, height);
    const double range = colours.near_px - colours.far_px;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            scale.strip(x, y) = marked(colours.far_px + range * (x + 0.5) / width, colours, x, y);

    // About one number in sixty pixels; the screen's own tick runs all the way up.
    const double step = round_step(range / std::max(2.0, width / 60.0));
    const auto last = static_cast<std::int64_t>(std::floor(colours.near_px / step + 1e-9));
    for (auto i = static_cast<std::int64_t>(std::ceil(colours.far_px / step - 1e-9)); i <= last; ++i) {
        const ScaleTick tick{static_cast<double>(i) * step,
                             (static_cast<double>(i) * step - colours.far_px) / range * width};
        scale.ticks.push_back(tick);
        const int x = std::clamp(static_cast<int>(std::floor(tick.x)), 0, width - 1);
        for (int y = i == 0 ? 0 : height - (height + 2) / 3; y < height; ++y)
            scale.strip(x, y) = tick_colour;
    }
    return scale;
}

}  // namespace obscura
