#pragma once
// Fraunhofer diffraction: the Fourier transform of an aperture's mask, its texels taken as squares of
// constant transmission,
//
//     F(u, v) = sum over texels of  f(i, j)  *  integral over the texel of  e^(-2 pi i (u x + v y)) dx dy
//
// with x right, y down, in texels, from the mask's centre; u, v in cycles per texel. It is exact for the
// mask, periodic in nothing, and known at any frequency: no grid is built in.
//
// L. Scandolo: thesis, 2019, chapter 3, equations 3.9 to 3.14 (3.12 lacks the frequency in h(u c), 3.14 has
// the opposite sign). A pattern at distance z lies at x' = u lambda z / pitch.

#include <cstdint>
#include <string>

#include "core/isa.h"
#include "optics/field/aperture.h"
#include "optics/field/field.h"
#include "optics/field/frequency_grid.h"

namespace obscura {

enum class FarFieldMethod {
    automatic,
    direct,      ///< every quad at every frequency (3.9, 3.13)
    shift,       ///< quads of equal shape share one transform (3.14)
    gemm,        ///< separable: one matrix product over the quads
    edges,       ///< one matrix product over the distinct columns where the mask changes
    levels,      ///< quads of one size, summed over one period of their phases
    runs,        ///< runs of each row in closed form, then one-dimensional FFTs (or chirp-z) over the rows
    raster_fft,  ///< two-dimensional FFT of the mask, times the transform of a texel
    polygon,     ///< the outline's edges in closed form (the exact shape, not the mask)
};
const char* far_field_method_name(FarFieldMethod method);

struct FarFieldParams {
    FarFieldMethod method = FarFieldMethod::automatic;
    bool symmetry = true;  ///< use mirror and conjugate symmetry where mask and grid have them
    /// Blocks of 8 x 8 pixels whose power nowhere exceeds this share of the peak become 0; 0: no culling.
    double cull = 0;
};

/// What a computation did, or would do.
struct FarFieldReport {
    FarFieldMethod method = FarFieldMethod::automatic;
    double cost_ms = 0;       ///< the planner's estimate for one thread
    std::string reason;       ///< one line: method, what it costs, what the runner-up would
    std::int64_t quads = -1;  ///< when they were counted
    std::int64_t edges = -1;
    std::int64_t active_blocks = -1, blocks = -1;  ///< when culling was asked for
};

/// Chooses by a fixed model of costs, never by a clock: the same choice everywhere.
FarFieldReport plan_far_field(const Aperture& aperture, const FrequencyGrid& grid,
                              const FarFieldParams& params);

/// F over the grid, in texels^2. Amplitude error below 1e-6 of the open area. Throws InputError when the
/// method named cannot serve the grid (levels, raster_fft: natural grids; polygon: disjoint outlines).
Field far_field(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                const Exec& exec, FarFieldReport* report = nullptr);

/// |F|^2 alone, in texels^4; cheaper, since amplitudes need not be stored.
Image<float> far_field_power(const Aperture& aperture, const FrequencyGrid& grid,
                             const FarFieldParams& params, const Exec& exec,
                             FarFieldReport* report = nullptr);

/// Into memory of the caller's, which is what the others do after allocating. No symmetry of the grid is used
/// beyond what the method does itself.
void far_field_into(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                    const FieldTarget& target, const Exec& exec, FarFieldReport* report = nullptr);

}  // namespace obscura
