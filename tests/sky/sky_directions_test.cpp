// Directions of a sky: the light they carry against fine quadrature, their order, their shares.

#include "core/sky/sky_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "core/observer.h"
#include "core/sky/sky_model.h"

namespace obscura {
namespace {

const Exec exec{};

ClearSky clear_sky_at(double elevation_deg) {
    return clear_sky(clear_air({}, exec), 140, elevation_deg, exec);
}

Vec3d sum_over(const std::vector<SkyDirection>& directions, Vec3d normal) {
    Vec3d sum;
    for (const SkyDirection& d : directions)
        sum = sum + to_double(d.irradiance_w_m2) * std::max(0.0, dot(normal, d.direction));
    return sum;
}

/// The largest relative difference of a channel.
double difference(Vec3d a, Vec3d b) {
    return std::max({std::abs(a.x / b.x - 1), std::abs(a.y / b.y - 1), std::abs(a.z / b.z - 1)});
}

/// By middles of bands of equal height and of azimuth, without the grid.
Vec3d irradiance_by_bands(const std::function<Vec3f(Vec3d)>& radiance, Vec3d normal) {
    const int bands = 300, azimuths = 600;
    Vec3d sum;
    for (int j = 0; j < bands; ++j) {
        const double height = (j + 0.5) / bands, level = std::sqrt(1 - height * height);
        for (int i = 0; i < azimuths; ++i) {
            const double turn = 2 * num::pi * (i + 0.5) / azimuths;
            const Vec3d direction{level * std::cos(turn), height, level * std::sin(turn)};
            const double cosine = dot(direction, normal);
            if (cosine > 0) sum = sum + to_double(radiance(direction)) * cosine;
        }
    }
    return sum * (2 * num::pi / (bands * azimuths));
}

TEST(SkyGrid, IsTheSky) {
    const ClearSky sky = clear_sky_at(20);
    const auto radiance = [&](Vec3d direction) { return sky_radiance(sky, direction); };
    const SkyGrid grid = sky_grid(radiance, exec);
    for (const Vec3d normal :
         {Vec3d{0, 1, 0}, compass_direction(140, 0), compass_direction(300, 0), compass_direction(60, 45)})
        EXPECT_LT(difference(unoccluded_irradiance(grid, normal), irradiance_by_bands(radiance, normal)),
                  1e-3);
    EXPECT_LT(difference(unoccluded_irradiance(grid, {0, 1, 0}), to_double(sky.sky_irradiance_w_m2)), 1e-3);
    // An even sky: pi level, half of it on a wall.
    const SkyGrid even = sky_grid([](Vec3d) { return Vec3f{1, 2, 3}; }, exec);
    EXPECT_NEAR(unoccluded_irradiance(even, {0, 1, 0}).x, num::pi, 2e-4);
    EXPECT_NEAR(unoccluded_irradiance(even, {1, 0, 0}).z, 1.5 * num::pi, 1e-4);
}

/// The worst of level, upright and tilted surfaces to all sides.
struct Worst {
    double level = 0, upright = 0, tilted = 0;
};
Worst worst_of(const SkyGrid& grid, int count, SkyImportance importance) {
    const std::vector<SkyDirection> directions = sky_directions(grid, count, importance);
    EXPECT_EQ(directions.size(), static_cast<std::size_t>(count));
    const auto error = [&](Vec3d normal) {
        return difference(sum_over(directions, normal), unoccluded_irradiance(grid, normal));
    };
    Worst worst{error({0, 1, 0})};
    for (int azimuth = 0; azimuth < 360; azimuth += 15) {
        worst.upright = std::max(worst.upright, error(compass_direction(azimuth, 0)));
        worst.tilted = std::max(worst.tilted, error(compass_direction(azimuth, 45)));
    }
    return worst;
}

struct Bound {
    int count;
    SkyImportance importance;
    double level, upright, tilted;
};

TEST(SkyDirections, TogetherTheyAreTheSky) {
    for (const double elevation : {60.0, 10.0, -4.0}) {
        const ClearSky sky = clear_sky_at(elevation);
        const SkyGrid grid = sky_grid(sky, exec);
        for (const Bound& b : {Bound{16, SkyImportance::radiance, 0.06, 0.2, 0.11},
                               Bound{64, SkyImportance::radiance, 0.025, 0.06, 0.035},
                               Bound{256, SkyImportance::radiance, 0.008, 0.014, 0.009},
                               Bound{1024, SkyImportance::radiance, 0.003, 0.004, 0.0025},
                               Bound{64, SkyImportance::root, 0.025, 0.025, 0.025},
                               Bound{256, SkyImportance::root, 0.008, 0.006, 0.006},
                               Bound{1024, SkyImportance::root, 0.002, 0.0016, 0.0015},
                               Bound{256, SkyImportance::cosine, 0.05, 0.05, 0.05}}) {
            const Worst worst = worst_of(grid, b.count, b.importance);
            EXPECT_LT(worst.level, b.level) << elevation << " " << b.count;
            EXPECT_LT(worst.upright, b.upright) << elevation << " " << b.count;
            EXPECT_LT(worst.tilted, b.tilted) << elevation << " " << b.count;
        }
    }
}

TEST(SkyDirections, OvercastByCosines) {
    const SkyModel sky = overcast_sky(30, {5, 5, 5}, {0.2, 0.2, 0.2});
    const SkyGrid grid = sky_grid(sky, exec);
    for (const auto& [count, bound] : {std::pair{16, 0.08}, {64, 0.02}, {256, 0.005}, {1024, 0.0015}}) {
        const Worst worst = worst_of(grid, count, SkyImportance::cosine);
        EXPECT_LT(worst.level, 1e-6);
        EXPECT_LT(worst.upright, bound) << count;
        EXPECT_LT(worst.tilted, bound) << count;
    }
    // Level ground gets about the same from each.
    double least = 1e9, most = 0;
    for (const SkyDirection& d : sky_directions(sky_grid(
                                                    [](Vec3d) {
                                                        return Vec3f{1, 1, 1};
                                                    },
                                                    exec),
                                                256, SkyImportance::cosine)) {
        const double light = d.direction.y * static_cast<double>(d.irradiance_w_m2.y);
        least = std::min(least, light);
        most = std::max(most, light);
    }
    EXPECT_LT(most, 1.25 * least);
}

TEST(SkyDirections, EachIsWorthTheSame) {
    const SkyGrid grid = sky_grid(clear_sky_at(40), exec);
    for (const int count : {16, 64, 256}) {
        double least = 1e9, most = 0;
        for (const SkyDirection& d : sky_directions(grid, count, SkyImportance::radiance)) {
            const double light = srgb_luminance(to_double(d.irradiance_w_m2));
            least = std::min(least, light);
            most = std::max(most, light);
            EXPECT_NEAR(length(d.direction), 1, 1e-12);
            EXPECT_GT(d.direction.y, 0);
        }
        EXPECT_LT(most, 1.5 * least) << count;
    }
}

TEST(SkyDirections, NeighboursInTheListAreNeighboursInTheSky) {
    const SkyGrid grid = sky_grid([](Vec3d) { return Vec3f{1, 1, 1}; }, exec);
    for (const int count : {16, 64, 256, 1024}) {
        const std::vector<SkyDirection> d = sky_directions(grid, count, SkyImportance::radiance);
        double farthest = 0;
        for (std::size_t k = 0; k + 1 < d.size(); ++k)
            farthest = std::max(farthest, std::acos(std::min(1.0, dot(d[k].direction, d[k + 1].direction))));
        // Parts are about sqrt(2 pi / count) wide.
        EXPECT_LT(farthest, 1.8 * std::sqrt(2 * num::pi / count)) << count;
        // Half of the list is half of the sky.
        Vec3d half;
        for (std::size_t k = 0; k < d.size() / 2; ++k)
            half = half + d[k].direction;
        EXPECT_GT(std::max(std::abs(half.x), std::abs(half.z)), 0.2 * count);
    }
}

TEST(SkyDirections, BlackSkiesAndSkiesOfOneSpot) {
    const SkyGrid black = sky_grid([](Vec3d) { return Vec3f{}; }, exec);
    for (const SkyDirection& d : sky_directions(black, 64, SkyImportance::radiance)) {
        EXPECT_EQ(d.irradiance_w_m2, Vec3f{});
        EXPECT_GT(d.direction.y, 0);
    }
    const Vec3d spot = normalize(Vec3d{1, 2, -0.5});
    const SkyGrid one = sky_grid(
        [&](Vec3d d) {
            return dot(d, spot) > 0.9998 ? Vec3f{9, 8, 7} : Vec3f{};
        },
        exec);
    const std::vector<SkyDirection> d = sky_directions(one, 256, SkyImportance::radiance);
    for (const Vec3d normal : {Vec3d{0, 1, 0}, Vec3d{1, 0, 0}})
        EXPECT_LT(difference(sum_over(d, normal), unoccluded_irradiance(one, normal)), 1e-6);
}

}  // namespace
}  // namespace obscura
