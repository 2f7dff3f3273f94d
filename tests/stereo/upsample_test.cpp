// Solutions of lower resolution at full resolution, and last frame's change in this frame.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/scene.h"
#include "stereo/upsample.h"
#include "stereo/warm_start.h"
#include "tests/stereo/ray_scene.h"

namespace obscura {
namespace {

constexpr std::uint32_t wall = 0, ground = 1, sphere = 2;

RayScene large_scene() {
    RayScene scene;
    scene.width = 640;
    scene.height = 360;
    scene.focal_px = 600;
    scene.margin_px = 8;
    return scene;
}

/// A rounder sphere, a wall that bends back, a floor between.
float edit(const MiddleView& view, int x, int y) {
    const double u = x / 656.0, v = y / 360.0;
    switch (view.object(x, y)) {
        case sphere:
            return 1.5f * (view.disparity(x, y) - 5);
        case wall:
            return static_cast<float>(-6 + 5 * u * u + 2 * std::sin(3 * u + 2 * v));
        case ground:
            return static_cast<float>(3 * std::sin(4 * v) - 2 * u);
        default:
            return 0;
    }
}

Image<float> edits(const MiddleView& view) {
    Image<float> change(view.width(), view.height());
    for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x)
            change(x, y) = edit(view, x, y);
    return change;
}

Image<float> sampled(const MiddleView& full, const Image<float>& image, int n) {
    const MiddleView low = reduced(full, n);
    Image<float> small(low.width(), low.height());
    for (int y = 0; y < low.height(); ++y)
        for (int x = 0; x < low.width(); ++x)
            small(x, y) = image(sampled_pixel(x, n, full.width()), sampled_pixel(y, n, full.height()));
    return small;
}

struct Error {
    double max = 0, rms = 0;
};
Error error(const MiddleView& view, const Image<float>& a, const Image<float>& b) {
    Error e;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (view.object.pixels[i] == nothing_seen) continue;
        const auto d = static_cast<double>(a.pixels[i] - b.pixels[i]);
        e.max = std::max(e.max, std::abs(d));
        e.rms += d * d;
        ++seen;
    }
    e.rms = std::sqrt(e.rms / static_cast<double>(seen));
    return e;
}

class Upsampling : public testing::TestWithParam<int> {};

TEST_P(Upsampling, OfSmoothEditsIsNearTheFullSolution) {
    const int n = GetParam();
    const MiddleView view = large_scene().view(), low = reduced(view, n);
    const Image<float> truth = edits(view);
    const Error e =
        error(view, upsampled_change(view, low, sampled(view, truth, n), UpsampleParams{}, Exec{}), truth);

    // What the nearest sample alone would give.
    Image<float> nearest = truth;
    for (int y = 0; y < view.height(); ++y)
        for (int x = 0; x < view.width(); ++x)
            nearest(x, y) =
                truth(sampled_pixel(x / n, n, view.width()), sampled_pixel(y / n, n, view.height()));
    const Error naive = error(view, nearest, truth);
    fmt::print("1:{}: max {:.4f} rms {:.5f} px; nearest sample: max {:.2f} rms {:.3f}\n", n, e.max, e.rms,
               naive.max, naive.rms);
    EXPECT_LT(e.max, 0.01);
    EXPECT_LT(e.rms, 0.001);
    EXPECT_GT(naive.rms, 100 * e.rms);
}

// A solver leaves a few hundredths of a pixel; models of the change around a sample must not blow them up.
TEST_P(Upsampling, DoesNotAmplifyASolversError) {
    const int n = GetParam();
    const MiddleView view = large_scene().view(), low = reduced(view, n);
    const Image<float> truth = edits(view);
    Image<float> noisy = sampled(view, truth, n);
    std::uint32_t state = 1;
    for (float& c : noisy.pixels) {
        state = state * 1664525u + 1013904223u;
        c += (static_cast<float>(state >> 8) / 8388608.0f - 1) * 0.02f;
    }
    const Error e = error(view, upsampled_change(view, low, noisy, UpsampleParams{}, Exec{}), truth);
    fmt::print("1:{} of +-0.02 px: max {:.4f} rms {:.5f} px\n", n, e.max, e.rms);
    EXPECT_LT(e.max, 0.3);
    EXPECT_LT(e.rms, 0.015);
}

TEST_P(Upsampling, KeepsSamplesConstantsAndZeros) {
    const int n = GetParam();
    const MiddleView view = large_scene().view(), low = reduced(view, n);
    const Image<float> truth = edits(view);
    const Image<float> up = upsampled_change(view, low, sampled(view, truth, n), UpsampleParams{}, Exec{});
    for (int y = 0; y < low.height(); ++y) {
        for (int x = 0; x < low.width(); ++x) {
            const int i = sampled_pixel(x, n, view.width()), j = sampled_pixel(y, n, view.height());
            ASSERT_EQ(up(i, j), truth(i, j)) << i << ' ' << j;
        }
    }

    // Every object its own constant: not a bit of another's, up to the outline's last pixel.
    const float constant[] = {-7.3f, 0.1f, 12.7f};
    Image<float> steps = truth;
    for (std::size_t i = 0; i < steps.pixels.size(); ++i)
        steps.pixels[i] = view.object.pixels[i] == nothing_seen ? 0 : constant[view.object.pixels[i]];
    EXPECT_EQ(upsampled_change(view, low, sampled(view, steps, n), UpsampleParams{}, Exec{}), steps);

    // No change: the very bits of the original.
    const DisparityMap same = upsampled_solution(view, low, low.disparity, UpsampleParams{}, Exec{});
    EXPECT_EQ(std::memcmp(same.pixels.data(), view.disparity.pixels.data(), same.pixels.size() * 4), 0);
}

INSTANTIATE_TEST_SUITE_P(Reductions, Upsampling, testing::Values(2, 4, 8));

TEST(Upsample, PlanesWithLinearChangesAreExactToTheirBorders) {
    // One object per half, a slanted border; the change is linear in the place on each.
    MiddleView view;
    view.picture_width = 100;
    view.picture_height = 60;
    view.disparity = Image<float>(100, 60, 3.0f);
    view.depth_m = Image<float>(100, 60, 2.0f);
    view.normal = Image<Vec3f>(100, 60, {0, 0, 1});
    view.object = view.material = Image<std::uint32_t>(100, 60);
    Image<float> truth(100, 60);
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 100; ++x) {
            view.object(x, y) = 3 * x > 100 + 2 * y ? 1 : 0;
            truth(x, y) =
                view.object(x, y) == 1 ? 0.25f * static_cast<float>(x) : 2 - 0.125f * static_cast<float>(y);
        }
    }
    const MiddleView low = reduced(view, 4);
    const Error e =
        error(view, upsampled_change(view, low, sampled(view, truth, 4), UpsampleParams{}, Exec{}), truth);
    EXPECT_LT(e.max, 0.05);  // the pull towards 0, three pixels out
}

/// One object, 96 x 96, seen straight on.
MiddleView one_object() {
    MiddleView view;
    view.picture_width = view.picture_height = 96;
    view.disparity = Image<float>(96, 96, 0.0f);
    view.depth_m = Image<float>(96, 96, 2.0f);
    view.normal = Image<Vec3f>(96, 96, {0, 0, 1});
    view.object = view.material = Image<std::uint32_t>(96, 96, 0);
    return view;
}

TEST(Upsample, AnObjectsOwnOutlinesAreToldByDisparity) {
    // An arm before its body: 10 px of disparity between them, each with a change of its own.
    MiddleView view = one_object();
    Image<float> truth(96, 96);
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            const bool arm = 3 * x > 90 + y;
            view.disparity(x, y) = arm ? 10 : 0;
            truth(x, y) = arm ? 0.1f * static_cast<float>(y) : -0.1f * static_cast<float>(x);
        }
    }
    const MiddleView low = reduced(view, 4);
    const Error e =
        error(view, upsampled_change(view, low, sampled(view, truth, 4), UpsampleParams{}, Exec{}), truth);
    fmt::print("own outline: max {:.3f} rms {:.4f}\n", e.max, e.rms);
    EXPECT_LT(e.max, 0.03);
    EXPECT_LT(e.rms, 0.002);
}

TEST(Upsample, AnObjectsOwnEdgesAreToldByNormals) {
    // Two sides of a box, the edge between samples; one side turns, the other does not.
    MiddleView view = one_object();
    Image<float> truth(96, 96);
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            if (x > 52) view.normal(x, y) = {1, 0, 0};
            truth(x, y) = x > 52 ? 0.5f * static_cast<float>(x - 52) : 0;
        }
    }
    const MiddleView low = reduced(view, 8);
    const Error e =
        error(view, upsampled_change(view, low, sampled(view, truth, 8), UpsampleParams{}, Exec{}), truth);
    fmt::print("own edge: max {:.3f} rms {:.4f}\n", e.max, e.rms);
    EXPECT_LT(e.max, 0.1);
    EXPECT_LT(e.rms, 0.02);
}

TEST(Upsample, NoiseOnAFlatDisparityIsNoSlope) {
    // A thousandth of a pixel of disparity between samples, a whole pixel of change: as if change followed
    // disparity a thousandfold. The pixel between them stands out by one pixel.
    MiddleView view = one_object();
    Image<float> change(24, 24);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x)
            view.disparity(x, y) = (x / 4 + y / 4) % 2 == 0 ? 0.2f : -0.2f;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            change(x, y) = (x + y) % 2 == 0 ? 10.0f : -10.0f;
    view.disparity(45, 42) = 1.2f;
    const Image<float> up = upsampled_change(view, reduced(view, 4), change, UpsampleParams{}, Exec{});
    EXPECT_LT(std::abs(up(45, 42)), 20.0f);
}

TEST(Upsample, WhatWasNeverSampledFollowsItsNeighbours) {
    MiddleView view;
    view.picture_width = view.picture_height = 64;
    view.disparity = Image<float>(64, 64, 1.0f);
    view.depth_m = Image<float>(64, 64, 2.0f);
    view.object = view.material = Image<std::uint32_t>(64, 64, 0);
    for (int y = 0; y < 64; ++y) {
        view.object(20, y) = 1;               // a pole between the samples of 1:8
        view.object(51, y) = y < 32 ? 2 : 0;  // one that is sampled
        view.object(2, y) = y > 50 ? 2 : 0;   // of the same object, far away and between samples
        view.object(40, y) = nothing_seen;
    }
    const MiddleView low = reduced(view, 8);
    Image<float> change(low.width(), low.height(), 4.0f);
    for (std::size_t i = 0; i < change.pixels.size(); ++i)
        if (low.object.pixels[i] == 2) change.pixels[i] = 9;
    ASSERT_EQ(low.object(6, 0), 2u);
    const Image<float> up = upsampled_change(view, low, change, UpsampleParams{}, Exec{});
    EXPECT_EQ(up(20, 30), 4.0f);
    EXPECT_EQ(up(51, 30), 9.0f);
    EXPECT_EQ(up(2, 60), 9.0f);
    EXPECT_EQ(up(40, 10), 0.0f);
    EXPECT_EQ(up(41, 10), 4.0f);
}

TEST(Upsample, SameBitsForAnyThreads) {
    const MiddleView view = large_scene().view(), low = reduced(view, 4);
    const Image<float> change = sampled(view, edits(view), 4);
    EXPECT_EQ(upsampled_change(view, low, change, UpsampleParams{}, Exec{best_isa(), 1}),
              upsampled_change(view, low, change, UpsampleParams{}, Exec{best_isa(), 3}));
}

Camera camera_of(const RayScene& scene) {
    Camera camera;  // the scene's z forward, y down
    camera.eye = {0, 0, 0};
    camera.look_at = {0, 0, 1};
    camera.up = {0, -1, 0};
    camera.vfov_deg = 2 * std::atan(scene.height / (2 * scene.focal_px)) * 180 / M_PI;
    return camera;
}

TEST(WarmStart, AStillCameraCarriesEverything) {
    const RayScene scene = large_scene();
    const MiddleView view = scene.view();
    const Camera camera = camera_of(scene);
    const Image<float> change = edits(view);
    const SeenFrame frame{view, camera};
    const Image<float> carried = carried_change(frame, change, frame, WarmStartParams{}, Exec{});
    EXPECT_LT(error(view, carried, change).max, 1e-3);

    // From a map of 1:4.
    const MiddleView low = reduced(view, 4);
    const Error coarse =
        error(view, carried_change({low, camera}, sampled(view, change, 4), frame, WarmStartParams{}, Exec{}),
              change);
    EXPECT_LT(coarse.rms, 0.2);
}

TEST(WarmStart, AMovedCameraFindsItsSurfacesAgain) {
    // The change as a function of the place in the world; the second camera stands beside and before the
    // first, which is the scene moved the other way.
    const RayScene scene = large_scene();
    RayScene moved = scene;
    const Vec3d step{0.15, -0.05, 0.3};
    moved.centre = scene.centre - step;
    moved.floor_y = scene.floor_y - step.y;
    moved.wall_z = scene.wall_z - step.z - scene.wall_normal.x / scene.wall_normal.z * step.x;
    const MiddleView before = scene.view(), now = moved.view();
    const auto change_at = [](const RayScene& s, const MiddleView& view, Vec3d eye) {
        Image<float> change(view.width(), view.height());
        for (int y = 0; y < view.height(); ++y) {
            for (int x = 0; x < view.width(); ++x) {
                const Vec3d p = s.seen(0, x - s.margin_px, y).point + eye;
                change(x, y) = static_cast<float>(2 * std::sin(p.x) + p.y - 0.3 * p.z) *
                               (view.object(x, y) == sphere ? 2.0f : 1.0f);
            }
        }
        return change;
    };
    const Image<float> change = change_at(scene, before, {}), truth = change_at(moved, now, step);
    const Camera first = camera_of(scene);
    Camera second = first;
    second.eye = second.eye + step;
    second.look_at = second.look_at + step;
    const Image<float> carried =
        carried_change({before, first}, change, {now, second}, WarmStartParams{}, Exec{});
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < carried.pixels.size(); ++i)
        if (std::abs(carried.pixels[i] - truth.pixels[i]) > 0.02f) ++wrong;
    fmt::print("{} of {} pixels are not last frame's\n", wrong, carried.pixels.size());
    EXPECT_LT(wrong, carried.pixels.size() / 100);  // uncovered, or new at the frame's sides
    EXPECT_GT(wrong, 0u);

    const DisparityMap map = carried_map({before, first}, before.disparity, {now, second}, {}, Exec{});
    EXPECT_EQ(map, now.disparity);  // no change carries as none
}

TEST(WarmStart, UncoveredPartsOfAnObjectDoNotTakeWhatHidThem) {
    // One object: a body at 4 m, an arm before it at 2 m, which has moved away.
    MiddleView before = one_object();
    before.depth_m = Image<float>(96, 96, 4.0f);
    MiddleView now = before;
    Image<float> change(96, 96, 1.0f);
    for (int y = 0; y < 96; ++y) {
        for (int x = 40; x < 50; ++x) {
            before.depth_m(x, y) = 2;
            change(x, y) = 7;
        }
    }
    const Camera camera;
    const Image<float> carried = carried_change({before, camera}, change, {now, camera}, {}, Exec{});
    EXPECT_NEAR(carried(45, 50), 1 + 6 * 10.0 / 96, 1e-5);  // the mean
    EXPECT_EQ(carried(60, 50), 1.0f);
}

TEST(WarmStart, WhatHasNoPastHasTheMeanOrNothing) {
    const RayScene scene = large_scene();
    const MiddleView before = scene.view();
    MiddleView now = before;
    Image<float> change(before.width(), before.height(), 1.0f);
    for (std::size_t i = 0; i < change.pixels.size(); ++i)
        if (before.object.pixels[i] == sphere) change.pixels[i] = 8;
    // The sphere has jumped to the left border, a new object stands at the right one.
    for (int y = 100; y < 110; ++y) {
        for (int x = 0; x < 10; ++x)
            now.object(x, y) = sphere;
        for (int x = 600; x < 610; ++x)
            now.object(x, y) = 77;
        for (int x = 500; x < 510; ++x)
            now.object(x, y) = nothing_seen;
    }
    const Camera camera = camera_of(scene);
    const Image<float> carried = carried_change({before, camera}, change, {now, camera}, {}, Exec{});
    EXPECT_EQ(carried(5, 105), 8.0f);
    EXPECT_EQ(carried(605, 105), 0.0f);
    EXPECT_EQ(carried(505, 105), 0.0f);
    EXPECT_EQ(carried(20, 105), 1.0f);
}

}  // namespace
}  // namespace obscura
