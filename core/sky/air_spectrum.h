#pragma once
// How strongly each part of the air dims and scatters each wavelength, and what colour a wavelength adds.

#include <array>

#include "core/sky/air.h"
#include "core/vec.h"

namespace obscura {

constexpr int most_wavelengths = 40;
/// One number per wavelength, the first `count` of AirSpectrum in use.
using Spectrum = std::array<double, most_wavelengths>;

/// All light is counted relative to the sun's above the air, wavelength by wavelength.
struct AirSpectrum {
    int count = 0;
    Spectrum wavelength_nm{};
    Spectrum molecules{};          ///< optical depth of one vertical column, all scattered
    Spectrum aerosol{};            ///< the same, scattered and absorbed
    Spectrum ozone{};              ///< absorbed
    double aerosol_scattered = 0;  ///< share of the aerosol's depth that is scattered, not absorbed
    /// sum of rgb[i] * x[i]: linear sRGB of light that is x[i] of the sun's at wavelength i. The sun's own (x
    /// = 1) is what the caller asked for.
    std::array<Vec3d, most_wavelengths> rgb{};
};

/// `turbidity` in [1, 10] (aerosol after Preetham), `sun_above_air` linear sRGB of the sun, `count`
/// wavelengths in [4, most_wavelengths]. Colours by 10 are within 1.2 % of 40's (tests/sky).
AirSpectrum air_spectrum(double turbidity, Vec3d sun_above_air, int count);

/// The sun above the air, linear sRGB in watts per square metre and channel: its true colour (about 5900 K
/// seen with the white of D65); the luminance is a third of the solar constant of 1361 W/m2 (Kopp and Lean
/// 2011), as the three channels together carry all of its watts.
Vec3d sun_above_air_true();

/// Lux per watt of luminance of sun_above_air_true()'s scale: 683 lm/W times the sun's spectrum seen by the
/// CIE observer, over a third of the solar constant.
double lux_per_watt();

/// Reflectance by wavelength of a colour whose channels lie in [0, 1]: flat in each of blue, green and red,
/// linear between; it stays in [0, 1].
Spectrum reflectance(const AirSpectrum& air, Vec3d rgb);

/// Optical depth of an amount of air at every wavelength.
inline void optical_depth(const AirSpectrum& air, const AirAmount& amount, Spectrum& depth) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i)
        depth[i] = air.molecules[i] * amount.molecules + air.aerosol[i] * amount.aerosol +
                   air.ozone[i] * amount.ozone;
}

/// Share of light that passes an amount of air, times `scale`.
void transmittance(const AirSpectrum& air, const AirAmount& amount, double scale, Spectrum& out);

/// Linear sRGB of a spectrum relative to the sun's; channels may be negative.
Vec3d rgb_of(const AirSpectrum& air, const Spectrum& light);

}  // namespace obscura
