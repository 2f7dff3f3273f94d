// The middle view: the frame's own channels, wider, as disparity.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/pair/middle.h"
#include "core/error.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

MiddleView view_of(const Scene& scene, int margin, const Exec& exec = {}) {
    FrameCache cache;
    return middle_view(scene, {0.065, 5, 0.6, 0.7, 0.063}, margin, exec, cache);
}

TEST(MiddleView, IsWhatTheFrameShowsOfPixelCentres) {
    const Scene scene = everything(1);
    const Frame frame = render_frame(scene, all_channels());
    const MiddleView view = view_of(scene, 0);
    EXPECT_EQ(view.depth_m, frame.depth_m);
    EXPECT_EQ(view.object, frame.object);
    ASSERT_EQ(view.normal.pixels.size(), frame.normal.pixels.size());
    int seen = 0;
    for (std::size_t i = 0; i < view.normal.pixels.size(); ++i) {
        ASSERT_EQ(view.normal.pixels[i], frame.normal.pixels[i]);
        const std::uint32_t t = view.triangle.pixels[i];
        ASSERT_EQ(t == nothing_seen, std::isinf(view.depth_m.pixels[i]));
        ASSERT_EQ(view.material.pixels[i] == nothing_seen, t == nothing_seen);
        if (t == nothing_seen) continue;
        ASSERT_EQ(view.material.pixels[i], scene.mesh.material[t]);
        ++seen;
    }
    EXPECT_GT(seen, 10000);
    // However many samples the picture takes.
    EXPECT_EQ(view_of(everything(16), 0).triangle, view.triangle);
}

TEST(MiddleView, DisparityFollowsFromDistance) {
    // A wall 4 m away seen head on: one disparity; nothing beside it.
    Scene scene = empty_scene(120, 80);
    add(scene, box({1, 1, 1}), 0, {0, 0, -4.5f});
    scene.camera.eye = {0, 0, 0};
    scene.camera.look_at = {0, 0, -1};
    scene.camera.vfov_deg = 40;
    const StereoRig rig{0.1, 8, 0.6, 0.7, 0.063};
    FrameCache cache;
    const MiddleView view = middle_view(scene, rig, 10, {}, cache);
    const double focal = 40 / std::tan(20 * num::pi / 180);
    const double near = focal * 0.1 * (1 / 4.0 - 1 / 8.0), far = -focal * 0.1 / 8;
    ASSERT_EQ(view.width(), 140);
    EXPECT_EQ(view.picture_width, 120);
    EXPECT_EQ(view.margin_px, 10);
    EXPECT_NEAR(static_cast<double>(view.disparity(70, 40)), near, 1e-5);
    EXPECT_NEAR(static_cast<double>(view.disparity(2, 2)), far, 1e-5);
    EXPECT_EQ(view.object(2, 2), nothing_seen);
    EXPECT_EQ(view.depth_m(2, 2), std::numeric_limits<float>::infinity());
    EXPECT_EQ(view.normal(70, 40), (Vec3f{0, 0, 1}));
}

TEST(MiddleView, MarginsShowMoreOnEitherSide) {
    const Scene scene = everything(1);
    const MiddleView narrow = view_of(scene, 0), wide = view_of(scene, 37);
    int differ = 0;
    for (int y = 0; y < narrow.height(); ++y) {
        for (int x = 0; x < narrow.width(); ++x) {
            if (narrow.triangle(x, y) != wide.triangle(x + 37, y)) {
                ++differ;  // a vertex that snapped the other way
            } else if (narrow.triangle(x, y) != nothing_seen) {
                ASSERT_NEAR(narrow.disparity(x, y), wide.disparity(x + 37, y), 1e-3f);
            }
        }
    }
    EXPECT_LE(differ, 5);
    // The floor goes on there.
    EXPECT_NE(wide.triangle(10, 100), nothing_seen);
}

TEST(MiddleView, ParallelRaysAreRefused) {
    EXPECT_THROW(view_of(everything(1, true), 0), UsageError);
}

TEST(MiddleView, SameBitsForAnyExec) {
    const Scene scene = everything(1);
    const MiddleView expected = view_of(scene, 21, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        const MiddleView view = view_of(scene, 21, {isa, 3});
        EXPECT_EQ(view.depth_m, expected.depth_m) << isa_name(isa);
        EXPECT_EQ(view.normal, expected.normal) << isa_name(isa);
        EXPECT_EQ(view.triangle, expected.triangle) << isa_name(isa);
        EXPECT_EQ(view.disparity, expected.disparity) << isa_name(isa);
    }
}

TEST(MiddleView, NothingToSeeIsInfinitelyFar) {
    const MiddleView view = view_of(empty_scene(30, 20), 4);
    EXPECT_EQ(view.width(), 38);
    for (const float z : view.depth_m.pixels)
        EXPECT_EQ(z, std::numeric_limits<float>::infinity());
    const std::vector<float> least(view.disparity.pixels.size(), view.disparity.pixels[0]);
    EXPECT_EQ(view.disparity.pixels, least);
    EXPECT_LT(least[0], 0);
}

TEST(AutomaticMargin, HoldsHalfTheWidestDisparityAndWhatEditsAdd) {
    MiddleView view;
    view.picture_width = 400;
    view.picture_height = 1;
    view.disparity = DisparityMap(400, 1, 3.0f);
    view.disparity(7, 0) = -21.0f;
    const int plain = automatic_margin(view, {});
    EXPECT_GE(plain, 11);
    EXPECT_LE(plain, 30);
    StereoEdit edit;
    edit.what = AnchorEdit{{}, 30};
    EXPECT_EQ(automatic_margin(view, {edit}), plain + 15);
    edit.weight = 0;
    EXPECT_EQ(automatic_margin(view, {edit}), plain);
    // Never more than a quarter of the picture, however near something is.
    view.disparity(7, 0) = 1e30f;
    EXPECT_EQ(automatic_margin(view, {}), 100);
    view.disparity(7, 0) = std::numeric_limits<float>::infinity();
    EXPECT_EQ(automatic_margin(view, {}), 100);
}

}  // namespace
}  // namespace obscura
