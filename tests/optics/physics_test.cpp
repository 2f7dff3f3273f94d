// Far fields that are known in closed form or from optics, and the pupils of real telescopes.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/image_io.h"
#include "optics/far_field.h"
#include "tests/core/shared_folder.h"
#include "tests/optics/far_field_oracle.h"

namespace obscura {
namespace {

using namespace far_field_oracle;

Aperture shape(ApertureKind kind, int size, double diameter) {
    ApertureShape s;
    s.kind = kind;
    s.diameter = diameter;
    return make_aperture(s, size, 1.0);
}

double sinc(double x) {
    return x == 0 ? 1 : std::sin(M_PI * x) / (M_PI * x);
}

TEST(Physics, ABoxIsTheProductOfTwoSincs) {
    Aperture box;
    box.pitch_m = 1;
    box.mask = Image<float>(64, 64);
    for (int y = 20; y < 44; ++y) {
        for (int x = 12; x < 52; ++x)
            box.mask(x, y) = 1;
    }
    const FrequencyGrid grid = centred_grid(101, 101, 0.0037);
    const Field field = far_field(box, grid, {}, {});
    double worst = 0;
    for (int y = 0; y < 101; ++y) {
        for (int x = 0; x < 101; ++x) {
            const double truth = 960 * sinc(40 * (x - 50) * 0.0037) * sinc(24 * (y - 50) * 0.0037);
            worst = std::max(worst, std::abs(std::complex<double>(static_cast<double>(field.re(x, y)) - truth,
                                                                  static_cast<double>(field.im(x, y)))));
        }
    }
    EXPECT_LE(worst, 1e-6 * 960);
}

/// Airy's pattern of a circle of diameter d: F = area 2 J1(x) / x, x = pi d q. G. B. Airy, 1835.
TEST(Physics, ACircleIsAirysPattern) {
    constexpr int size = 512;
    constexpr double d = 0.9 * size, area = M_PI * d * d / 4;
    const Aperture circle = shape(ApertureKind::circle, size, 0.9);
    const double step = 0.02 / d;
    const FrequencyGrid line{400, 1, 0, 0, step, step};
    FarFieldParams exact_shape;
    exact_shape.method = FarFieldMethod::polygon;
    const Image<float> mask_power = far_field_power(circle, line, {}, {});
    const Image<float> power = far_field_power(circle, line, exact_shape, {});
    double worst = 0, worst_mask = 0;
    std::vector<double> zeros;
    for (int k = 0; k < line.width; ++k) {
        const double x = M_PI * d * k * step;
        const double truth = std::fabs(k == 0 ? area : area * 2 * std::cyl_bessel_j(1.0, x) / x);
        worst = std::max(worst, std::fabs(std::sqrt(static_cast<double>(power(k, 0))) - truth));
        worst_mask =
            std::max(worst_mask, std::fabs(std::sqrt(static_cast<double>(mask_power(k, 0))) - truth));
        const bool valley =
            k > 1 && k + 1 < line.width && power(k, 0) < power(k - 1, 0) && power(k, 0) <= power(k + 1, 0);
        if (valley) zeros.push_back(k * step * d);
    }
    EXPECT_LE(worst, 1e-6 * area);
    EXPECT_LE(worst_mask, 2e-5 * area) << "the mask: its border is smeared over texels";
    // The dark rings, in units of lambda / d.
    ASSERT_GE(zeros.size(), 6u);
    const double known[6] = {1.2197, 2.2331, 3.2383, 4.2411, 5.2428, 6.2439};
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(zeros[i], known[i], 0.011);
}

TEST(Physics, EnergyWithinTheDarkRingsOfACircle) {
    constexpr int size = 256;
    constexpr double d = 0.9 * size;
    const Aperture circle = shape(ApertureKind::circle, size, 0.9);
    constexpr int side = 801;
    const double step = 8 / (d * (side - 1));  // to 4 lambda / d
    const Image<float> power = far_field_power(circle, centred_grid(side, side, step), {}, {});
    const double rings[3] = {1.2197, 2.2331, 3.2383}, share[3] = {0.83785, 0.90991, 0.93776};
    for (int i = 0; i < 3; ++i) {
        double sum = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                if (std::hypot(x - side / 2, y - side / 2) * step * d <= rings[i])
                    sum += static_cast<double>(power(x, y));
            }
        }
        // Parseval: all of the energy is the sum of the mask's squares.
        EXPECT_NEAR(sum * step * step / (M_PI * d * d / 4), share[i], 2e-4) << i;
    }
}

TEST(Physics, TwoSlitsFringeAndGratingsHaveOrders) {
    Aperture slits;
    slits.pitch_m = 1;
    slits.mask = Image<float>(128, 64);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 8; ++x)
            slits.mask(36 + x, y) = slits.mask(84 + x, y) = 1;
    }
    const FrequencyGrid line{2000, 1, 0, 0, 5e-5, 1e-4};
    const Image<float> power = far_field_power(slits, line, {}, {});
    double worst = 0;
    for (int k = 0; k < line.width; ++k) {
        const double u = k * line.step_u;
        const double truth = std::fabs(2 * 8 * 64 * sinc(8 * u) * std::cos(M_PI * 48 * u));
        worst = std::max(worst, std::fabs(std::sqrt(static_cast<double>(power(k, 0))) - truth));
    }
    EXPECT_LE(worst, 1e-6 * 1024);

    // Sixteen lines of two texels, eight apart: orders at multiples of 1/8, as high as the single line's
    // transform lets them, and 14 side maxima between them.
    Aperture grating;
    grating.pitch_m = 1;
    grating.mask = Image<float>(128, 16);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 128; ++x)
            grating.mask(x, y) = x % 8 < 2 ? 1.0f : 0.0f;
    }
    const FrequencyGrid orders{1281, 1, 0, 0, 1.0 / 3200, 1};
    const Image<float> spectrum = far_field_power(grating, orders, {}, {});
    const double area = open_area(grating.mask.view());
    for (int order = 0; order <= 3; ++order) {
        const double amplitude = std::sqrt(static_cast<double>(spectrum(400 * order, 0)));
        EXPECT_NEAR(amplitude / area, std::fabs(sinc(2.0 * order / 8)), 1e-6) << order;
    }
    int maxima = 0;
    for (int k = 1; k < 400; ++k)
        maxima += spectrum(k, 0) > spectrum(k - 1, 0) && spectrum(k, 0) >= spectrum(k + 1, 0) ? 1 : 0;
    EXPECT_EQ(maxima, 14);
}

/// Streaks are as many as the directions of the edges, twice: both ways.
TEST(Physics, EvenIrisesHaveAsManyStreaksAsBladesOddOnesTwiceAsMany) {
    for (const int blades : {5, 6, 7, 8, 9}) {
        ApertureShape s;
        s.blades = blades;
        const Aperture iris = make_aperture(s, 256, 1.0);
        const Image<float> power = far_field_power(iris, centred_grid(512, 512, 1.0 / 512), {}, {});
        // Energy by direction in a ring, a bin per half degree.
        std::vector<double> ring(720);
        for (int y = 0; y < 512; ++y) {
            for (int x = 0; x < 512; ++x) {
                const double radius = std::hypot(x - 256, y - 256);
                if (radius < 60 || radius > 120) continue;
                const double degrees = std::atan2(y - 256, x - 256) * 180 / M_PI + 360;
                ring[static_cast<std::size_t>(degrees * 2) % 720] +=
                    static_cast<double>(power(x, y)) * radius * radius;
            }
        }
        // Means over five degrees; a streak is a maximum within twelve that is not faint.
        const auto smooth = [&](int at) {
            double sum = 0;
            for (int i = -5; i <= 5; ++i)
                sum += ring[static_cast<std::size_t>((at + i + 720) % 720)];
            return sum;
        };
        double brightest = 0;
        for (int i = 0; i < 720; ++i)
            brightest = std::max(brightest, smooth(i));
        int streaks = 0;
        for (int i = 0; i < 720; ++i) {
            bool highest = smooth(i) > 0.3 * brightest;
            for (int j = -12; j <= 12; ++j)
                highest = highest && (j < 0 ? smooth(i) > smooth(i + j) : smooth(i) >= smooth(i + j));
            streaks += highest ? 1 : 0;
        }
        EXPECT_EQ(streaks, blades % 2 == 0 ? blades : 2 * blades) << blades;
    }
}

Aperture pupil(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const Image<Rgba8> image = decode_png(bytes, path);
    Aperture a;
    a.pitch_m = 1;
    a.mask = Image<float>(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        a.mask.pixels[i] = static_cast<float>(image.pixels[i].r) / 255.0f;
    return a;
}

/// Every pupil at its full 1024 texels on a grid twice as large; rows are sampled, since the definition costs
/// a thousand times more.
TEST(Physics, RealPupilsAgreeWithTheDefinition) {
    const std::filesystem::path folder = shared_folder("data/apertures");
    SKIP_WITHOUT(folder);
    for (const char* name : {"gmt", "hst", "jwst", "keck", "subaru", "vlt_ut1"}) {
        const Aperture a = pupil((folder / (std::string(name) + "_1024.png")).string());
        const double area = open_area(a.mask.view());
        ASSERT_GT(area, 1e5) << name;
        const FrequencyGrid grid = centred_grid(2048, 2048, 1.0 / 1024);
        FarFieldReport report;
        const Field field = far_field(a, grid, {}, {}, &report);
        double worst = 0, squares = 0;
        int count = 0;
        constexpr int every = 29;  // columns
        for (const int y : {0, 511, 900, 1017, 1024, 1025, 1100}) {
            const FrequencyGrid row{grid.width / every,  1,
                                    grid.first_u,        grid.first_v + y * grid.step_v,
                                    every * grid.step_u, grid.step_v};
            const auto truth = exact(a.mask.view(), row);
            for (int i = 0; i < row.width; ++i, ++count) {
                const int x = every * i;
                const std::complex<double> value(static_cast<double>(field.re(x, y)),
                                                 static_cast<double>(field.im(x, y)));
                const auto expected = truth[static_cast<std::size_t>(i)];
                worst = std::max(worst, std::abs(value - expected) / area);
                const auto decades = [&](std::complex<double> f) {
                    return std::log10(std::max(std::norm(f / area), 1e-10));
                };
                squares += std::pow((decades(value) - decades(expected)) / 10, 2);
            }
        }
        const double psnr = -10 * std::log10(std::max(squares / count, 1e-30));
        std::printf("%s: %s; amplitude error %.1e, log-power PSNR %.0f dB\n", name,
                    far_field_method_name(report.method), worst, psnr);
        EXPECT_LE(worst, 1e-6) << name;
        EXPECT_GE(psnr, 125) << name;
    }
}

}  // namespace
}  // namespace obscura
