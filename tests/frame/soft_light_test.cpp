// Frames lit by what has a size: penumbrae against formulas, a sky that is kept out, the same bits however
// they are rendered.

#include <gtest/gtest.h>

#include <cmath>

#include "app/frame/frame_sky.h"
#include "app/frame/soft_light.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

SceneLight soft(SceneLight light, int samples = auto_samples) {
    light.shadow.method = ShadowMethod::exact;
    light.shadow.samples = samples;
    return light;
}

/// A floor from straight above, `wide` metres of it across the picture.
Scene floor_from_above(int width, int height, double wide) {
    Scene scene = empty_scene(width, height);
    add(scene, plane(200, 200), 0);
    scene.camera.kind = CameraKind::orthographic;
    scene.camera.height_m = wide * height / width;
    // From below whatever hangs over it.
    scene.camera.eye = {0, 0.5, 0};
    scene.camera.look_at = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.near_m = 0.01;
    return scene;
}

/// Share of a disc beyond a line at `u` radii from its middle.
double disc_beyond(double u) {
    u = std::clamp(u, -1.0, 1.0);
    return (std::acos(u) - u * std::sqrt(1 - u * u)) / num::pi;
}

TEST(SoftLight, PenumbraOfAnEdgeIsADiscCutByALine) {
    // The left half of the sky is covered by a slab 2 m up.
    Scene scene = floor_from_above(256, 16, 0.6);
    add(scene, box({50, 0.01f, 100}), 0, {-25, 2, 0});
    scene.lights.push_back(soft(directional({0, -1, 0}, {1, 1, 1})));
    scene.lights[0].light.angular_diameter_deg = 10;
    const double reach = 1.995 * std::tan(5 * num::pi / 180);
    // Points that a line cuts off a disc are as many as they should be to about count^(-3/4).
    for (const auto& [points, tolerance] : {std::pair{64, 0.05}, {256, 0.025}, {1024, 0.014}}) {
        scene.lights[0].shadow.samples = points;
        const Frame frame = render_frame(scene);
        for (int x = 0; x < 256; ++x) {
            const double at = ((x + 0.5) / 256 - 0.5) * 0.6;
            EXPECT_NEAR(num::pi * static_cast<double>(pixel(frame, x, 8).x) / (0.96 * 0.96),
                        disc_beyond(-at / reach), tolerance)
                << points << " points, column " << x;
        }
    }
}

TEST(SoftLight, ARectangleLightsAsItsRadianceSays) {
    // Irradiance of the floor by quadrature over the light, near it and aside.
    Scene scene = floor_from_above(64, 64, 4);
    SceneLight area;
    area.light.kind = LightKind::area;
    area.light.position = {0.3, 0.8, 0};
    area.light.direction = {0, -1, 0};
    area.light.across = {1, 0, 0};
    area.light.width_m = 1.2;
    area.light.height_m = 0.5;
    area.light.color = {7, 7, 7};
    area.light.range_m = 1e4;
    scene.lights.push_back(soft(area, 256));
    const Frame frame = render_frame(scene);
    for (const auto& [px, py] : {std::pair{32, 32}, {5, 60}, {50, 20}, {63, 0}, {36, 32}}) {
        const double x = ((px + 0.5) / 64 - 0.5) * 4, z = ((py + 0.5) / 64 - 0.5) * 4;
        constexpr int n = 60;
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                const Vec3d d = Vec3d{0.3 + 1.2 * ((i + 0.5) / n - 0.5), 0.8, 0.5 * ((j + 0.5) / n - 0.5)} -
                                Vec3d{x, 0, z};
                const double r2 = dot(d, d);
                sum += 7 * d.y * d.y / (r2 * r2) * (1.2 * 0.5 / (n * n));
            }
        }
        // Matt white gives back 96 % of 96 %, over pi.
        const auto seen = static_cast<double>(pixel(frame, px, py).x);
        EXPECT_NEAR(seen, sum / num::pi * 0.96 * 0.96, 0.02 * sum / num::pi) << px << ',' << py;
    }
}

TEST(SoftLight, ABallOfLightHasThePenumbraOfADisc) {
    // Far above the edge, so that its rays are nearly parallel.
    Scene scene = floor_from_above(128, 16, 0.6);
    add(scene, box({50, 0.01f, 100}), 0, {-25, 2, 0});
    SceneLight lamp = at_point(LightKind::point, {0, 400, 0}, {0, -1, 0}, {1, 1, 1});
    lamp.light.range_m = 1e5;
    lamp.light.radius_m = 400 * std::tan(5 * num::pi / 180);
    scene.lights.push_back(soft(lamp, 256));
    const Frame frame = render_frame(scene);
    const double full = static_cast<double>(pixel(frame, 127, 8).x);
    const double reach = 1.995 * std::tan(5 * num::pi / 180);
    for (int x = 0; x < 128; ++x) {
        const double at = ((x + 0.5) / 128 - 0.5) * 0.6;
        EXPECT_NEAR(static_cast<double>(pixel(frame, x, 8).x) / full, disc_beyond(-at / reach), 0.03) << x;
    }
}

TEST(SoftLight, SmallLightsCostWhatHardOnesDo) {
    Scene scene = everything(1);
    scene.lights.resize(1);
    scene.lights[0] = soft(scene.lights[0]);
    const Frame hard = render_frame(scene);
    scene.lights[0].light.angular_diameter_deg = 1e-4;
    const Frame far_sun = render_frame(scene);
    EXPECT_EQ(far_sun.stats.lights[0].samples, 1);
    EXPECT_EQ(hash(far_sun), hash(hard));
    scene.lights[0].light.angular_diameter_deg = 2;
    const Frame sun = render_frame(scene);
    EXPECT_GE(sun.stats.lights[0].samples, 16);
    EXPECT_GT(sun.stats.lights[0].penumbra_px, 1);
    // Asked for its middle alone it is hard again.
    scene.lights[0].shadow.samples = 1;
    EXPECT_EQ(hash(render_frame(scene)), hash(hard));
}

Scene soft_everything(int samples) {
    Scene scene = everything(samples);
    for (SceneLight& light : scene.lights)
        light = soft(light, 16);
    scene.lights[0].light.angular_diameter_deg = 6;
    scene.lights[1].light.radius_m = 0.2;
    scene.lights[2].light.radius_m = 0.1;
    SceneLight area = scene.lights[1];
    area.light.kind = LightKind::area;
    area.light.position = {1, 3, 3};
    area.light.direction = normalize(Vec3d{-0.2, -1, -0.4});
    area.light.across = normalize(cross(area.light.direction, Vec3d{0, 0, 1}));
    area.light.shape = AreaShape::disc;
    area.light.two_sided = true;
    scene.lights.push_back(area);
    scene.sky.occlusion = true;
    scene.sky.samples = 16;
    return scene;
}

TEST(SoftLight, SamePictureOnEveryIsaThreadCountAndCrop) {
    for (const int samples : {1, 4}) {
        Scene scene = soft_everything(samples);
        scene.render.width = 60;
        scene.render.height = 40;
        if (samples == 4) scene.sky.kind = SkyKind::clear;
        // The scalar reference asks every triangle: it draws the smaller picture alone.
        expect_one_picture(scene, {17, 11, 37, 23}, {samples == 1 ? Isa::ref : Isa::sse2, 1});
    }
}

/// `n` samples of a picture whose sky alone sheds light.
Scene under_the_sky(int sky_samples, SkyKind kind) {
    Scene scene = empty_scene(48, 32);
    scene.sky = Sky{};
    scene.sky.kind = kind;
    scene.sky.occlusion = true;
    scene.sky.samples = sky_samples;
    scene.sky.bounces = 0;
    scene.camera.eye = {0, 2, 5};
    scene.camera.look_at = {0, 0, 0};
    return scene;
}

TEST(OccludedSky, OpenGroundGetsAllOfIt) {
    for (const SkyKind kind : {SkyKind::gradient, SkyKind::clear, SkyKind::overcast}) {
        Scene scene = under_the_sky(256, kind);
        add(scene, plane(40, 40), 0);
        const FrameSky sky = frame_sky(scene.sky, {});
        Vec3d expected{};
        if (sky.model) {
            expected = unoccluded_irradiance(sky_grid(*sky.model, {}), {0, 1, 0});
        } else {
            expected = to_double(scene.sky.horizon) * num::pi +
                       to_double(scene.sky.zenith - scene.sky.horizon) * (2 * num::pi / 3);
        }
        // The camera's normal look at the middle, matt white: what is mirrored is little and in `frame`, too.
        scene.materials[0].base_color = {1, 1, 1};
        const Frame white = render_frame(scene);
        scene.materials[0].base_color = {0, 0, 0};
        const Frame black = render_frame(scene);
        const Vec3f diffuse = pixel(white, 24, 16) - pixel(black, 24, 16);
        const Vec3d got = to_double(diffuse) * (num::pi / (0.96 * 0.96));
        EXPECT_NEAR(got.x, expected.x, 0.02 * expected.x);
        EXPECT_NEAR(got.y, expected.y, 0.02 * expected.y);
        EXPECT_NEAR(got.z, expected.z, 0.02 * expected.z);
    }
}

TEST(OccludedSky, AClosedRoomIsDark) {
    struct Case {
        SkyKind kind;
        int directions, per_pixel;
    };
    // With sixteen directions and samples there is one for each, which most surfaces do not face.
    for (const Case& c : {Case{SkyKind::gradient, 64, 4},
                          {SkyKind::clear, 64, 1},
                          {SkyKind::overcast, 256, 4},
                          {SkyKind::gradient, 16, 1},
                          {SkyKind::gradient, 16, 4},
                          {SkyKind::clear, 16, 16}}) {
        Scene scene = under_the_sky(c.directions, c.kind);
        scene.render.samples = c.per_pixel;
        scene.materials[0].roughness = 0.4f;
        add(scene, box({8, 6, 14}), 0, {0, 1, 0});
        add(scene, box({1, 1, 1}), 0, {0, -1.5f, 0});
        const Frame frame = render_frame(scene);
        for (const Vec3f& p : frame.radiance.pixels) {
            ASSERT_NEAR(p.x, 0, 1e-6);
            ASSERT_NEAR(p.y, 0, 1e-6);
            ASSERT_NEAR(p.z, 0, 1e-6);
        }
    }
}

TEST(OccludedSky, AStreetSeesTheSkyBetweenItsHouses) {
    // The middle of a long street of an even sky: sky view factor cos(atan(2 h / w)).
    Scene scene = under_the_sky(1024, SkyKind::gradient);
    scene.sky.zenith = scene.sky.horizon = {1, 1, 1};
    scene.sky.ground = {0, 0, 0};
    add(scene, plane(400, 400), 0);
    add(scene, box({1, 10, 400}), 0, {-6.5f, 5, 0});
    add(scene, box({1, 10, 400}), 0, {6.5f, 5, 0});
    scene.camera.eye = {0, 2, 0.01};
    scene.camera.look_at = {0, 0, 0};
    scene.materials[0].base_color = {1, 1, 1};
    const Frame white = render_frame(scene);
    scene.materials[0].base_color = {0, 0, 0};
    const Frame black = render_frame(scene);
    const double got = static_cast<double>((pixel(white, 24, 16) - pixel(black, 24, 16)).x) / (0.96 * 0.96);
    EXPECT_NEAR(got, std::cos(std::atan(2 * 10 / 12.0)), 0.01);
}

}  // namespace
}  // namespace obscura
