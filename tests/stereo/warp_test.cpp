// Warped pictures, and disparity as colour.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/color.h"
#include "stereo/disparity_colour.h"
#include "stereo/thesis/warp.h"
#include "tests/stereo/ray_scene.h"

namespace obscura {
namespace {

MiddleView flat_view(int width, int height, int margin_px, float disparity) {
    MiddleView view;
    view.picture_width = width;
    view.picture_height = height;
    view.margin_px = margin_px;
    view.disparity = Image<float>(width + 2 * margin_px, height, disparity);
    view.object = Image<std::uint32_t>(view.width(), height, 0);
    return view;
}

Image<Vec3f> columns(int width, int height) {
    Image<Vec3f> picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture(x, y) = {static_cast<float>(x), static_cast<float>(y), 1};
    return picture;
}

TEST(Warp, FlatDisparityMovesThePictureByHalf) {
    const MiddleView view = flat_view(20, 3, 4, 6);
    const Image<Vec3f> middle = columns(28, 3);
    const WarpedPicture left = warped(middle, view, view.disparity, {0.5}, Exec{});
    const WarpedPicture right = warped(middle, view, view.disparity, {-0.5}, Exec{});
    EXPECT_EQ(left.holes, 0);
    EXPECT_EQ(left.hole, Image<std::uint8_t>(20, 3, 0));
    for (int x = 0; x < 20; ++x) {
        EXPECT_EQ(left.picture(x, 2), (Vec3f{static_cast<float>(x + 4 - 3), 2, 1}));
        EXPECT_EQ(right.picture(x, 2), (Vec3f{static_cast<float>(x + 4 + 3), 2, 1}));
    }
    // Half a pixel on: linear between two.
    const DisparityMap odd(28, 3, 5.0f);
    EXPECT_EQ(warped(middle, view, odd, {0.5}, Exec{}).picture(7, 0).x, 7 + 4 - 2.5f);
}

TEST(Warp, HolesAreCountedAndTakeTheBackground) {
    // A box 8 px in front of a wall; the left eye sees it 4 px to the right.
    MiddleView view = flat_view(30, 1, 0, 0);
    for (int x = 10; x < 16; ++x)
        view.disparity(x, 0) = 8;
    const Image<Vec3f> middle = columns(30, 1);
    const WarpedPicture left = warped(middle, view, view.disparity, {0.5}, Exec{});
    EXPECT_EQ(left.holes, 4);
    for (int x = 0; x < 30; ++x) {
        EXPECT_EQ(left.hole(x, 0), x >= 10 && x < 14 ? 255 : 0) << x;
        const int from = x >= 14 && x < 20 ? x - 4 : x < 14 ? std::min(x, 9) : x;
        EXPECT_EQ(left.picture(x, 0).x, static_cast<float>(from)) << x;
    }
    const WarpedPicture right = warped(middle, view, view.disparity, {-0.5}, Exec{});
    EXPECT_EQ(right.holes, 4);
    for (int x = 12; x < 16; ++x)
        EXPECT_EQ(right.picture(x, 0).x, 16.0f) << x;

    // Beyond the map's side there is no background: the nearest that there is.
    const DisparityMap all(30, 1, 10.0f);
    const WarpedPicture aside = warped(middle, view, all, {0.5}, Exec{});
    EXPECT_EQ(aside.holes, 5);
    EXPECT_EQ(aside.picture(0, 0).x, 0.0f);

    // Nothing known at all.
    const DisparityMap none(30, 1, std::numeric_limits<float>::quiet_NaN());
    const WarpedPicture dark = warped(middle, view, none, {0.5}, Exec{});
    EXPECT_EQ(dark.holes, 30);
    EXPECT_EQ(dark.picture(3, 0), Vec3f{});
}

TEST(Warp, ShowsWhatRaysSeeExceptInHoles) {
    RayScene scene;
    scene.margin_px = 12;
    const MiddleView view = scene.view();
    // A colour that belongs to the place in the world.
    const auto colour = [](const RayScene::Hit& hit) {
        return Vec3f{static_cast<float>(hit.point.x), static_cast<float>(hit.point.y),
                     static_cast<float>(hit.object)};
    };
    Image<Vec3f> middle(view.width(), view.height());
    for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x)
            middle(x, y) = colour(scene.seen(0, x - scene.margin_px, y));
    const WarpedPicture left = warped(middle, view, view.disparity, {0.5}, Exec{});
    int wrong = 0, wrong_holes = 0;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            const Vec3f difference = left.picture(x, y) - colour(scene.seen(-1, x, y));
            if (length(difference) < 0.02f) continue;
            (left.hole(x, y) != 0 ? wrong_holes : wrong) += 1;
        }
    }
    fmt::print("{} holes, {} of them wrong; {} others wrong\n", left.holes, wrong_holes, wrong);
    EXPECT_GT(left.holes, 300);
    EXPECT_GT(wrong_holes, 200);     // invented is invented: a wall's colour is not what lies behind
    EXPECT_LT(wrong, scene.height);  // outlines between pixel centres
    const WarpedPicture one = warped(middle, view, view.disparity, {0.5}, Exec{best_isa(), 1});
    const WarpedPicture three = warped(middle, view, view.disparity, {0.5}, Exec{best_isa(), 3});
    EXPECT_EQ(one.picture, three.picture);
}

Vec3d lab(Rgb8 code) {
    const Vec3f c = srgb8_to_linear(code);
    const double r = static_cast<double>(c.x), g = static_cast<double>(c.y), b = static_cast<double>(c.z);
    const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
    const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
    const double y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
    const double z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(DisparityColour, TheScreenIsNeutralFrontWarmBackCool) {
    const DisparityColours colours{.far_px = -20, .near_px = 20};
    const Rgb8 screen = disparity_colour(0, colours);
    EXPECT_EQ(screen.r, screen.g);
    EXPECT_EQ(screen.g, screen.b);
    const Rgb8 near = disparity_colour(20, colours), far = disparity_colour(-20, colours);
    // Moreland's ends, as published: (180, 4, 38) and (59, 76, 192).
    EXPECT_NEAR(near.r, 180, 2);
    EXPECT_NEAR(near.g, 4, 5);
    EXPECT_NEAR(near.b, 38, 2);
    EXPECT_NEAR(far.r, 59, 2);
    EXPECT_NEAR(far.g, 76, 2);
    EXPECT_NEAR(far.b, 192, 2);
    EXPECT_EQ(disparity_colour(99, colours), near);
    EXPECT_EQ(disparity_colour(-99, colours), far);
    const Rgb8 nothing = disparity_colour(std::nan(""), colours);
    EXPECT_LT(nothing.r + nothing.g + nothing.b, 100);

    // The wider side sets the scale of both.
    EXPECT_EQ(disparity_colour(5, {.far_px = -20, .near_px = 5}), disparity_colour(5, colours));
}

TEST(DisparityColour, EqualStepsLookEqual) {
    const DisparityColours colours{.far_px = -16, .near_px = 16};
    double least = 1e9, most = 0, left = 0, right = 0;
    for (int d = -16; d < 16; ++d) {
        const double step = length(lab(disparity_colour(d + 1, colours)) - lab(disparity_colour(d, colours)));
        least = std::min(least, step);
        most = std::max(most, step);
        (d < 0 ? left : right) += step;
    }
    fmt::print("steps {:.2f} to {:.2f}, sides {:.1f} and {:.1f}\n", least, most, left, right);
    EXPECT_LT(most / least, 1.2);
    EXPECT_NEAR(left / right, 1, 0.1);
}

TEST(DisparityColour, StripesMarkWhatIsUncomfortable) {
    DisparityMap map(32, 32, 0.0f);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 10; ++x)
            map(x, y) = -9;
        for (int x = 22; x < 32; ++x)
            map(x, y) = 9;
    }
    const DisparityColours colours{.far_px = -10, .near_px = 10, .comfort_far_px = -5, .comfort_near_px = 5};
    const Image<Rgb8> picture = disparity_picture(map, colours, Exec{});
    int striped[3] = {};
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            if (picture(x, y) == disparity_colour(static_cast<double>(map(x, y)), colours)) continue;
            ++striped[x < 10 ? 0 : x < 22 ? 1 : 2];
            // Too near rises to the right, too far falls.
            const int up = map(x, y) > 0 ? 1 : -1;
            if (x + 1 < 32 && map(x + 1, y) == map(x, y) && y - up >= 0 && y - up < 32) {
                EXPECT_EQ(picture(x + 1, y - up), picture(x, y));
            }
        }
    }
    EXPECT_NEAR(striped[0], 320 * 3 / 8, 10);
    EXPECT_EQ(striped[1], 0);
    EXPECT_NEAR(striped[2], 320 * 3 / 8, 10);
}

TEST(DisparityColour, TheScaleTellsWhereNumbersBelong) {
    DisparityMap map(3, 1);
    map.pixels = {-24.2f, 7.9f, std::numeric_limits<float>::quiet_NaN()};
    const DisparityColours colours = colours_for(map);
    EXPECT_EQ(colours.far_px, -25);
    EXPECT_EQ(colours.near_px, 8);
    const DisparityScale scale = disparity_scale(330, 24, colours);
    ASSERT_FALSE(scale.ticks.empty());
    const double expected[] = {-20, -10, 0};
    ASSERT_EQ(scale.ticks.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scale.ticks[i].disparity_px, expected[i]);
        EXPECT_NEAR(scale.ticks[i].x, (expected[i] + 25) * 10, 1e-9);
    }
    EXPECT_EQ(scale.strip(0, 0), disparity_colour(-24.95, colours));
    EXPECT_EQ(scale.strip(329, 0), disparity_colour(7.95, colours));
    EXPECT_NE(scale.strip(250, 0), disparity_colour(0.05, colours));  // the screen's tick
    EXPECT_EQ(scale.strip(150, 0), disparity_colour(-9.95, colours));
    EXPECT_NE(scale.strip(150, 23), disparity_colour(-9.95, colours));
}

}  // namespace
}  // namespace obscura
