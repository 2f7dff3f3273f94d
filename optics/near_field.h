#pragma once
// Fresnel diffraction: the light at a distance z behind an aperture that a unit plane wave meets,
//
//     U(x', y') = 1 / (i lambda z)  *  integral of  f(x, y) e^(i pi ((x - x')^2 + (y - y')^2) / (lambda z))
//
// (without e^(ikz)). Without an aperture U = 1. The integral over a texel is a product of differences of
// Fresnel integrals, so every texel and every run of texels is exact.
//
// L. Scandolo: thesis, 2019, section 3.4.5, equations 3.18 to 3.24 (3.22 and 3.23 lack their lower limits).

#include <cstdint>
#include <string>

#include "core/isa.h"
#include "optics/field/aperture.h"
#include "optics/field/field.h"
#include "optics/field/plane_grid.h"

namespace obscura {

enum class NearFieldMethod {
    automatic,  ///< edges, hybrid or fft: quads are never fewer products than distinct columns by much
    direct,     ///< every quad at every pixel (3.19)
    two_pass,   ///< the paper's: factors of every quad tabulated per axis, then summed
    edges,      ///< one matrix product over the distinct columns where the mask changes
    hybrid,     ///< runs by their ends in one axis, one-dimensional FFT convolution in the other
    fft,  ///< two-dimensional FFT convolution with the texel-integrated kernel, padded to twice the size
};
const char* near_field_method_name(NearFieldMethod method);

struct NearFieldParams {
    double wavelength_m = 550e-9;
    double distance_m = 0;  ///< z > 0
    NearFieldMethod method = NearFieldMethod::automatic;
    /// Above 0, `automatic` chooses edges and the other methods are refused: blocks of 8 x 8 pixels become 0
    /// where the power at their centre and at their eight neighbours' centres is below this share of the
    /// unobstructed wave's (the thesis samples values alone, too: there is no simple gradient).
    double cull = 0;
    /// 2^coarse_levels texels in a row become one first: the finest level of a coarser quadtree. Binary masks
    /// stay binary. What then remains exact is the field of the coarser mask; its edges are off by up to half
    /// a coarse texel.
    int coarse_levels = 0;
};

struct NearFieldReport {
    NearFieldMethod method = NearFieldMethod::automatic;
    double cost_ms = 0;
    std::string reason;
    std::int64_t quads = -1;  ///< when they were counted
    std::int64_t edges = -1;  ///< distinct columns or rows of the mask, when they were counted
    std::int64_t active_blocks = -1, blocks = -1;  ///< when culling was asked for
};

/// a^2 / (lambda z), a = half the mask's larger side: what the planes and costs of a mask go by.
double fresnel_number(const Aperture& aperture, const NearFieldParams& params);

/// The same of the light: a = half the longer side of the rectangle around all that is open, which is the
/// radius of a round hole. 0 when nothing is.
double opening_fresnel_number(const Aperture& aperture, const NearFieldParams& params);

NearFieldReport plan_near_field(const Aperture& aperture, const PlaneGrid& grid,
                                const NearFieldParams& params);

/// U over the plane. Error below 2e-6 of the unobstructed wave's amplitude and of the pattern's own peak,
/// whichever is less, at any Fresnel number up to 1000. Throws InputError for lengths that are not positive
/// and finite, for planes without pixels, and when the method named cannot serve the plane (hybrid, fft: step
/// = p / q with q up to 16).
Field near_field(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                 const Exec& exec, NearFieldReport* report = nullptr);

/// |U|^2: intensity relative to the unobstructed wave.
Image<float> near_field_intensity(const Aperture& aperture, const PlaneGrid& grid,
                                  const NearFieldParams& params, const Exec& exec,
                                  NearFieldReport* report = nullptr);

/// Into memory of the caller's, which is what the others do after allocating.
void near_field_into(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                     const FieldTarget& target, const Exec& exec, NearFieldReport* report = nullptr);

}  // namespace obscura
