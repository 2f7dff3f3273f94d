#pragma once
// One pattern serves all wavelengths: looked up at scaled places.

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/field/frequency_grid.h"

namespace obscura {

/// |F|^2 with the frequencies of its pixels.
struct PowerImage {
    FrequencyGrid grid;
    Image<float> power;
};

/// Between samples: from 2 x 2, or from 4 x 4 by Catmull-Rom cubics. Power has twice the bandwidth of the
/// amplitude; see the README for what either costs in accuracy.
enum class PowerInterpolation { linear, cubic };

/// Smallest grid of frequencies with this step that holds grid(x, y) times every scale between the two, with
/// a margin for cubics, and whose pixels include frequency 0 (when it reaches that far). Throws LimitError
/// past 2^28 pixels.
FrequencyGrid scaled_cover(const FrequencyGrid& grid, double least_scale, double largest_scale, double step);

/// Adds weight * power(scale * grid(x, y)) to every pixel. Outside the power image: its nearest edge.
void add_scaled_power(const PowerImage& from, const FrequencyGrid& grid, double scale, Vec3d weight,
                      PowerInterpolation interpolation, Image<Vec3f>& sum, const Exec& exec);

/// Four scaled copies of a power image at every pixel: ladder[c] times its frequency.
struct PowerBatch {
    FrequencyGrid grid;
    Image<float> power[4];
};
PowerBatch gather_batch(const PowerImage& from, const FrequencyGrid& grid, const double (&ladder)[4],
                        PowerInterpolation interpolation, const Exec& exec);

/// Adds the sum over c of weight[c] * power[c](scale * grid(x, y)).
void add_scaled_batch(const PowerBatch& from, const FrequencyGrid& grid, double scale,
                      const Vec3d (&weight)[4], PowerInterpolation interpolation, Image<Vec3f>& sum,
                      const Exec& exec);

}  // namespace obscura
