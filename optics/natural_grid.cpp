#include "optics/natural_grid.h"

#include <cmath>

#include "core/num.h"

namespace obscura {
namespace {

std::optional<NaturalAxis> natural_axis(int extent, double first, double step, int count) {
    constexpr int longest = 16;
    constexpr double highest = 1 << 20;
    for (int log2 = 0; log2 <= longest; ++log2) {
        const double period = 1 << log2;
        if (step * period != 1) continue;
        const double index = first * period;
        const bool in_range = std::fabs(first) < highest && count / period < highest;
        if (index != std::floor(index) || extent > (1 << log2) || !in_range) return {};
        return NaturalAxis{log2, count, static_cast<std::int64_t>(index)};
    }
    return {};
}

/// cos and sin of 2 pi t, t reduced to a half turn first.
struct Turn {
    double cos, sin;
};
Turn turn(double t) {
    const double angle = 2 * num::pi * (t - std::floor(t + 0.5));
    return {num::cos(angle), num::sin(angle)};
}

double frequency(const NaturalAxis& axis, int k) {
    return static_cast<double>(axis.first + k) / axis.period();
}

}  // namespace

std::optional<NaturalGrid> natural_grid(int mask_width, int mask_height, const FrequencyGrid& grid) {
    const auto u = natural_axis(mask_width, grid.first_u, grid.step_u, grid.width);
    const auto v = natural_axis(mask_height, grid.first_v, grid.step_v, grid.height);
    if (!u || !v) return {};
    return NaturalGrid{*u, *v};
}

void AxisFactors::push_back(double re_, double im_) {
    re.push_back(static_cast<float>(re_));
    im.push_back(static_cast<float>(im_));
    power.push_back(static_cast<float>(re_ * re_ + im_ * im_));
}

AxisFactors texel_factors(const NaturalAxis& axis, int extent) {
    AxisFactors factors;
    for (int k = 0; k < axis.count; ++k) {
        const double u = frequency(axis, k);
        const Turn shift = turn(u * (extent - 1) / 2);
        const double sinc = u == 0 ? 1 : turn(u / 2).sin / (num::pi * u);
        factors.push_back(sinc * shift.cos, sinc * shift.sin);
    }
    return factors;
}

AxisFactors edge_factors(const NaturalAxis& axis, int extent) {
    AxisFactors factors;
    for (int k = 0; k < axis.count; ++k) {
        const double u = frequency(axis, k);
        const Turn shift = turn(u * extent / 2);
        // 1 / i = -i
        const double size = u == 0 ? 0 : 1 / (2 * num::pi * u);
        factors.push_back(size * shift.sin, -size * shift.cos);
    }
    return factors;
}

UnitRoots unit_roots(int log2_length) {
    const int length = 1 << log2_length;
    UnitRoots roots;
    roots.re.reserve(static_cast<std::size_t>(length));
    roots.im.reserve(static_cast<std::size_t>(length));
    for (int k = 0; k < length; ++k) {
        const Turn t = turn(static_cast<double>(k) / length);
        roots.re.push_back(static_cast<float>(t.cos));
        roots.im.push_back(static_cast<float>(-t.sin));
    }
    return roots;
}

}  // namespace obscura
