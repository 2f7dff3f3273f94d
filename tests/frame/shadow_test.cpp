// Shadows against geometry and exact rays.

#include <gtest/gtest.h>

#include <cmath>

#include "filters/shadow_lookup.h"
#include "raster/lighting.h"
#include "raster/view.h"
#include "tests/frame/scenes.h"
#include "tests/frame/shadow_rays.h"

namespace obscura {
namespace {

using namespace frame_scenes;

/// A slab with a box on it, from above; the light comes down at 45 degrees towards +X.
Scene box_on_slab(int filter_px) {
    Scene scene = empty_scene(256, 32);
    add(scene, box({-4, -0.5, -4}, {4, 0, 4}), 0);
    add(scene, box({-0.5, 0, -1}, {0.5, 1, 1}), 0);
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = 0.5;
    scene.camera.eye = {0.5 + 1.0, 5, 0};
    scene.camera.look_at = {0.5 + 1.0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.lights.push_back(directional({1, -1, 0}, {1, 1, 1}, filter_px, 1024));
    return scene;
}

class ShadowEdge : public testing::TestWithParam<int> {};

TEST_P(ShadowEdge, LiesWhereGeometrySaysWithinATexel) {
    const Scene scene = box_on_slab(GetParam());
    const Frame frame = render_frame(scene, all_channels());
    const Bounds bounds = bounds_of(scene.mesh);
    // On the floor a texel of the map is sqrt(2) times longer.
    const double texel = texel_size_m(shadow_views(scene.lights[0], bounds)[0]) * std::sqrt(2.0);
    const double m = scene.camera.height_m / scene.render.height;
    const double reach = 0.5 * std::max(GetParam() - 1, 1);
    for (int y = 0; y < 32; ++y) {
        double crossing = NAN;
        for (int x = 0; x < 256; ++x) {
            const double at = 1.5 + (x + 0.5 - 128) * m;
            const float v = frame.shadow(x, y);
            if (at > 0.51 && at < 1.5 - (reach + 1) * texel) {
                EXPECT_EQ(v, 0.0f) << at;
            }
            if (at > 1.5 + (reach + 1) * texel) {
                EXPECT_EQ(v, 1.0f) << at;
            }
            if (x > 0 && frame.shadow(x - 1, y) < 0.5f && v >= 0.5f) crossing = at - 0.5 * m;
        }
        EXPECT_NEAR(crossing, 1.5, texel) << "row " << y;
    }
}
INSTANTIATE_TEST_SUITE_P(Kernels, ShadowEdge, testing::Values(1, 3, 5));

TEST(ShadowRamp, LargerKernelsMakeARampWithoutSteps) {
    for (const int side : {3, 5}) {
        Scene scene = box_on_slab(side);
        scene.lights[0].shadow.resolution = 256;
        const Frame frame = render_frame(scene, all_channels());
        const double texel =
            texel_size_m(shadow_views(scene.lights[0], bounds_of(scene.mesh))[0]) * std::sqrt(2.0);
        const double m = scene.camera.height_m / scene.render.height;
        // The steepest slope of a box filter of side - 1 texels is 1 / (side - 1) per texel.
        const double most = m / texel / (side - 1) * 1.02;
        int between = 0;
        for (int x = 1; x < 256; ++x) {
            const double step =
                static_cast<double>(frame.shadow(x, 16)) - static_cast<double>(frame.shadow(x - 1, 16));
            if (x > 75) {
                EXPECT_LE(std::fabs(step), most) << x;
            }
            between += x > 75 && frame.shadow(x, 16) > 0 && frame.shadow(x, 16) < 1;
        }
        EXPECT_GT(between, 3);
    }
}

Scene solids_for_rays() {
    Scene scene = empty_scene(96, 72);
    add(scene, box({-4, -0.5, -4}, {4, 0, 4}), 0);
    add(scene, box({-1.6, 0, -0.6}, {-0.6, 1.4, 0.5}), 0);
    add(scene, sphere(0.7, 16, 9), 0, {0.7f, 0.9f, 0.2f});
    scene.camera.eye = {1.5, 3, 5};
    scene.camera.look_at = {0, 0.3, 0};
    return scene;
}

TEST(ShadowRays, ClosedSolidsHaveNeitherAcneNorLeaksAtAnyAngle) {
    for (const int filter : {1, 3, 5}) {
        for (const Vec3d direction :
             {Vec3d{0.1, -1, 0.05}, {1, -1, 0.2}, {-0.8, -0.5, -0.5}, {0.3, -0.4, 1}}) {
            Scene scene = solids_for_rays();
            scene.lights.push_back(directional(direction, {1, 1, 1}, filter, 1024));
            const RayCount count = compare_with_rays(scene, 0.06);
            EXPECT_EQ(count.acne, 0) << "of " << count.lit << ", filter " << filter << " direction "
                                     << direction.x;
            EXPECT_EQ(count.leaks, 0)
                << "of " << count.dark << ", filter " << filter << " direction " << direction.x;
            EXPECT_GT(count.lit, 500);
            EXPECT_GT(count.dark, 100);
        }
    }
}

TEST(ShadowRays, PointLightsAndSpotsAgreeWithRays) {
    for (const LightKind kind : {LightKind::point, LightKind::spot}) {
        Scene scene = solids_for_rays();
        SceneLight light = at_point(kind, {0.2, 2.6, 1.4}, {-0.1, -1, -0.5}, {1, 1, 1});
        light.light.outer_cone_deg = 70;
        light.light.range_m = 12;
        light.shadow.resolution = 1024;
        scene.lights.push_back(light);
        const RayCount count = compare_with_rays(scene, 0.06);
        EXPECT_EQ(count.acne, 0) << "of " << count.lit;
        EXPECT_EQ(count.leaks, 0) << "of " << count.dark;
        EXPECT_GT(count.lit, 500);
        EXPECT_GT(count.dark, 100);
    }
}

TEST(ShadowRays, OpenSheetsStayLitWithoutAnOffset) {
    for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
        Scene scene = empty_scene(96, 72);
        add(scene, plane(8, 8, 4, 4), 0);
        add(scene, plane(1.5, 1.5), 0, {0.4f, 1.0f, 0.3f});
        scene.camera.eye = {1.5, 3, 5};
        scene.camera.look_at = {0, 0.3, 0};
        scene.lights.push_back(directional({0.6, -1, -0.3}, {1, 1, 1}, 3, 512));
        scene.lights[0].shadow.receivers = receivers;
        const RayCount count = compare_with_rays(scene, 0.08);
        EXPECT_EQ(count.acne, 0) << "of " << count.lit;
        EXPECT_EQ(count.leaks, 0) << "of " << count.dark;
        EXPECT_GT(count.lit, 500);
        EXPECT_GT(count.dark, 50);
    }
}

TEST(Shadow, StoredDepthsAreTheMiddlesOfTheIntervals) {
    const Scene scene = solids_for_rays();
    const SceneLight light = directional({1, -1, 0.2}, {1, 1, 1}, 1, 128);
    RasterScratch scratch;
    ShadowMap map;
    build_shadow_map(scene.mesh, light, bounds_of(scene.mesh), {}, scratch, map);
    const Image<DepthInterval> intervals =
        interval_map(scene.mesh, map.views[0], {.receivers = light.shadow.receivers}, {});
    int solid = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            ASSERT_EQ(map.stored[0].at(x, y), stored_depth(intervals(x, y)));
            solid += intervals(x, y).entry < 1;
        }
    }
    EXPECT_GT(solid, 1000);
}

TEST(Shadow, ObjectsThatCastNoneAndLightsWithoutMapsCastNone) {
    Scene scene = box_on_slab(1);
    const auto dark = [&] {
        const Frame frame = render_frame(scene);
        int n = 0;
        for (int x = 0; x < 256; ++x)
            n += pixel(frame, x, 16).x == 0.0f;
        return n;
    };
    EXPECT_GT(dark(), 50);
    const std::uint32_t box_object = scene.mesh.object.back();
    scene.mesh.objects[box_object].casts_shadow = false;
    EXPECT_EQ(dark(), 0);
    scene.mesh.objects[box_object].casts_shadow = true;
    scene.lights[0].shadow.method = ShadowMethod::none;
    EXPECT_EQ(dark(), 0);
    scene.lights[0].shadow.method = ShadowMethod::map;
    scene.lights[0].light.below_horizon = true;
    EXPECT_EQ(dark(), 256);
}

}  // namespace
}  // namespace obscura
