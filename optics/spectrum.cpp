// Light by wavelength. D65: CIE 15:2004, table T.1.

#include "optics/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/num.h"

namespace obscura {

namespace {

/// A Gaussian whose halves have inverse widths `below` and `above` the middle.
double lobe(double x, double middle, double below, double above) {
    const double t = (x - middle) * (x < middle ? below : above);
    return num::exp(-0.5 * t * t);
}

constexpr std::array<double, 41> d65_table = {
    49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923,
    108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856,
    90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091,
    74.3490, 61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

double d65_power(double wavelength_nm) {
    const double cell = (wavelength_nm - shortest_visible_nm) / 10;
    const int i = std::clamp(static_cast<int>(cell), 0, static_cast<int>(d65_table.size()) - 2);
    const double t = cell - i;
    const auto at = static_cast<std::size_t>(i);
    return d65_table[at] + t * (d65_table[at + 1] - d65_table[at]);
}

/// Planck's law, relative to its value at 560 nm.
double blackbody_power(double kelvin, double wavelength_nm) {
    const double second_radiation_constant_nm_k = 1.438776877e7;
    const auto emitted = [&](double nm) {
        const double ratio = 560 / nm;
        return ratio * ratio * ratio * ratio * ratio /
               (num::exp(second_radiation_constant_nm_k / (nm * kelvin)) - 1);
    };
    return emitted(wavelength_nm) / emitted(560);
}

struct Line {
    double wavelength_nm, power;
};
constexpr double line_deviation_nm = 0.05;
constexpr std::array<Line, 2> sodium_lines = {{{588.995, 2}, {589.592, 1}}};

double line_power(const Line& line, double wavelength_nm) {
    return line.power * lobe(wavelength_nm, line.wavelength_nm, 1 / line_deviation_nm, 1 / line_deviation_nm);
}

/// Full widths at half height; powers solve for the chromaticity of D65 as this observer sees it.
struct Diode {
    double wavelength_nm, width_nm, power;
};
constexpr std::array<Diode, 3> diodes = {{{465, 22, 0.5778201}, {525, 33, 0.4916569}, {630, 18, 1}}};

double diode_power(const Diode& diode, double wavelength_nm) {
    const double inverse_deviation = 2.3548200450309493 / diode.width_nm;
    return diode.power * lobe(wavelength_nm, diode.wavelength_nm, inverse_deviation, inverse_deviation);
}

/// The light's lines, when it consists of lines.
std::vector<Line> lines_of(const LightSpectrum& light) {
    if (light.source == LightSource::sodium) return {sodium_lines.begin(), sodium_lines.end()};
    if (light.source == LightSource::monochromatic) return {{light.wavelength_nm, 1}};
    return {};
}

/// Integral of power times observer, unscaled; steps of 1 nm, by the trapezoid rule.
Vec3d integrate(const LightSpectrum& light) {
    Vec3d sum;
    const std::vector<Line> lines = lines_of(light);
    for (const Line& line : lines)
        sum = sum + observer_xyz(line.wavelength_nm) * line.power;
    if (!lines.empty()) return sum;
    const int steps = static_cast<int>(longest_visible_nm - shortest_visible_nm);
    for (int i = 0; i <= steps; ++i) {
        const double nm = shortest_visible_nm + i;
        const double share = i == 0 || i == steps ? 0.5 : 1;
        sum = sum + observer_xyz(nm) * (share * spectral_power(light, nm));
    }
    return sum;
}

/// What the observer's fit is scaled by so that D65 is the white of sRGB.
Vec3d observer_scale() {
    static const Vec3d scale = [] {
        const Vec3d white = xyz_from_srgb({1, 1, 1}), fitted = integrate({LightSource::d65});
        return Vec3d{white.x * fitted.y / fitted.x, white.y, white.z * fitted.y / fitted.z};
    }();
    return scale;
}

/// Strength of the eye's strongest response to the light, by wavelength.
double response(const LightSpectrum& light, double wavelength_nm) {
    const Vec3d eye = observer_xyz(wavelength_nm);
    return spectral_power(light, wavelength_nm) * std::max({eye.x, eye.y, eye.z});
}

constexpr double least_response = 1e-3;  ///< of the strongest: what lies below is left out

struct Interval {
    double shortest_nm = 0, longest_nm = 0;
};

/// Where the light shows, to whole nanometres.
Interval visible_interval(const LightSpectrum& light) {
    const int steps = static_cast<int>(longest_visible_nm - shortest_visible_nm);
    std::vector<double> strength;
    for (int i = 0; i <= steps; ++i)
        strength.push_back(response(light, shortest_visible_nm + i));
    const double least = least_response * *std::max_element(strength.begin(), strength.end());
    const auto shows = [&](double s) { return s >= least; };
    const auto first = std::find_if(strength.begin(), strength.end(), shows);
    const auto last = std::find_if(strength.rbegin(), strength.rend(), shows);
    return {shortest_visible_nm + static_cast<double>(first - strength.begin()),
            longest_visible_nm - static_cast<double>(last - strength.rbegin())};
}

/// The unscaled sample at a wavelength that stands for `width_nm` of the spectrum.
SpectralSample sample_at(const LightSpectrum& light, double wavelength_nm, double width_nm) {
    return {
        wavelength_nm, observer_xyz(wavelength_nm) * (width_nm * spectral_power(light, wavelength_nm)), {}};
}

/// Middles of equal steps of 1 / wavelength, of a light without lines, those that show.
std::vector<SpectralSample> continuous_samples(const LightSpectrum& light, int count) {
    const Interval shown = visible_interval(light);
    const double first = 1 / shown.longest_nm;
    const double step = (1 / shown.shortest_nm - first) / count;
    std::vector<double> wavelengths;
    double strongest = 0;
    for (int i = count - 1; i >= 0; --i) {
        wavelengths.push_back(1 / (first + (i + 0.5) * step));
        strongest = std::max(strongest, response(light, wavelengths.back()));
    }
    std::vector<SpectralSample> samples;
    for (const double nm : wavelengths) {
        if (response(light, nm) >= least_response * strongest)
            samples.push_back(sample_at(light, nm, nm * nm * step));
    }
    return samples;
}

/// Makes up for what a quadrature misses of each of X, Y and Z, in proportion; adds sRGB.
void balance(const LightSpectrum& light, std::vector<SpectralSample>& samples) {
    Vec3d sum;
    for (const SpectralSample& sample : samples)
        sum = sum + sample.xyz;
    const Vec3d whole = light_xyz(light);
    const Vec3d scale{whole.x / sum.x, whole.y / sum.y, whole.z / sum.z};
    for (SpectralSample& sample : samples) {
        sample.xyz = sample.xyz * scale;
        sample.rgb = srgb_from_xyz(sample.xyz);
    }
}

std::vector<SpectralSample> line_samples(const std::vector<Line>& lines, int count) {
    std::vector<SpectralSample> samples;
    if (count >= static_cast<int>(lines.size())) {
        for (const Line& line : lines)
            samples.push_back({line.wavelength_nm, observer_xyz(line.wavelength_nm) * line.power, {}});
        return samples;
    }
    // Fewer samples than lines: their mean.
    double power = 0, moment = 0;
    for (const Line& line : lines) {
        power += line.power;
        moment += line.power * line.wavelength_nm;
    }
    return {{moment / power, observer_xyz(moment / power), {}}};
}

}  // namespace

const char* light_source_name(LightSource source) {
    constexpr const char* names[] = {"d65", "equal", "blackbody", "sodium", "rgb_led", "monochromatic"};
    return names[static_cast<int>(source)];
}

double spectral_power(const LightSpectrum& light, double wavelength_nm) {
    if (!(wavelength_nm >= shortest_visible_nm && wavelength_nm <= longest_visible_nm)) return 0;
    double sum = 0;
    switch (light.source) {
        case LightSource::d65:
            return d65_power(wavelength_nm);
        case LightSource::equal:
            return 1;
        case LightSource::blackbody:
            CHECK(light.kelvin >= 500 && light.kelvin <= 1e6);
            return blackbody_power(light.kelvin, wavelength_nm);
        case LightSource::rgb_led:
            for (const Diode& diode : diodes)
                sum += diode_power(diode, wavelength_nm);
            return sum;
        case LightSource::sodium:
        case LightSource::monochromatic:
            for (const Line& line : lines_of(light))
                sum += line_power(line, wavelength_nm);
            return sum;
    }
    return sum;
}

bool has_lines(const LightSpectrum& light) {
    return !lines_of(light).empty();
}

Vec3d light_xyz(const LightSpectrum& light) {
    const Vec3d sum = integrate(light) * observer_scale();
    return sum * (1 / sum.y);
}

std::vector<SpectralSample> spectral_samples(const LightSpectrum& light, int count) {
    CHECK(count >= 1);
    CHECK(light.source != LightSource::monochromatic ||
          (light.wavelength_nm >= shortest_visible_nm && light.wavelength_nm <= longest_visible_nm));
    const std::vector<Line> lines = lines_of(light);
    std::vector<SpectralSample> samples =
        lines.empty() ? continuous_samples(light, count) : line_samples(lines, count);
    balance(light, samples);
    return samples;
}

std::vector<SpectralSample> geometric_samples(const LightSpectrum& light, int count) {
    CHECK(count >= 1);
    if (!lines_of(light).empty()) return {};
    const Interval shown = visible_interval(light);
    const double step = num::log(shown.longest_nm / shown.shortest_nm) / count;
    std::vector<SpectralSample> samples;
    for (int i = 0; i < count; ++i) {
        const double nm = shown.shortest_nm * num::exp((i + 0.5) * step);
        samples.push_back(sample_at(light, nm, nm * step));
    }
    balance(light, samples);
    return samples;
}

SpectralRate spectral_rate(const LightSpectrum& light, double cycles_per_scale, double tolerance) {
    CHECK(cycles_per_scale >= 0 && tolerance > 0 && tolerance < 1);
    const std::vector<Line> lines = lines_of(light);
    SpectralRate rate;
    if (!lines.empty()) {
        rate.least_scale = 550 / lines.back().wavelength_nm;
        rate.largest_scale = 550 / lines.front().wavelength_nm;
        rate.count = static_cast<int>(lines.size());
        return rate;
    }
    const Interval shown = visible_interval(light);
    rate.least_scale = 550 / shown.longest_nm;
    rate.largest_scale = 550 / shown.shortest_nm;
    // A sum over even steps is the integral as long as no fringe beats with them: their rate must exceed that
    // of the fringes by what the light's own response, as a function of scale, has room for. Responses are
    // about Gaussian, of deviation d; their spectra fall below the tolerance at sqrt(2 ln(1/tolerance)) /
    // (2 pi d). The narrowest are the steep side of the observer's blue lobe, 0.03, and the red diode.
    const double deviation = light.source == LightSource::rgb_led ? 0.0106 : 0.03;
    const double room = std::sqrt(2 * num::log(1 / tolerance)) / (2 * num::pi * deviation);
    rate.samples_per_scale = cycles_per_scale + room;
    rate.count = static_cast<int>(
        std::ceil(std::min(1e6, (rate.largest_scale - rate.least_scale) * rate.samples_per_scale)));
    return rate;
}

void check_sampling(int wavelengths, double tolerance) {
    if (wavelengths < 0 || wavelengths > 100000) throw InputError("", "wavelength count must be 0 to 100000");
    if (!(tolerance >= 1e-4 && tolerance <= 0.5)) throw InputError("", "tolerance must be 0.0001 to 0.5");
}

}  // namespace obscura
