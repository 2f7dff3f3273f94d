#include "optics/field/natural_grid.h"

#include <cmath>
#include <utility>

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

/// cos and sin of 2 pi k / length, k = 0 to length - 1, length a power of two: one eighth is computed, the
/// rest are its mirror images, so that opposite roots are exactly opposite.
struct DoubleRoots {
    std::vector<double> cosine, sine;
    explicit DoubleRoots(int length);
    std::size_t index(std::int64_t k) const {
        return static_cast<std::size_t>(k & (static_cast<std::int64_t>(cosine.size()) - 1));
    }
};

DoubleRoots::DoubleRoots(int length) : cosine(static_cast<std::size_t>(length)), sine(cosine.size()) {
    const auto eighth_of = [&](int k, double& c, double& s) {
        const double angle = 2 * num::pi * k / length;
        c = num::cos(angle);
        s = num::sin(angle);
    };
    // To the quarter turn: cos(k) = sin(quarter - k).
    const int quarter = length / 4;
    for (int k = 0; k <= quarter / 2; ++k) {
        double c = 0, s = 0;
        eighth_of(k, c, s);
        const auto near = static_cast<std::size_t>(k), far = static_cast<std::size_t>(quarter - k);
        cosine[near] = c;
        sine[near] = s;
        if (length < 4) break;
        cosine[far] = s;
        sine[far] = c;
    }
    if (length == 2) cosine[1] = -1;
    // Quarter by quarter: cos(k + quarter) = -sin(k), sin(k + quarter) = cos(k).
    for (int k = quarter + 1; length >= 4 && k < length; ++k) {
        const auto at = static_cast<std::size_t>(k), from = static_cast<std::size_t>(k - quarter);
        cosine[at] = 0 - sine[from];
        sine[at] = cosine[from];
    }
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

AxisFactors::AxisFactors(int count) : re(static_cast<std::size_t>(count)), im(re.size()), power(re.size()) {}

void AxisFactors::set(int k, double re_, double im_) {
    const auto at = static_cast<std::size_t>(k);
    re[at] = static_cast<float>(re_);
    im[at] = static_cast<float>(im_);
    power[at] = static_cast<float>(re_ * re_ + im_ * im_);
}

AxisFactors texel_factors(const NaturalAxis& axis, int extent) {
    // Phases u (extent - 1) / 2 and u / 2 are whole multiples of 1 / (2 period).
    const DoubleRoots roots(2 * axis.period());
    AxisFactors factors(axis.count);
    for (int k = 0; k < axis.count; ++k) {
        const std::int64_t index = axis.first + k;
        const std::size_t shift = roots.index(index * (extent - 1));
        const double sinc = index == 0 ? 1 : roots.sine[roots.index(index)] / (num::pi * frequency(axis, k));
        factors.set(k, sinc * roots.cosine[shift], sinc * roots.sine[shift]);
    }
    return factors;
}

AxisFactors edge_factors(const NaturalAxis& axis, int extent) {
    const DoubleRoots roots(2 * axis.period());
    AxisFactors factors(axis.count);
    for (int k = 0; k < axis.count; ++k) {
        const std::int64_t index = axis.first + k;
        const std::size_t shift = roots.index(index * extent);
        // 1 / i = -i
        const double size = index == 0 ? 0 : 1 / (2 * num::pi * frequency(axis, k));
        factors.set(k, size * roots.sine[shift], -size * roots.cosine[shift]);
    }
    return factors;
}

ExactRoots exact_roots(int log2_length) {
    DoubleRoots turns(1 << log2_length);
    for (double& sine : turns.sine)
        sine = -sine;
    return {std::move(turns.cosine), std::move(turns.sine)};
}

UnitRoots unit_roots(int log2_length) {
    const ExactRoots exact = exact_roots(log2_length);
    UnitRoots roots{std::vector<float>(exact.re.size()), std::vector<float>(exact.re.size())};
    for (std::size_t k = 0; k < exact.re.size(); ++k) {
        roots.re[k] = static_cast<float>(exact.re[k]);
        roots.im[k] = static_cast<float>(exact.im[k]);
    }
    return roots;
}

}  // namespace obscura
