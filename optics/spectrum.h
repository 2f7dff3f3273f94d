#pragma once
// Light by wavelength, and what the eye makes of it.

#include <vector>

#include "core/observer.h"
#include "core/vec.h"

namespace obscura {

enum class LightSource { d65, equal, blackbody, sodium, rgb_led, monochromatic };

/// "d65", "equal", "blackbody", "sodium", "rgb_led", "monochromatic".
const char* light_source_name(LightSource source);

struct LightSpectrum {
    LightSource source = LightSource::d65;
    double kelvin = 6500;        ///< blackbody, [500, 1e6]
    double wavelength_nm = 550;  ///< monochromatic, [380, 780]
    friend bool operator==(const LightSpectrum&, const LightSpectrum&) = default;
};

/// Relative radiant power per nanometre, of any scale; zero outside 380 to 780 nm.
///  - d65: CIE daylight, its table at 10 nm joined by straight lines, as the standard's 5 nm table is;
///  - blackbody: Planck's law;
///  - sodium: the D lines 588.995 and 589.592 nm, 2 : 1, Gaussians of 0.05 nm standard deviation;
///  - rgb_led: Gaussians at 465, 525 and 630 nm, 22, 33 and 18 nm wide at half height, balanced to the
///    white of D65;
///  - monochromatic: a Gaussian of 0.05 nm standard deviation.
double spectral_power(const LightSpectrum& light, double wavelength_nm);

/// The light's own tristimulus values, Y = 1. D65 gives the white of sRGB exactly: X and Z of the observer
/// are scaled (by 1.0009 and 1.0011) to make up for what the fit lacks there, here and in spectral_samples().
Vec3d light_xyz(const LightSpectrum& light);

/// One wavelength of a quadrature, and the colour that a pattern of unit power at this wavelength adds.
struct SpectralSample {
    double wavelength_nm = 0;
    Vec3d xyz;
    Vec3d rgb;  ///< the same in linear sRGB; channels may be negative, single wavelengths lie outside
};

/// Whether it consists of single wavelengths.
bool has_lines(const LightSpectrum& light);

/// At most `count` >= 1 samples, at the middles of equal steps of 1 / wavelength: at a point of a pattern
/// that scales with wavelength, fringes pass at an even rate so. Samples that hardly show (below 1e-3 of the
/// strongest) are left out; lines are one sample each. The colours of all samples add up to the light's own,
/// luminance 1, for every count.
std::vector<SpectralSample> spectral_samples(const LightSpectrum& light, int count);

/// Exactly `count` samples, each wavelength the same multiple of the one before; none is left out. Lights of
/// lines have none such: nothing.
std::vector<SpectralSample> geometric_samples(const LightSpectrum& light, int count);

/// How finely a light must be sampled. With s = 550 / wavelength_nm, the interval of s in which the light
/// shows, and the number of samples per unit of s with which a pattern that passes `cycles_per_scale` fringes
/// while s grows by 1 comes out with errors below `tolerance` of its colour. 0 samples: lines, all are taken.
struct SpectralRate {
    double least_scale = 0, largest_scale = 0;
    double samples_per_scale = 0;
    int count = 0;  ///< samples over the interval, at least 1
};
SpectralRate spectral_rate(const LightSpectrum& light, double cycles_per_scale, double tolerance);

/// Throws InputError when a number of wavelengths (0: to be chosen) or a tolerance for that choice makes no
/// sense.
void check_sampling(int wavelengths, double tolerance);

}  // namespace obscura
