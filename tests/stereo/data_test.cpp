// Measured disparity of real scenes: Middlebury's cones (2003) and aloe (2006), in the left view.
//
// Scharstein and Szeliski, "High-accuracy stereo depth maps using structured light", CVPR 2003: cones_disp2
// is of the left picture, cones_disp6 of the right one, codes are quarter pixels, 0 is unknown. Aloe's codes
// are pixels.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/image_io.h"
#include "core/pnm.h"
#include "stereo/disparity.h"
#include "stereo/thesis/warp.h"
#include "stereo/upsample.h"
#include "tests/core/shared_folder.h"

namespace obscura {
namespace {

const std::filesystem::path folder = shared_folder("data/stereo");

std::string bytes_of(const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// NaN where unknown.
DisparityMap cones(const char* name) {
    const GreyCodes grey = decode_pnm(bytes_of(name), name);
    DisparityMap map(grey.codes.width, grey.codes.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const std::uint16_t code = grey.codes.pixels[i];
        map.pixels[i] = code == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(code) / 4;
    }
    return map;
}

DisparityMap aloe() {
    const Image<Rgba8> grey = decode_png(bytes_of("aloeGT.png"), "aloeGT.png");
    DisparityMap map(grey.width, grey.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const std::uint8_t code = grey.pixels[i].r;
        map.pixels[i] = code == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(code);
    }
    return map;
}

/// A photograph's view: no depth, no normals, one object where anything is known.
MiddleView photograph(const DisparityMap& map) {
    MiddleView view;
    view.picture_width = map.width;
    view.picture_height = map.height;
    view.disparity = map;
    view.object = Image<std::uint32_t>(map.width, map.height, nothing_seen);
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        if (std::isfinite(map.pixels[i])) view.object.pixels[i] = 0;
    return view;
}

class StereoData : public testing::Test {
  protected:
    void SetUp() override { SKIP_WITHOUT(folder / "cones_disp2.pgm"); }
};

TEST_F(StereoData, LeftMapDrawnForTheRightEyeIsItsTruth) {
    const MiddleView view = photograph(cones("cones_disp2.pgm"));
    const DisparityMap truth = cones("cones_disp6.pgm");
    TwoWayParams params;
    params.shift = {0, -1};
    params.join_px = 1;
    const TwoWayDisparity two = two_way_disparity(view, view.disparity, params, Exec{});
    std::int64_t both = 0, near = 0, nearer = 0, farther = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const float d = two.right.disparity.pixels[i], t = truth.pixels[i];
        if (!std::isfinite(d) || !std::isfinite(t)) continue;
        ++both;
        if (std::abs(d - t) <= 1) {
            ++near;
        } else {
            ++(d > t ? nearer : farther);
        }
    }
    fmt::print("{} pixels known to both, {:.2f} % within 1 px; {} nearer, {} farther than truth\n", both,
               100.0 * static_cast<double>(near) / static_cast<double>(both), nearer, farther);
    EXPECT_GT(both, 130000);
    EXPECT_GT(near * 1000, both * 985);
    // The left eye's own map is the data.
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const float d = two.left.disparity.pixels[i], t = view.disparity.pixels[i];
        ASSERT_TRUE(d == t || (std::isnan(d) && std::isnan(t)));
    }
}

TEST_F(StereoData, OcclusionsFromOneMapAreThoseOfBoth) {
    const MiddleView view = photograph(cones("cones_disp2.pgm"));
    const DisparityMap right = cones("cones_disp6.pgm");
    TwoWayParams params;
    params.shift = {0, -1};
    params.join_px = 1;
    params.hidden_px = 1;
    const TwoWayDisparity one = two_way_disparity(view, view.disparity, params, Exec{});
    const TwoWayDisparity truth =
        cross_checked({view.disparity, view.disparity, {}}, {right, right, {}}, params, Exec{});
    std::int64_t known = 0, agree = 0, hidden = 0, found = 0;
    for (std::size_t i = 0; i < right.pixels.size(); ++i) {
        const Sight s = truth.left.sight.pixels[i], o = one.left.sight.pixels[i];
        if (s == Sight::unknown) {
            EXPECT_EQ(o, Sight::unknown);
            continue;
        }
        ++known;
        if (s == o) ++agree;
        if (s == Sight::hidden) {
            ++hidden;
            if (o == Sight::hidden) ++found;
        }
    }
    fmt::print("{} pixels known, {:.2f} % agree; {} hidden, {:.1f} % of them found\n", known,
               100.0 * static_cast<double>(agree) / static_cast<double>(known), hidden,
               100.0 * static_cast<double>(found) / static_cast<double>(hidden));
    EXPECT_GT(hidden, 7000);
    EXPECT_GT(agree * 100, known * 97);
    EXPECT_GT(found * 100, hidden * 90);
}

class StereoDataSets : public StereoData, public testing::WithParamInterface<const char*> {};

// A rounder, tilted scene at 1:4 and back, around thousands of unknown pixels and unmarked outlines.
TEST_P(StereoDataSets, ChangesComeBackFromAQuarter) {
    const bool is_aloe = GetParam() == std::string("aloe");
    const MiddleView view = photograph(is_aloe ? aloe() : cones("cones_disp2.pgm"));
    const MiddleView low = reduced(view, 4);
    const auto edit = [&](int x, int y) {
        const double d = static_cast<double>(view.disparity(x, y));
        return static_cast<float>(0.4 * (d - 30) + 0.004 * d * d +
                                  6 * std::sin(x / 90.0) * std::cos(y / 70.0));
    };
    Image<float> change(low.width(), low.height());
    for (int y = 0; y < low.height(); ++y)
        for (int x = 0; x < low.width(); ++x)
            change(x, y) = edit(sampled_pixel(x, 4, view.width()), sampled_pixel(y, 4, view.height()));
    const Image<float> up = upsampled_change(view, low, change, UpsampleParams{}, Exec{});
    double squares = 0, worst = 0;
    std::int64_t known = 0, far = 0;
    for (int y = 0; y < view.height(); ++y) {
        for (int x = 0; x < view.width(); ++x) {
            if (view.object(x, y) == nothing_seen) {
                ASSERT_EQ(up(x, y), 0.0f);
                continue;
            }
            ASSERT_TRUE(std::isfinite(up(x, y)));
            const auto miss = static_cast<double>(up(x, y) - edit(x, y));
            squares += miss * miss;
            worst = std::max(worst, std::abs(miss));
            ++known;
            if (std::abs(miss) > 0.25) ++far;
        }
    }
    const double rms = std::sqrt(squares / static_cast<double>(known));
    fmt::print("{}: {} pixels known of {}, max {:.3f} rms {:.4f} px, {} beyond 0.25 px\n", GetParam(), known,
               view.disparity.pixels.size(), worst, rms, far);
    EXPECT_LT(static_cast<std::size_t>(known), view.disparity.pixels.size());
    // Without objects, a surface between the samples borrows the models of others, up to 100 px away in aloe.
    EXPECT_LT(rms, 0.15);
    EXPECT_LT(far * 200, known);
}

INSTANTIATE_TEST_SUITE_P(Maps, StereoDataSets, testing::Values("cones", "aloe"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace
}  // namespace obscura
