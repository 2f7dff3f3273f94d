// Patterns as pictures: what shade stands for what power.

#include "optics/pattern_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/color.h"
#include "optics/spectrum.h"

namespace obscura {
namespace {

TEST(View, LogarithmicGreysStepEvenlyPerDecade) {
    Image<float> power(9, 1);
    for (int x = 0; x < 9; ++x)
        power(x, 0) = static_cast<float>(4 * std::pow(10.0, -x));
    PatternView view{true, 0, 5};
    const Image<Rgb8> shown = view_power(power.view(), view, {});
    for (int x = 0; x < 9; ++x) {
        const int expected = static_cast<int>(std::lround(std::max(0.0, 255 * (1 - x / 5.0))));
        EXPECT_NEAR(shown(x, 0).r, expected, 1) << x;
        EXPECT_EQ(shown(x, 0).r, shown(x, 0).g);
        EXPECT_EQ(shown(x, 0).r, shown(x, 0).b);
    }
    EXPECT_EQ(shown(0, 0).r, 255);
    EXPECT_EQ(shown(5, 0).r, 0);
    // White lower: what is brighter clips.
    view.white = 0.04;
    EXPECT_EQ(view_power(power.view(), view, {})(0, 0).r, 255);
    EXPECT_EQ(view_power(power.view(), view, {})(2, 0).r, 255);
    EXPECT_NEAR(view_power(power.view(), view, {})(3, 0).r, 204, 1);
}

TEST(View, LinearGreysAreSrgb) {
    Image<float> power(4, 1);
    power(0, 0) = 2;
    power(1, 0) = 1;
    power(2, 0) = 0.1f;
    power(3, 0) = 0;
    const Image<Rgb8> shown = view_power(power.view(), {}, {});
    EXPECT_EQ(shown(0, 0).r, 255);
    EXPECT_EQ(shown(1, 0).r, std::lround(255 * srgb_encode(0.5)));
    EXPECT_EQ(shown(2, 0).r, std::lround(255 * srgb_encode(0.05)));
    EXPECT_EQ(shown(3, 0).r, 0);
}

TEST(View, NothingIsBlack) {
    const Image<float> power(3, 2);
    for (const bool logarithmic : {false, true}) {
        for (const Rgb8 pixel : view_power(power.view(), {logarithmic}, {}).pixels)
            EXPECT_EQ(pixel, Rgb8{});
        for (const Rgb8 pixel : view_colour(Image<Vec3f>(3, 2).view(), {logarithmic}, {}).pixels)
            EXPECT_EQ(pixel, Rgb8{});
    }
}

TEST(View, ColoursShowTheirLuminance) {
    // Greys are as view_power() shows them, in both views.
    Image<float> power(7, 1);
    Image<Vec3f> grey(7, 1), tinted(7, 1);
    for (int x = 0; x < 7; ++x) {
        const float p = static_cast<float>(std::pow(10.0, -x));
        power(x, 0) = p;
        grey(x, 0) = {p, p, p};
        tinted(x, 0) =
            to_float(Vec3d{1.4, 0.9, -0.1} * (static_cast<double>(p) / srgb_luminance({1.4, 0.9, -0.1})));
    }
    for (const bool logarithmic : {false, true}) {
        const PatternView view{logarithmic, 0, 6};
        const auto expected = view_power(power.view(), view, {}), shown = view_colour(grey.view(), view, {});
        const auto colours = view_colour(tinted.view(), view, {});
        for (int x = 0; x < 7; ++x) {
            EXPECT_NEAR(shown(x, 0).g, expected(x, 0).g, 1) << x;
            const Rgb8 c = colours(x, 0);
            EXPECT_NEAR(srgb_luminance(to_double(srgb8_to_linear(c))), srgb_decode(expected(x, 0).g / 255.0),
                        0.01)
                << x;
            if (x > 0 && expected(x, 0).g > 40) {
                EXPECT_GT(c.r, c.g);
                EXPECT_GT(c.g, c.b);
            }
        }
    }
}

TEST(View, BrightColoursKeepTheirShade) {
    // Pure blue has luminance 0.0722: shown at luminance 0.5, no screen can, and it pales instead of
    // clipping.
    Image<Vec3f> blue(1, 1, {0, 0, 1});
    const Image<Rgb8> shown = view_colour(blue.view(), {false, 2 * 0.0722}, {});
    EXPECT_EQ(shown(0, 0).b, 255);
    EXPECT_EQ(shown(0, 0).r, shown(0, 0).g);
    EXPECT_GT(shown(0, 0).r, 100);
    EXPECT_NEAR(srgb_luminance(to_double(srgb8_to_linear(shown(0, 0)))), 0.5, 0.01);
}

}  // namespace
}  // namespace obscura
