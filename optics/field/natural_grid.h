#pragma once
// Natural grids: frequencies that are whole multiples of 1 / period, period a power of two. Phases of texels
// repeat every `period` samples there, so fast Fourier transforms apply; what does not repeat is the
// transform of a single texel, a factor per column and per row of the grid.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "optics/field/frequency_grid.h"

namespace obscura {

/// One axis: sample k of `count` has frequency (first + k) / 2^log2_period.
struct NaturalAxis {
    int log2_period = 0, count = 0;
    std::int64_t first = 0;
    int period() const { return 1 << log2_period; }
};

struct NaturalGrid {
    NaturalAxis u, v;
};

/// Nothing when the grid is not natural for a mask of this size: periods must be 1 to 2^16 and no smaller
/// than the mask, frequencies below 2^20 cycles per texel.
std::optional<NaturalGrid> natural_grid(int mask_width, int mask_height, const FrequencyGrid& grid);

/// Complex factors of the samples of an axis, and their squared magnitudes.
struct AxisFactors {
    std::vector<float> re, im, power;
    AxisFactors() = default;
    explicit AxisFactors(int count);
    void set(int k, double re_, double im_);
};

/// What turns sum over texels x of f(x) e^(-2 pi i u x) into the transform of the mask about its centre: the
/// integral over one texel, sinc(u) e^(-pi i u), times e^(2 pi i u extent / 2).
AxisFactors texel_factors(const NaturalAxis& axis, int extent);

/// The same for sums over edges, where each run [a, b) has added e^(-2 pi i u a) - e^(-2 pi i u b):
/// e^(2 pi i u extent / 2) / (2 pi i u); 0 at u = 0, which such sums cannot give.
AxisFactors edge_factors(const NaturalAxis& axis, int extent);

/// e^(-2 pi i k / length) for k = 0 to length - 1, in double.
struct ExactRoots {
    std::vector<double> re, im;
};
ExactRoots exact_roots(int log2_length);

/// The same, rounded.
struct UnitRoots {
    std::vector<float> re, im;
};
UnitRoots unit_roots(int log2_length);

}  // namespace obscura
