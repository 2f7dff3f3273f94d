#pragma once
// Light in the air that was scattered before: the mean over all directions, by height and by the sun's
// height.

#include <vector>

#include "core/isa.h"
#include "core/sky/air_spectrum.h"

namespace obscura {

/// Mean radiance of scattered light relative to the sun's irradiance above the air, as natural logarithms.
struct ScatteredLight {
    std::vector<double> log_mean;  ///< [height][cosine of the sun's zenith angle][wavelength]
    int wavelengths = 0;
};

/// Sums orders of scattering one by one over air and ground until `orders` (>= 2), the rest as a geometric
/// series. Each order scatters evenly to all sides (molecules' first one by their phase function); `albedo`
/// is the ground's, by wavelength. The same bits for every exec.
ScatteredLight scattered_light(const AirSpectrum& air, const Spectrum& albedo, int orders, const Exec& exec);

/// Its value at a height in km and for a sun at this cosine of the zenith angle.
void mean_radiance(const ScatteredLight& light, double height_km, double cos_sun, Spectrum& out);

/// Phase functions times 4 pi, mean 1 over all directions. Molecules: Rayleigh. Aerosol: two lobes of Henyey
/// and Greenstein (1941), 0.9 of g = 0.8 and 0.1 of g = -0.17; their mean cosine is the 0.703 of OPAC's
/// continental average.
double molecules_phase(double cosine);
double aerosol_phase(double cosine);

}  // namespace obscura
