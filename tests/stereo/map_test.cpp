// Disparity maps: from depth, of both eyes from the middle view, against rays through the scene.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/num.h"
#include "core/scene.h"
#include "stereo/disparity.h"
#include "stereo/row_spans.h"
#include "tests/stereo/ray_scene.h"

namespace obscura {
namespace {

TEST(DisparityMap, FollowsTheLawOfDepth) {
    Camera camera;
    camera.vfov_deg = 90;
    const StereoRig rig{.interaxial_m = 0.1, .zero_parallax_m = 2};
    const DisparityLaw law = disparity_law(rig, camera, 200);  // focal length 100 px
    EXPECT_NEAR(law.focal_px, 100, 1e-12);
    Image<float> depth(3, 1);
    depth.pixels = {1, 2, std::numeric_limits<float>::infinity()};
    const DisparityMap map = disparity_map(depth, law, Exec{});
    EXPECT_FLOAT_EQ(map(0, 0), 5);   // 10 / 1 - 10 / 2: in front of the screen
    EXPECT_FLOAT_EQ(map(1, 0), 0);   // on the screen
    EXPECT_FLOAT_EQ(map(2, 0), -5);  // infinity

    // The definition itself: project a point into both eyes' sheared frustums.
    const double x = 0.3, z = 1.37;
    const auto column = [&](double eye) { return 100 * (x - eye) / z + 100 * eye / 2; };
    EXPECT_NEAR(static_cast<double>(law.at(z)), column(-0.05) - column(0.05), 1e-6);
}

TEST(DisparityMap, DepthMustBePositive) {
    EXPECT_DEATH(disparity_map(Image<float>(2, 2, 0.0f), DisparityLaw{1, 1, 1}, Exec{}), "depth");
}

TEST(DisparityUnits, PercentAndDegrees) {
    EXPECT_DOUBLE_EQ(percent_of_width(19.2, 1920), 1);
    const StereoRig rig{.screen_width_m = 0.5, .viewing_distance_m = 0.6, .eye_separation_m = 0.064};
    EXPECT_EQ(vergence_deg(0, 1000, rig), 0);

    // Disparity as wide as the eyes' distance, uncrossed: lines of sight are parallel, the angle is all of
    // the screen's own vergence less.
    const double parallel_px = -0.064 / 0.5 * 1000;
    const double screen_deg = 2 * num::atan(0.032 / 0.6) * 180 / num::pi;
    EXPECT_NEAR(vergence_deg(parallel_px, 1000, rig), -screen_deg, 1e-12);

    // A point that far in front that its angle is known: at half the distance, straight ahead.
    // Its disparity on the screen equals the eyes' separation.
    EXPECT_NEAR(vergence_deg(-parallel_px, 1000, rig),
                2 * num::atan(0.032 / 0.3) * 180 / num::pi - screen_deg, 1e-12);
    for (const double px : {-300.0, -10.0, 0.0, 3.0, 250.0})
        EXPECT_NEAR(disparity_of_vergence(vergence_deg(px, 1000, rig), 1000, rig), px, 1e-9);

    // Lines of sight cannot cross at more than half a turn, however near the eyes are to the screen.
    const StereoRig near{.screen_width_m = 0.5, .viewing_distance_m = 0.02, .eye_separation_m = 0.064};
    EXPECT_EQ(disparity_of_vergence(90, 1000, near), std::numeric_limits<double>::infinity());
}

TEST(RowSpans, JoinsSurfacesAndNotSilhouettes) {
    const float plane[] = {0, 3, 6, 9, 9, 9, 2, 2};  // a steep plane, a crease, a jump
    SpanRow row{plane, plane, nullptr, 8, 0};
    for (int x = 0; x < 5; ++x)
        EXPECT_TRUE(joined(row, x, 0.5)) << x;
    EXPECT_FALSE(joined(row, 5, 0.5));
    const std::uint32_t object[] = {0, 0, 1, 1, 1, 1, 1, 1};
    row.object = object;
    EXPECT_FALSE(joined(row, 1, 0.5));
}

TEST(RowSpans, ShiftZeroGivesTheRowBack) {
    const float d[] = {0.3f, 0.4f, 17, 17.1f, 17.5f, -3, -3};
    std::vector<RowHit> hits(5);
    draw_spans({d, d, nullptr, 7, 1}, 0, 0.5, hits);
    for (int x = 0; x < 5; ++x) {
        EXPECT_EQ(hits[static_cast<std::size_t>(x)].disparity, d[x + 1]);
        EXPECT_EQ(hits[static_cast<std::size_t>(x)].column, static_cast<float>(x + 1));
    }
}

TEST(RowSpans, NearerStaysAndUncoveredIsEmpty) {
    const float d[] = {0, 0, 0, 4, 4, 0, 0, 0, 0, 0};  // 4 px in front of a wall
    std::vector<RowHit> hits(10);
    draw_spans({d, d, nullptr, 10, 0}, 0.5, 0.5, hits);  // moves by 2 to the right
    const float nothing = -std::numeric_limits<float>::infinity();
    const float expected[] = {0, 0, 0, nothing, nothing, 4, 4, 0, 0, 0};
    for (std::size_t x = 0; x < 10; ++x)
        EXPECT_EQ(hits[x].original, expected[x]) << x;

    // Outlines show their own pixels, not a mixture with what lies beside them.
    std::vector<RowHit> between(10);
    draw_spans({d, d, nullptr, 10, 0}, 0.45, 0.5, between);
    for (const RowHit& hit : between) {
        if (!hit.found()) continue;
        const bool own =
            hit.original > 0 ? hit.column >= 3 && hit.column <= 4 : hit.column <= 2 || hit.column >= 5;
        EXPECT_TRUE(own) << hit.column;
    }
}

TEST(RowSpans, APoleOfOnePixelStaysOnePixelWide) {
    const float d[] = {0, 0, 0, 0, 6, 0, 0, 0, 0, 0, 0, 0};
    for (double shift = 0; shift <= 1; shift += 0.03) {
        std::vector<RowHit> hits(12);
        draw_spans({d, d, nullptr, 12, 0}, shift, 0.5, hits);
        int wide = 0;
        for (const RowHit& hit : hits)
            wide += hit.original == 6 ? 1 : 0;
        EXPECT_EQ(wide, 1) << shift;
    }
}

TEST(RowSpans, DepthDecidesWhereEditsMovedThingsPastEachOther) {
    const float original[] = {0, 0, 4, 4, 0, 0, 0, 0}, edited[] = {9, 9, 2, 2, 9, 9, 9, 9};
    std::vector<RowHit> hits(8);  // of an eye at 0, where all stay in place, and at 1
    draw_spans({edited, original, nullptr, 8, 0}, 1, 0.5, hits);
    EXPECT_EQ(hits[4].disparity, 2.0f);  // the near one, pushed far behind the wall, still hides it
    EXPECT_EQ(hits[5].disparity, 2.0f);
}

struct Agreement {
    int pixels = 0, unknown = 0, wrong_surface = 0, wrong_sight = 0, unknown_but_seen = 0;
    double worst_px = 0;
};

/// One eye's map (side -1 left, 1 right) against rays.
Agreement compare(const RayScene& scene, const EyeDisparity& eye, int side) {
    Agreement a;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            ++a.pixels;
            const RayScene::Hit truth = scene.seen(side, x, y);
            const auto d = static_cast<double>(eye.disparity(x, y));
            if (eye.sight(x, y) == Sight::unknown) {
                ++a.unknown;
                if (scene.sees(0, truth)) ++a.unknown_but_seen;
                continue;
            }
            const double true_d = static_cast<double>(scene.law().at(truth.z));
            if (std::abs(d - true_d) > 0.5) {
                ++a.wrong_surface;
                continue;
            }
            a.worst_px = std::max(a.worst_px, std::abs(d - true_d));
            const double other = x + side * true_d;
            const Sight sight = !(other >= -0.5 && other < scene.width - 0.5) ? Sight::outside
                                : scene.sees(-side, truth)                    ? Sight::both
                                                                              : Sight::hidden;
            if (sight != eye.sight(x, y)) ++a.wrong_sight;
        }
    }
    return a;
}

class BothEyes : public testing::TestWithParam<int> {};

TEST_P(BothEyes, FromTheMiddleViewAgreeWithRays) {
    RayScene scene;
    scene.margin_px = 12;  // > half the largest disparity
    const MiddleView view = scene.view();
    const TwoWayDisparity two = two_way_disparity(view, view.disparity, TwoWayParams{}, Exec{});
    const int side = GetParam();
    const Agreement a = compare(scene, side < 0 ? two.left : two.right, side);
    RecordProperty("unknown", a.unknown);
    fmt::print("unknown {} ({} of them seen) wrong surface {} wrong sight {} worst {:.4f} px of {}\n",
               a.unknown, a.unknown_but_seen, a.wrong_surface, a.wrong_sight, a.worst_px, a.pixels);
    // What only this eye sees beside the sphere: half its disparity before the wall, on a third of the rows.
    EXPECT_GT(a.unknown, 300);
    EXPECT_LT(a.unknown, 700);
    // Silhouettes lie between pixel centres; each row has a handful of their pixels.
    EXPECT_LT(a.unknown_but_seen, scene.height);
    EXPECT_LT(a.wrong_surface, scene.height);
    EXPECT_LT(a.wrong_sight, scene.height);
    EXPECT_LT(a.worst_px, 0.5);
}

TEST_P(BothEyes, FromTheirOwnDepthAgreeWithRays) {
    const RayScene scene;
    EyeDisparity eyes[2];
    for (int e = 0; e < 2; ++e) {
        Image<float> depth(scene.width, scene.height);
        for (int y = 0; y < scene.height; ++y)
            for (int x = 0; x < scene.width; ++x)
                depth(x, y) = static_cast<float>(scene.seen(2 * e - 1, x, y).z);
        eyes[e].disparity = eyes[e].original = disparity_map(depth, scene.law(), Exec{});
    }
    const TwoWayDisparity two = cross_checked(eyes[0], eyes[1], TwoWayParams{}, Exec{});
    const int side = GetParam();
    const Agreement a = compare(scene, side < 0 ? two.left : two.right, side);
    fmt::print("wrong sight {} worst {:.4g} px of {}\n", a.wrong_sight, a.worst_px, a.pixels);
    EXPECT_EQ(a.unknown, 0);
    EXPECT_EQ(a.wrong_surface, 0);
    EXPECT_LT(a.worst_px, 1e-5);
    EXPECT_LT(a.wrong_sight, scene.height);
    const Image<std::uint8_t> mask = occlusion_mask(side < 0 ? two.left : two.right);
    EXPECT_EQ(mask(scene.width / 2, 20), 0);
    EXPECT_EQ(mask(side < 0 ? scene.width - 1 : 0, 20), 255);  // beyond the other's picture
}

INSTANTIATE_TEST_SUITE_P(Sides, BothEyes, testing::Values(-1, 1),
                         [](const auto& p) { return p.param < 0 ? "Left" : "Right"; });

TEST(TwoWay, GrazingPlanesDoNotTear) {
    RayScene scene;  // nothing but a wall that runs away to the right
    scene.radius = 0;
    scene.floor_y = 1e9;
    scene.interaxial_m = 1;
    scene.zero_parallax_m = 8;
    scene.wall_normal = {0.5, 0, -0.2};
    scene.wall_z = 4;
    scene.width = 100;
    scene.margin_px = 100;
    const MiddleView view = scene.view();
    EXPECT_GT(std::abs(view.disparity(101, 50) - view.disparity(100, 50)), 0.5f);
    TwoWayParams exact;
    exact.hidden_px = 0.05;
    const TwoWayDisparity two = two_way_disparity(view, view.disparity, exact, Exec{});
    for (int x = 0; x < scene.width; ++x) {
        EXPECT_NE(two.left.sight(x, 50), Sight::hidden) << x;  // by its own next pixel
        EXPECT_NE(two.right.sight(x, 50), Sight::hidden) << x;
        const auto truth = static_cast<double>(scene.law().at(scene.seen(-1, x, 50).z));
        ASSERT_NE(two.left.sight(x, 50), Sight::unknown) << x;
        EXPECT_NEAR(static_cast<double>(two.left.disparity(x, 50)), truth, 1e-3) << x;
    }
}

TEST(TwoWay, MasksTellHiddenFromUnknown) {
    MiddleView view;
    view.picture_width = 12;
    view.picture_height = 1;
    view.disparity = DisparityMap(12, 1, 0.0f);
    for (int x = 5; x < 8; ++x)
        view.disparity(x, 0) = 4;
    const TwoWayDisparity two = two_way_disparity(view, view.disparity, TwoWayParams{}, Exec{});
    const std::vector<std::uint8_t> left{0, 0, 0, 255, 255, 128, 128, 0, 0, 0, 0, 0};
    EXPECT_EQ(occlusion_mask(two.left).pixels, left);  // columns 3 and 4: the right eye sees the box there
    const std::vector<std::uint8_t> right{0, 0, 0, 0, 0, 0, 128, 128, 255, 255, 0, 0};
    EXPECT_EQ(occlusion_mask(two.right).pixels, right);
}

TEST(TwoWay, AnOffsetOfEverythingMovesNothingButTheEyes) {
    RayScene scene;
    scene.margin_px = 20;
    const MiddleView view = scene.view();
    DisparityMap moved = view.disparity;
    for (float& d : moved.pixels)
        d += 6;  // three columns each way
    const TwoWayDisparity before = two_way_disparity(view, view.disparity, TwoWayParams{}, Exec{});
    const TwoWayDisparity after = two_way_disparity(view, moved, TwoWayParams{}, Exec{});
    for (int y = 0; y < scene.height; y += 7) {
        for (int x = 10; x + 10 < scene.width; ++x) {
            const float was = before.left.disparity(x, y), is = after.left.disparity(x + 3, y);
            ASSERT_EQ(std::isfinite(was), std::isfinite(is));
            if (std::isfinite(was)) {
                EXPECT_NEAR(was + 6, is, 1e-4f);
            }
        }
    }
}

TEST(TwoWay, SameBitsForAnyThreads) {
    RayScene scene;
    scene.margin_px = 12;
    const MiddleView view = scene.view();
    const TwoWayDisparity one = two_way_disparity(view, view.disparity, {}, Exec{best_isa(), 1});
    const TwoWayDisparity three = two_way_disparity(view, view.disparity, {}, Exec{best_isa(), 3});
    EXPECT_EQ(one.left.sight, three.left.sight);
    for (std::size_t i = 0; i < one.left.disparity.pixels.size(); ++i) {
        const float a = one.right.disparity.pixels[i], b = three.right.disparity.pixels[i];
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
}

TEST(Reduced, SamplesPixelCentresNearestToBlocks) {
    RayScene scene;
    scene.width = 37;
    scene.height = 21;
    scene.margin_px = 3;
    const MiddleView view = scene.view();
    const int offset[] = {0, 0, 1, 3}, reductions[] = {1, 2, 4, 8};
    for (int i = 0; i < 4; ++i) {
        const int r = reductions[i];
        const MiddleView small = reduced(view, r);
        EXPECT_EQ(small.reduction, r);
        EXPECT_EQ(small.picture_width, 37);
        EXPECT_EQ(small.margin_px, 3);
        ASSERT_EQ(small.width(), (43 + r - 1) / r);
        ASSERT_EQ(small.height(), (21 + r - 1) / r);
        EXPECT_EQ(small.disparity(2, 1), view.disparity(2 * r + offset[i], r + offset[i]));
        EXPECT_EQ(small.normal(2, 1), view.normal(2 * r + offset[i], r + offset[i]));
        EXPECT_EQ(small.object(2, 1), view.object(2 * r + offset[i], r + offset[i]));
        // The last block may be narrower than its centre.
        const int last = std::min((small.width() - 1) * r + offset[i], 42);
        EXPECT_EQ(small.depth_m(small.width() - 1, 0), view.depth_m(last, offset[i]));
    }
    EXPECT_TRUE(reduced(view, 2).triangle.width > 0);
    EXPECT_DEATH(reduced(view, 3), "");
}

}  // namespace
}  // namespace obscura
