// Optical depths and colours by wavelength.
//
// Molecules: B. Bodhaine et al., On Rayleigh optical depth calculations, J. Atmos. Oceanic Technol. 16
// (1999), eq. 30. Aerosol: A. Preetham, P. Shirley, B. Smits, A practical analytic model for daylight,
// SIGGRAPH 1999, appendix A.1 (Angstrom's law, exponent 1.3, beta from turbidity); absorbed share: M. Hess,
// P. Koepke, I. Schult, Optical properties of aerosols and clouds (OPAC), BAMS 79 (1998), continental
// average. Ozone: cross sections of V. Gorshelev et al. and A. Serdyuchenko et al. (2014) at 233 K in bins of
// 10 nm, 300 Dobson units; sun: ASTM G-173-03 above the air in bins of 10 nm; both bins as averaged by E.
// Bruneton (2017).

#include "core/sky/air_spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "core/observer.h"
#include "core/sky/exp_lanes.h"

namespace obscura {

namespace {

/// Means over 10 nm from 360 nm on.
constexpr double first_bin_nm = 360, bin_nm = 10;
using Bins = std::array<double, 43>;

/// W / (m2 nm).
constexpr Bins sun_power = {1.11776, 1.14259, 1.01249, 1.14716, 1.72765, 1.73054, 1.6887, 1.61253, 1.91198,
                            2.03474, 2.02042, 2.02212, 1.93377, 1.95809, 1.91686, 1.8298, 1.8685,  1.8931,
                            1.85149, 1.8504,  1.8341,  1.8345,  1.8147,  1.78158, 1.7533, 1.6965,  1.68194,
                            1.64654, 1.6048,  1.52143, 1.55622, 1.5113,  1.474,   1.4482, 1.41018, 1.36775,
                            1.34188, 1.31429, 1.28303, 1.26758, 1.2367,  1.2082,  1.18737};

/// 1e-25 m2 per molecule.
constexpr Bins ozone_section = {
    0.0118, 0.002182, 0.002818, 0.006636, 0.01527, 0.02763, 0.0552, 0.08451, 0.1582, 0.2316, 0.3669,
    0.4924, 0.7752,   0.9016,   1.48,     1.602,   2.139,   2.755,  3.091,   3.5,    4.266,  4.672,
    4.398,  4.701,    5.019,    4.305,    3.74,    3.215,   2.662,  2.238,   1.852,  1.473,  1.209,
    0.9423, 0.7455,   0.6566,   0.5105,   0.415,   0.4228,  0.3237, 0.2451,  0.2801, 0.2534};

/// 300 Dobson units of 2.687e20 molecules per m2, in 1e25.
constexpr double ozone_column = 300 * 2.687e-5;

constexpr double solar_constant_w_m2 = 1361, lumens_per_watt = 683;

/// Straight lines between the middles of bins.
double at(const Bins& bins, double wavelength_nm) {
    const double cell = (wavelength_nm - first_bin_nm) / bin_nm - 0.5;
    const int i = std::clamp(static_cast<int>(cell), 0, static_cast<int>(bins.size()) - 2);
    const auto row = static_cast<std::size_t>(i);
    return bins[row] + (cell - i) * (bins[row + 1] - bins[row]);
}

double molecules_depth(double wavelength_nm) {
    const double um = wavelength_nm / 1000, a = um * um, b = 1 / a;
    return 0.0021520 * (1.0455996 - 341.29061 * b - 0.90230850 * a) / (1 + 0.0027059889 * b - 85.968563 * a);
}

double aerosol_depth(double turbidity, double wavelength_nm) {
    const double beta = std::max(0.0, 0.04608 * turbidity - 0.04586);
    return beta * num::pow(wavelength_nm / 1000, -1.3);
}

/// The observer's answer to the sun's light at one wavelength, per nm.
Vec3d sun_xyz(double wavelength_nm) {
    return observer_xyz(wavelength_nm) * at(sun_power, wavelength_nm);
}

/// Sum over the visible by steps of 1 nm, W/m2.
Vec3d whole_sun_xyz() {
    Vec3d sum;
    for (int i = 0; shortest_visible_nm + i <= longest_visible_nm; ++i)
        sum = sum + sun_xyz(shortest_visible_nm + i);
    return sum;
}

}  // namespace

AirSpectrum air_spectrum(double turbidity, Vec3d sun_above_air, int count) {
    CHECK(turbidity >= 1 && turbidity <= 10);
    CHECK(count >= 4 && count <= most_wavelengths);
    AirSpectrum air;
    air.count = count;
    air.aerosol_scattered = 0.925;
    // The outermost stand for all beyond, so they stand about a step inside of where the observer sees
    // anything. Ten meet both bands of ozone at 575 and 603 nm.
    const double step = 310 / (count + 1.625), shortest = 390 + 1.125 * step;
    const auto last = static_cast<std::size_t>(count - 1);
    for (std::size_t i = 0; i <= last; ++i) {
        const double nm = shortest + step * static_cast<double>(i);
        air.wavelength_nm[i] = nm;
        air.molecules[i] = molecules_depth(nm);
        air.aerosol[i] = aerosol_depth(turbidity, nm);
        air.ozone[i] = ozone_column * at(ozone_section, nm);
    }
    // Between wavelengths what the air does to light is taken as linear; the sun's lines and the observer are
    // not.
    std::array<Vec3d, most_wavelengths> xyz{};
    for (int k = 0; shortest_visible_nm + k <= longest_visible_nm; ++k) {
        const double nm = shortest_visible_nm + k;
        const double cell = std::clamp((nm - shortest) / step, 0.0, static_cast<double>(last));
        const std::size_t i = std::min(static_cast<std::size_t>(cell), last - 1);
        const double t = cell - static_cast<double>(i);
        xyz[i] = xyz[i] + sun_xyz(nm) * (1 - t);
        xyz[i + 1] = xyz[i + 1] + sun_xyz(nm) * t;
    }
    const Vec3d whole = srgb_from_xyz(whole_sun_xyz());
    const Vec3d scale{sun_above_air.x / whole.x, sun_above_air.y / whole.y, sun_above_air.z / whole.z};
    for (std::size_t i = 0; i <= last; ++i)
        air.rgb[i] = srgb_from_xyz(xyz[i]) * scale;
    return air;
}

Vec3d sun_above_air_true() {
    const Vec3d xyz = whole_sun_xyz();
    return srgb_from_xyz(xyz * (solar_constant_w_m2 / 3 / xyz.y));
}

double lux_per_watt() {
    return lumens_per_watt * whole_sun_xyz().y / (solar_constant_w_m2 / 3);
}

Spectrum reflectance(const AirSpectrum& air, Vec3d rgb) {
    Spectrum out{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i) {
        const double nm = air.wavelength_nm[i];
        const double green = std::clamp((nm - 480) / 30, 0.0, 1.0),
                     red = std::clamp((nm - 575) / 30, 0.0, 1.0);
        out[i] = rgb.z + (rgb.y - rgb.z) * green + (rgb.x - rgb.y) * red;
    }
    return out;
}

void transmittance(const AirSpectrum& air, const AirAmount& amount, double scale, Spectrum& out) {
    optical_depth(air, amount, out);
    for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i)
        out[i] = scale * exp_of_depth(-out[i]);
}

Vec3d rgb_of(const AirSpectrum& air, const Spectrum& light) {
    Vec3d sum;
    for (std::size_t i = 0; i < static_cast<std::size_t>(air.count); ++i)
        sum = sum + air.rgb[i] * light[i];
    return sum;
}

}  // namespace obscura
