// One curve for the whole range: ends, monotony, and what each operator is for.
#include "stereo/thesis/range_remap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereo/conflict.h"
#include "tests/stereo/ray_scene.h"

namespace obscura {
namespace {

RangeRemap to_range(RemapKind kind) {
    RangeRemap remap;
    remap.kind = kind;
    remap.nearest_px = 6;
    remap.farthest_px = -2;
    return remap;
}

struct Scene {
    MiddleView view;
    Image<std::uint8_t> valid;
};

/// With a strip of nothing at the top, whose disparity lies beyond all others.
Scene scene() {
    Scene s{RayScene{}.view(), {}};
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < s.view.width(); ++x) {
            s.view.object(x, y) = nothing_seen;
            s.view.disparity(x, y) = -400;
        }
    }
    s.valid = valid_pixels(s.view);
    return s;
}

TEST(StereoRemap, CurvesMeetTheWantedRangeAndAreMonotone) {
    const Scene s = scene();
    for (const RemapKind kind : {RemapKind::linear, RemapKind::logarithmic, RemapKind::histogram}) {
        for (const double bend : {-9.0, 0.5, 40.0}) {
            RangeRemap remap = to_range(kind);
            remap.curvature = bend;
            remap.strength = bend < 0 ? 1 : bend > 1 ? 0.7 : 0.2;
            const RemapCurve curve = remap_curve(s.view.disparity, s.valid, remap);
            const DisparityMap map = remapped(s.view.disparity, s.valid, curve);
            float low = 1e9f, high = -1e9f;
            for (std::size_t i = 0; i < map.pixels.size(); ++i) {
                if (s.valid.pixels[i] == 0) {
                    EXPECT_EQ(map.pixels[i], -400);
                    continue;
                }
                low = std::min(low, map.pixels[i]);
                high = std::max(high, map.pixels[i]);
            }
            EXPECT_FLOAT_EQ(low, -2);
            EXPECT_FLOAT_EQ(high, 6);
            double before = curve.at(-500);
            for (double d = -500; d < 100; d += 0.0371) {
                const double now = curve.at(d);
                ASSERT_GE(now, before) << d;
                before = now;
            }
        }
    }
}

TEST(StereoRemap, LinearKeepsProportions) {
    const Scene s = scene();
    const RemapCurve curve = remap_curve(s.view.disparity, s.valid, to_range(RemapKind::linear));
    ASSERT_EQ(curve.from.size(), 2u);
    const double a = curve.from[0], b = curve.from[1];
    EXPECT_NEAR(curve.at(a + 0.25 * (b - a)), 0, 1e-9);
    EXPECT_NEAR(curve.at(b + 3), 9, 1e-9);  // a shift beyond the range
}

TEST(StereoRemap, LogarithmicCompressesOneEnd) {
    const Scene s = scene();
    RangeRemap remap = to_range(RemapKind::logarithmic);
    for (const double bend : {4.0, -4.0}) {
        remap.curvature = bend;
        const RemapCurve curve = remap_curve(s.view.disparity, s.valid, remap);
        const double a = curve.from.front(), b = curve.from.back(), step = (b - a) / 1024;
        const double far = curve.at(a + step) - curve.at(a), near = curve.at(b) - curve.at(b - step);
        EXPECT_NEAR(bend > 0 ? near / far : far / near, 0.2, 0.002);
        // log(1 + c u) / log(1 + c) at every u, knots or not.
        for (double u = 0.0003; u < 1; u += 0.0137) {
            const double v = bend > 0 ? std::log(1 + 4 * u) / std::log(5.0)
                                      : 1 - std::log(1 + 4 * (1 - u)) / std::log(5.0);
            EXPECT_NEAR(curve.at(a + u * (b - a)), -2 + 8 * v, 1e-4);
        }
    }
}

TEST(StereoRemap, LogarithmicIsLinearInTheLimit) {
    const Scene s = scene();
    for (const double bend : {1e-300, -1e-18, 1e-14, -1e-10, 1e-8}) {
        RangeRemap remap = to_range(RemapKind::logarithmic);
        remap.curvature = bend;
        const RemapCurve curve = remap_curve(s.view.disparity, s.valid, remap),
                         line = remap_curve(s.view.disparity, s.valid, to_range(RemapKind::linear));
        for (const double d : {-4.0, -1.0, 0.5, 3.0})
            EXPECT_NEAR(curve.at(d), line.at(d), 1e-5) << bend;
    }
}

TEST(StereoRemap, HistogramSpendsTheRangeOnWhatIsSeen) {
    // Nine tenths of the pixels fill a tenth of the range.
    DisparityMap map(1000, 1);
    for (int x = 0; x < 1000; ++x)
        map(x, 0) = x < 900 ? static_cast<float>(x) / 900 : 1 + 9 * static_cast<float>(x - 900) / 99;
    const Image<std::uint8_t> valid(1000, 1, 1);
    RangeRemap remap = to_range(RemapKind::histogram);
    remap.nearest_px = 10;
    remap.farthest_px = 0;
    remap.strength = 1;
    EXPECT_NEAR(remap_curve(map, valid, remap).at(1), 9, 0.1);
    remap.strength = 0.5;
    EXPECT_NEAR(remap_curve(map, valid, remap).at(1), 5, 0.1);
    remap.strength = 0;
    EXPECT_NEAR(remap_curve(map, valid, remap).at(1), 1, 1e-6);
}

TEST(StereoRemap, MatchingBringsTwoDisparitiesTogetherAndFlattensBetween) {
    RangeRemap remap;
    remap.kind = RemapKind::match;
    remap.first_px = 7;
    remap.second_px = -3;
    remap.matched_px = 1;
    const RemapCurve curve = remap_curve(DisparityMap(2, 2), Image<std::uint8_t>(2, 2, 1), remap);
    for (const double d : {-3.0, 0.0, 2.5, 7.0})
        EXPECT_EQ(curve.at(d), 1);  // the loss of contrast that figure 4.4 shows
    EXPECT_NEAR(curve.at(9), 3, 1e-12);
    EXPECT_NEAR(curve.at(-5), -1, 1e-12);
    remap.second_px = 7;
    EXPECT_EQ(remap_curve(DisparityMap(2, 2), Image<std::uint8_t>(2, 2, 1), remap).at(8), 2);
}

TEST(StereoRemap, NothingToMapIsTheIdentity) {
    const Image<std::uint8_t> none(2, 2, 0), all(2, 2, 1);
    const DisparityMap flat(2, 2, 9);
    EXPECT_EQ(remap_curve(flat, all, {}).at(3.25), 3.25);
    EXPECT_EQ(remap_curve(flat, none, to_range(RemapKind::linear)).at(3.25), 3.25);
    EXPECT_EQ(remapped(flat, all, remap_curve(flat, all, to_range(RemapKind::histogram)))(0, 0), 6);
    EXPECT_EQ(parse_remap("log"), RemapKind::logarithmic);
    EXPECT_EQ(parse_remap("none"), RemapKind::none);
    EXPECT_FALSE(parse_remap("lang").has_value());
}

}  // namespace
}  // namespace obscura
