// Multiple scattering as even light.
//
// S. Hillaire: A scalable and production ready sky and atmosphere rendering technique, EGSR 2020,
// section 5.5: higher orders are even to all sides, so a table over height and the sun's zenith angle holds
// them. There the second order is computed and the rest is its geometric series, as if the neighbourhood were
// lit alike; at dusk it is not, so orders are summed here one after another (as Bruneton and Neyret 2008,
// algorithm 4.1, do with directions), and only what is left after the last one is a series.

#include "core/sky/scattered_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "core/sky/exp_lanes.h"
#include "core/sky/view_path.h"

namespace obscura {

namespace {

constexpr int heights = 14, suns = 48;
constexpr int slopes = 12, turns = 3, path_steps = 24;  ///< directions of a sphere, and steps along each
constexpr double lowest_cos_sun = -0.42, horizon_width = 0.2;
constexpr double least_light = 1e-60;

/// Nodes stand densest where the sun is at the horizon: (1 + c) m / (|m| + c) is even between them.
double sun_axis(double cos_sun) {
    return (1 + horizon_width) * cos_sun / (std::abs(cos_sun) + horizon_width);
}
double sun_cell(double cos_sun) {
    const double low = sun_axis(lowest_cos_sun);
    return (sun_axis(std::clamp(cos_sun, lowest_cos_sun, 1.0)) - low) / (1 - low) * (suns - 1);
}
double cos_sun_of_node(int node) {
    const double low = sun_axis(lowest_cos_sun);
    const double x = low + (1 - low) * node / (suns - 1);
    return std::clamp(horizon_width * x / (1 + horizon_width - std::abs(x)), -1.0, 1.0);
}
double height_of_node(int node) {
    const double x = static_cast<double>(node) / (heights - 1);
    return air_top_km * (x * x) * (x * x);
}

struct Cell {
    std::size_t node = 0;
    double share = 0;
};
Cell cell_of(double x, int nodes) {
    const int i = std::clamp(static_cast<int>(x), 0, nodes - 2);
    return {static_cast<std::size_t>(i), std::clamp(x - i, 0.0, 1.0)};
}

double cos_of_slope(int slope) {
    const int half = slopes / 2;
    const double x = (slope % half + 0.5) / half;
    return slope < half ? x * x : -x * x;
}
/// Share of the sphere.
double share_of_slope(int slope) {
    const int half = slopes / 2;
    return (slope % half + 0.5) / half / half;
}

/// What one order of scattering sends through the air: mean radiance by [height][sun][wavelength] and
/// irradiance of the ground by [sun][wavelength].
struct Order {
    std::vector<double> mean, ground;
};

struct Scattering {
    const AirSpectrum& air;
    Spectrum albedo;
    std::size_t count;
    std::vector<ViewPath> paths;         ///< [height][slope]
    std::array<double, turns> cos_turn;  ///< azimuths from the sun's

    std::size_t sun_row(std::size_t height, std::size_t sun) const { return (height * suns + sun) * count; }
};

Scattering scattering_of(const AirSpectrum& air, const Spectrum& albedo, const Exec& exec) {
    Scattering s{air, albedo, static_cast<std::size_t>(air.count), {}, {}};
    s.paths.resize(heights * slopes);
    parallel_for(heights, exec, [&](std::size_t height) {
        for (int slope = 0; slope < slopes; ++slope)
            s.paths[height * slopes + static_cast<std::size_t>(slope)] =
                view_path(air, height_of_node(static_cast<int>(height)), cos_of_slope(slope), path_steps);
    });
    for (int turn = 0; turn < turns; ++turn)
        s.cos_turn[static_cast<std::size_t>(turn)] = num::cos_deg(180 * (turn + 0.5) / turns);
    return s;
}

/// Straight lines between logarithms.
void irradiance_of_ground(const Scattering& s, const std::vector<double>& log_ground, double cos_sun,
                          Spectrum& out) {
    const Cell cell = cell_of(sun_cell(cos_sun), suns);
    const double* low = &log_ground[cell.node * s.count];
    const double* high = low + s.count;
    for (std::size_t i = 0; i < s.count; ++i)
        out[i] = exp_of_depth(low[i] + (high[i] - low[i]) * cell.share);
}

/// The sun's light once scattered.
void add_first(const Scattering& s, const ViewPath& path, double cos_sun, double cos_between, Spectrum& sum) {
    const double by_molecules = molecules_phase(cos_between) / (4 * num::pi), by_aerosol = 1 / (4 * num::pi);
    Spectrum sunlight;
    for (const PathStep& step : path.steps) {
        const double local = cos_sun_at(path, step, cos_sun, cos_between);
        const double share = sun_share(step.height_km, local);
        if (share == 0) continue;
        transmittance(s.air, air_to_space(step.height_km, local), share, sunlight);
        for (std::size_t i = 0; i < s.count; ++i)
            sum[i] += sunlight[i] * (step.molecules[i] * by_molecules + step.aerosol[i] * by_aerosol);
    }
}

/// Even light scattered once more.
void add_further(const Scattering& s, const ScatteredLight& before, const ViewPath& path, double cos_sun,
                 double cos_between, Spectrum& sum) {
    Spectrum even;
    for (const PathStep& step : path.steps) {
        mean_radiance(before, step.height_km, cos_sun_at(path, step, cos_sun, cos_between), even);
        for (std::size_t i = 0; i < s.count; ++i)
            sum[i] += even[i] * (step.molecules[i] + step.aerosol[i]);
    }
}

/// One order at one height: from the sun when `before` is null, else from the order before.
void scatter_at(const Scattering& s, const ScatteredLight* before, const std::vector<double>& log_ground,
                std::size_t height, Order& order) {
    for (std::size_t sun = 0; sun < suns; ++sun) {
        const double cos_sun = cos_sun_of_node(static_cast<int>(sun));
        const double sin_sun = std::sqrt(std::max(0.0, 1 - cos_sun * cos_sun));
        double* mean = &order.mean[s.sun_row(height, sun)];
        for (int slope = 0; slope < slopes; ++slope) {
            const ViewPath& path = s.paths[height * slopes + static_cast<std::size_t>(slope)];
            const double cosine = path.cos_zenith, sine = std::sqrt(1 - cosine * cosine);
            const double share = share_of_slope(slope) / turns;
            for (const double cos_turn : s.cos_turn) {
                const double cos_between = cosine * cos_sun + sine * sin_sun * cos_turn;
                Spectrum light{};
                if (before) {
                    add_further(s, *before, path, cos_sun, cos_between, light);
                } else {
                    add_first(s, path, cos_sun, cos_between, light);
                }
                if (path.end.on_ground && height > 0) {
                    Spectrum ground;
                    irradiance_of_ground(s, log_ground, cos_sun_at_end(path, cos_sun, cos_between), ground);
                    for (std::size_t i = 0; i < s.count; ++i)
                        light[i] += path.passed[i] * ground[i] * s.albedo[i] / num::pi;
                }
                for (std::size_t i = 0; i < s.count; ++i)
                    mean[i] += light[i] * share;
                if (height > 0 || cosine < 0) continue;
                for (std::size_t i = 0; i < s.count; ++i)
                    order.ground[sun * s.count + i] += light[i] * share * cosine * 4 * num::pi;
            }
        }
        // On the ground itself the lower half is the ground.
        if (height > 0) continue;
        Spectrum ground;
        irradiance_of_ground(s, log_ground, cos_sun, ground);
        for (std::size_t i = 0; i < s.count; ++i)
            mean[i] += 0.5 * ground[i] * s.albedo[i] / num::pi;
    }
}

std::vector<double> logarithms(const std::vector<double>& values) {
    std::vector<double> logs;
    logs.reserve(values.size());
    for (const double value : values)
        logs.push_back(num::log(std::max(value, least_light)));
    return logs;
}

/// What the sun itself sends to level ground.
std::vector<double> sun_on_ground(const AirSpectrum& air) {
    std::vector<double> ground;
    for (int sun = 0; sun < suns; ++sun) {
        const double cos_sun = cos_sun_of_node(sun);
        Spectrum light;
        transmittance(air, air_to_space(0, cos_sun), std::max(0.0, cos_sun), light);
        ground.insert(ground.end(), light.begin(), light.begin() + air.count);
    }
    return ground;
}

/// The orders left, each as much of the one before as the last was; but never more than over all of the air
/// at this wavelength, where light that is still on its way from brighter places does not count as growth.
void add_further_orders(const Scattering& s, const std::vector<double>& last_but_one,
                        const std::vector<double>& last, std::vector<double>& total) {
    for (std::size_t i = 0; i < s.count; ++i) {
        double before = 0, after = 0;
        for (std::size_t at = i; at < last.size(); at += s.count) {
            before += last_but_one[at];
            after += last[at];
        }
        const double most = before > 0 ? std::min(0.95, after / before) : 0;
        for (std::size_t at = i; at < last.size(); at += s.count) {
            const double ratio = last_but_one[at] > 0 ? std::min(most, last[at] / last_but_one[at]) : 0;
            total[at] += last[at] * ratio / (1 - ratio);
        }
    }
}

}  // namespace

ScatteredLight scattered_light(const AirSpectrum& air, const Spectrum& albedo, int orders, const Exec& exec) {
    CHECK(orders >= 2);
    const Scattering s = scattering_of(air, albedo, exec);
    std::vector<double> total(heights * suns * s.count), last;
    std::vector<double> log_ground = logarithms(sun_on_ground(air));
    ScatteredLight before{{}, air.count};
    Order order;
    for (int n = 0; n < orders; ++n) {
        last = order.mean;
        order = {std::vector<double>(total.size()), std::vector<double>(suns * s.count)};
        parallel_for(heights, exec, [&](std::size_t height) {
            scatter_at(s, n == 0 ? nullptr : &before, log_ground, height, order);
        });
        before.log_mean = logarithms(order.mean);
        log_ground = logarithms(order.ground);
        for (std::size_t i = 0; i < total.size(); ++i)
            total[i] += order.mean[i];
    }
    add_further_orders(s, last, order.mean, total);
    return {logarithms(total), air.count};
}

void mean_radiance(const ScatteredLight& light, double height_km, double cos_sun, Spectrum& out) {
    const Cell height = cell_of(
        std::sqrt(std::sqrt(std::clamp(height_km, 0.0, air_top_km) / air_top_km)) * (heights - 1), heights);
    const Cell sun = cell_of(sun_cell(cos_sun), suns);
    const auto count = static_cast<std::size_t>(light.wavelengths);
    const double* low = &light.log_mean[(height.node * suns + sun.node) * count];
    const double* high = low + suns * count;
    const double u = height.share, v = sun.share;
    for (std::size_t i = 0; i < count; ++i) {
        const double below = low[i] + (low[count + i] - low[i]) * v;
        const double above = high[i] + (high[count + i] - high[i]) * v;
        out[i] = exp_of_depth(below + (above - below) * u);
    }
}

double molecules_phase(double cosine) {
    return 0.75 * (1 + cosine * cosine);
}

double aerosol_phase(double cosine) {
    const auto lobe = [&](double g) {
        const double d = 1 + g * (g - 2 * cosine);
        return (1 - g * g) / (d * std::sqrt(d));
    };
    return 0.9 * lobe(0.8) + 0.1 * lobe(-0.17);
}

}  // namespace obscura
