// Light gathered by square pixels against integrals known in closed form or by fine quadrature.

#include "optics/pixel_integrals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

constexpr double extent = 64;  ///< of the apertures below, in texels

double sinc_squared(double x) {
    return x == 0 ? 1 : std::pow(std::sin(M_PI * x) / (M_PI * x), 2);
}

template <class Power>
PowerSource source_of(Power power) {
    return [power](const FrequencyGrid& grid) {
        Image<float> image(grid.width, grid.height);
        for (int y = 0; y < grid.height; ++y) {
            for (int x = 0; x < grid.width; ++x) {
                image(x, y) =
                    static_cast<float>(power(grid.first_u + x * grid.step_u, grid.first_v + y * grid.step_v));
            }
        }
        return image;
    };
}

/// A box of extent x extent texels and of extent / 2 in height.
double box_power(double u, double v) {
    const double area = extent * extent / 2;
    return area * area * sinc_squared(u * extent) * sinc_squared(v * extent / 2);
}

/// Integral of width^2 sinc^2(width t) from a to b; its whole is `width`.
double sinc_integral(double width, double a, double b) {
    const int steps = 4000;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        sum += sinc_squared(width * (a + (b - a) * (i + 0.5) / steps));
    return sum * (b - a) / steps * width * width;
}

double box_integral(double pixel, int x, int y) {
    return sinc_integral(extent, (x - 0.5) * pixel, (x + 0.5) * pixel) *
           sinc_integral(extent / 2, (y - 0.5) * pixel, (y + 0.5) * pixel);
}

TEST(PixelIntegrals, GatherABoxsPattern) {
    // From a pixel that is a small part of the central spot to one of many fringes.
    for (const double fringes : {0.25, 1.3, 4.2, 17.0}) {
        const double pixel = fringes / extent;
        const double cell = std::min(0.5 / extent, pixel / 8);
        const auto kernel = integrate_over_pixels(source_of(box_power), cell, 12, {{pixel, {1, 2, 0}}}, {});
        ASSERT_EQ(kernel.width, 25);
        ASSERT_EQ(kernel.height, 25);
        double total = 0, worst = 0;
        for (int y = -12; y <= 12; ++y) {
            for (int x = -12; x <= 12; ++x) {
                const Vec3d got = kernel(x + 12, y + 12);
                const double expected = box_integral(pixel, x, y);
                total += got.x;
                EXPECT_DOUBLE_EQ(got.y, 2 * got.x);
                EXPECT_EQ(got.z, 0);
                worst = std::max(worst, std::fabs(got.x - expected) / box_integral(pixel, 0, 0));
            }
        }
        EXPECT_LT(worst, 1e-2) << fringes;
        EXPECT_NEAR(total,
                    sinc_integral(extent, -12.5 * pixel, 12.5 * pixel) *
                        sinc_integral(extent / 2, -12.5 * pixel, 12.5 * pixel),
                    1e-3 * extent * extent / 2);
    }
}

TEST(PixelIntegrals, FinerCellsAreCloser) {
    const double pixel = 1.0 / extent;
    double before = 1;
    for (const double cells : {2.0, 4.0, 8.0, 16.0}) {
        const auto kernel =
            integrate_over_pixels(source_of(box_power), pixel / cells, 6, {{pixel, {1, 1, 1}}}, {});
        double error = 0, total = 0;
        for (int y = -6; y <= 6; ++y) {
            for (int x = -6; x <= 6; ++x) {
                error += std::fabs(kernel(x + 6, y + 6).x - box_integral(pixel, x, y));
                total += box_integral(pixel, x, y);
            }
        }
        EXPECT_LT(error / total, 0.6 * before);
        before = error / total;
    }
    EXPECT_LT(before, 3e-3);
}

TEST(PixelIntegrals, AddLightsAndSymmetries) {
    // A power that only its reflection through the centre leaves as it is.
    const auto skew = [](double u, double v) {
        return std::exp(-(u * u + v * v) * 300) * (1.5 + std::sin(900 * u * v + 60 * u * u));
    };
    const double pixel = 0.02, cell = 0.003;
    const PixelLight one{pixel, {1, 0, 0}}, other{1.31 * pixel, {0, 0.5, 2}};
    const auto both = integrate_over_pixels(source_of(skew), cell, 7, {one, other}, {});
    const auto first = integrate_over_pixels(source_of(skew), cell, 7, {one}, {});
    const auto second = integrate_over_pixels(source_of(skew), cell, 7, {other}, {});
    double asymmetry = 0;
    for (int y = 0; y < 15; ++y) {
        for (int x = 0; x < 15; ++x) {
            EXPECT_NEAR(both(x, y).x, first(x, y).x, 1e-15);
            EXPECT_NEAR(both(x, y).y, second(x, y).y, 1e-15);
            EXPECT_NEAR(both(x, y).z, second(x, y).z, 1e-15);
            EXPECT_NEAR(first(x, y).x, first(14 - x, 14 - y).x, 1e-15);
            asymmetry = std::max(asymmetry, std::fabs(first(x, y).x - first(14 - x, y).x));
            // Each pixel on its own, by fine quadrature.
            double sum = 0;
            for (int j = 0; j < 40; ++j) {
                for (int i = 0; i < 40; ++i)
                    sum += skew((x - 7.5 + (i + 0.5) / 40) * pixel, (y - 7.5 + (j + 0.5) / 40) * pixel);
            }
            EXPECT_NEAR(first(x, y).x, sum * pixel * pixel / 1600, 0.02 * pixel * pixel) << x << " " << y;
        }
    }
    EXPECT_GT(asymmetry, 0.1 * pixel * pixel);
}

TEST(PixelIntegrals, AiryDiscsHoldTheirEncircledEnergy) {
    // Lord Rayleigh, 1881: within radius r of the pattern of a circle of diameter D lies the share
    // 1 - J0(pi D r)^2 - J1(pi D r)^2 of all its light.
    const double area = M_PI * extent * extent / 4;
    const auto airy = [&](double u, double v) {
        const double x = M_PI * extent * std::hypot(u, v);
        const double amplitude = x == 0 ? 1 : 2 * std::cyl_bessel_j(1.0, x) / x;
        return area * area * amplitude * amplitude;
    };
    const double pixel = 0.05 / extent;
    const int radius = 104;
    const auto kernel =
        integrate_over_pixels(source_of(airy), pixel / 2, radius, {{pixel, {1 / area, 0, 0}}}, {});
    for (const double fringes : {0.7, 1.22, 2.233, 3.238, 5.0}) {
        double share = 0;
        for (int y = -radius; y <= radius; ++y) {
            for (int x = -radius; x <= radius; ++x) {
                // Pixels on the circle count by how much of them lies inside.
                int inside = 0;
                for (int k = 0; k < 100; ++k) {
                    const double dx = x - 0.45 + 0.1 * (k % 10), dy = y - 0.45 + 0.1 * (k / 10);
                    inside += std::hypot(dx, dy) * 0.05 < fringes ? 1 : 0;
                }
                share += kernel(x + radius, y + radius).x * inside / 100;
            }
        }
        const double x = M_PI * fringes;
        const double expected =
            1 - std::pow(std::cyl_bessel_j(0.0, x), 2) - std::pow(std::cyl_bessel_j(1.0, x), 2);
        EXPECT_NEAR(share, expected, 1.5e-3) << fringes;
    }
}

TEST(PixelIntegrals, ThreadsDoNotShow) {
    const std::vector<PixelLight> lights = {{0.03, {1, 0.5, 0.1}}, {0.041, {0.2, 0.5, 1}}};
    const auto once = integrate_over_pixels(source_of(box_power), 0.004, 60, lights, {best_isa(), 1});
    const auto twice = integrate_over_pixels(source_of(box_power), 0.004, 60, lights, {best_isa(), 2});
    EXPECT_TRUE(once == twice);
}

TEST(PixelIntegrals, CountsWhatItAsksFor) {
    std::int64_t asked = 0;
    const std::vector<PixelLight> lights = {{0.03, {1, 1, 1}}};
    integrate_over_pixels(
        [&](const FrequencyGrid& grid) {
            asked += std::int64_t{grid.width} * grid.height;
            return Image<float>(grid.width, grid.height);
        },
        0.002, 40, lights, {});
    EXPECT_EQ(asked, pixel_integral_work(0.002, 40, lights).frequencies);
    EXPECT_THROW(pixel_integral_work(1e-7, 40, lights), LimitError);
}

}  // namespace
}  // namespace obscura
