// Light that surfaces send on: patches that cover the scene, means that keep what they are means of, and
// exchanges whose sums are known.

#include "app/frame/surface_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/frame/surface_blur.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

struct Source {
    std::mt19937 bits;
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(bits);
    }
    Vec3d in(double low, double high) {
        const double x = between(low, high), y = between(low, high);
        return {x, y, between(low, high)};
    }
};

/// Triangles of all sizes and shapes, slivers and points among them, and a solid.
Scene drawn_scene(unsigned seed) {
    Source source{std::mt19937(seed)};
    Scene scene = empty_scene(16, 16);
    Mesh soup;
    for (std::uint32_t t = 0; t < 200; ++t) {
        const Vec3d at = source.in(-20, 20);
        const double size = std::pow(10, source.between(-2.5, 1.3));
        for (int k = 0; k < 3; ++k) {
            soup.positions.push_back(to_float(at + source.in(-1, 1) * size));
            soup.normals.push_back({0, 1, 0});
        }
        if (t % 9 == 0) soup.positions.back() = soup.positions[soup.positions.size() - 2];
        soup.triangles.push_back({{3 * t, 3 * t + 1, 3 * t + 2}});
    }
    add(scene, soup, 0);
    add(scene, box({4, 5, 6}), 0, {9, 0, 0});
    return scene;
}

double area_of(const Mesh& mesh, std::size_t t) {
    const auto& v = mesh.triangles[t].v;
    const Vec3d a = to_double(mesh.positions[v[0]]);
    return 0.5 * length(cross(to_double(mesh.positions[v[1]]) - a, to_double(mesh.positions[v[2]]) - a));
}

TEST(SurfacePatches, CoverWhatIsThereAndHoldTheirMiddles) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = drawn_scene(seed);
        const Mesh& mesh = scene.mesh;
        const SurfacePatches patches = surface_patches(mesh);
        double covered = 0, expected = 0;
        for (const SurfacePatch& p : patches.patches)
            covered += static_cast<double>(p.area_m2);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            // Triangles without area count as closed, too, but hold nothing.
            const Component& component = mesh.components[mesh.component[t]];
            const bool solid = component.closed && component.triangles == 12;
            expected += area_of(mesh, t) * (solid ? 1 : 2);
            EXPECT_EQ(patches.triangles[t].back == no_patch, solid);
        }
        EXPECT_NEAR(covered, expected, 1e-4 * expected);
        EXPECT_LE(patches.patches.size(), 2 * (surface_cells + mesh.triangles.size()));
        for (std::size_t i = 0; i < patches.patches.size(); ++i) {
            const SurfacePatch& p = patches.patches[i];
            if (area_of(mesh, p.triangle) < 1e-9) continue;
            const PatchMiddle middle = patch_middle(mesh, patches, p);
            ASSERT_EQ(patch_at(mesh, patches, p.triangle, p.back, middle.p), i);
        }
    }
}

TEST(SurfacePatches, APlaceBesideATriangleHasAPatchOfIt) {
    Source source{std::mt19937(5)};
    const Scene scene = drawn_scene(3);
    const SurfacePatches patches = surface_patches(scene.mesh);
    for (int i = 0; i < 20000; ++i) {
        const auto t = static_cast<std::uint32_t>(source.bits() % scene.mesh.triangles.size());
        const std::uint32_t patch = patch_at(scene.mesh, patches, t, false, source.in(-30, 30));
        const TrianglePatches& of = patches.triangles[t];
        ASSERT_GE(patch, of.front);
        ASSERT_LT(patch, of.front + std::uint32_t{of.side} * of.side);
    }
}

TEST(SurfacePatches, WhatCastsNoShadowHasNone) {
    Scene scene = drawn_scene(1);
    scene.mesh.objects.back().casts_shadow = false;
    const SurfacePatches patches = surface_patches(scene.mesh);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
        EXPECT_EQ(patches.triangles[t].front == no_patch,
                  !scene.mesh.objects[scene.mesh.object[t]].casts_shadow);
}

TEST(SurfaceBlur, KeepsWhatIsEvenAndLeavesNoRange) {
    Source source{std::mt19937(7)};
    std::vector<BlurPatch> patches;
    std::vector<Vec3f> even, drawn;
    for (int i = 0; i < 3000; ++i) {
        patches.push_back({source.in(-5, 5) * (i % 7 == 0 ? 1e9 : 1.0), static_cast<int>(source.bits() % 6),
                           static_cast<float>(source.between(0, 2))});
        even.push_back({0.25f, 0.5f, 3});
        drawn.push_back(to_float(source.in(0, 1)));
    }
    for (const double radius : {1e-3, 0.3, 40.0}) {
        for (const Vec3f& mean : mean_around(patches, even, radius)) {
            EXPECT_NEAR(mean.x, 0.25, 1e-5);
            EXPECT_NEAR(mean.z, 3, 1e-4);
        }
        for (const Vec3f& mean : mean_around(patches, drawn, radius)) {
            EXPECT_GE(mean.y, 0);
            EXPECT_LE(mean.y, 1 + 1e-5);
        }
    }
    // One that faces another way does not count.
    const std::vector<BlurPatch> two = {{{0, 0, 0}, 0, 1}, {{0.1, 0, 0}, 1, 1}};
    EXPECT_EQ(mean_around(two, {{1, 1, 1}, {0, 0, 0}}, 10)[0], (Vec3f{1, 1, 1}));
}

/// A black sky that surfaces stand before.
void send_on(Scene& scene, int samples, int bounces) {
    scene.sky.ambient = 1;
    scene.sky.occlusion = true;
    scene.sky.samples = samples;
    scene.sky.bounces = bounces;
}

TEST(SurfaceLight, AWallIsLitByTheGroundBeforeIt) {
    // A sun straight above lights the ground; a wall that sees nothing but ground below and black sky above
    // gets half of what the ground sends: E albedo / 2.
    Scene scene = empty_scene(33, 33);
    scene.materials.resize(2);
    scene.materials[1] = scene.materials[0];
    scene.materials[0].base_color = {0.6f, 0.3f, 0.9f};
    add(scene, plane(600, 600), 0);
    add(scene, box({8, 4, 1}), 1, {0, 2, -0.5f});
    scene.camera.eye = {0, 1, 4};
    scene.camera.look_at = {0, 1, 0};
    SceneLight sun = directional({0, -1, 0}, {1, 2, 3});
    sun.shadow.method = ShadowMethod::exact;
    scene.lights.push_back(sun);
    send_on(scene, 256, 1);
    const Vec3f lit = pixel(render_frame(scene), 16, 16);
    scene.sky.bounces = 0;
    const Vec3f dark = pixel(render_frame(scene), 16, 16);
    EXPECT_NEAR(dark.x, 0, 1e-6);
    // Of a white wall seen straight on 0.96 are let in and out.
    const auto expected = [](double light) { return 0.5 * light * 0.96 * 0.96 / num::pi; };
    EXPECT_NEAR(lit.x, expected(0.6), 0.04 * expected(0.6));
    EXPECT_NEAR(lit.y, expected(0.6), 0.04 * expected(0.6));
    EXPECT_NEAR(lit.z, expected(2.7), 0.04 * expected(2.7));
}

/// What all patches send together, watts per steradian.
double sum_of(const SurfaceLight& light) {
    double sum = 0;
    for (std::size_t i = 0; i < light.sent[0].size(); ++i)
        sum +=
            static_cast<double>(light.sent[0][i].x) * static_cast<double>(light.patches.patches[i].area_m2);
    return sum;
}

TEST(SurfaceLight, InAClosedRoomEveryExchangeKeepsTheAlbedosShare) {
    Scene scene = empty_scene(16, 16);
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    // A room is what lies between two boxes, the inner one turned inside out.
    Mesh room = box({6, 3, 4});
    for (Triangle& t : room.triangles)
        std::swap(t.v[1], t.v[2]);
    add(scene, room, 0);
    SceneLight lamp = at_point(LightKind::point, {1, 0.5, -0.7}, {0, -1, 0}, {5, 5, 5});
    lamp.shadow.method = ShadowMethod::exact;
    scene.lights.push_back(lamp);
    double before = 0, added = 0;
    for (const int bounces : {1, 2, 3}) {
        send_on(scene, 256, bounces);
        const double sum = sum_of(surface_light(scene, frame_sky(scene.sky, {}), {}, nullptr));
        // Directions are few, walls six.
        if (bounces > 1) {
            EXPECT_NEAR((sum - before) / (bounces == 2 ? before : added), 0.5, 0.05);
        }
        added = sum - before;
        before = sum;
    }
}

/// A picture of a sky that is bright in one direction, and one of the ground that is dotted.
std::shared_ptr<const ImageSky> panorama(double azimuth_deg, bool dotted) {
    ImageSky sky;
    sky.pixels = Image<Vec3f>(256, 128, Vec3f{0.02f, 0.02f, 0.02f});
    if (dotted) {
        for (int y = 64; y < 128; ++y) {
            for (int x = 0; x < 256; ++x)
                sky.pixels(x, y) = Vec3f{1, 1, 1} * (x % 8 == 3 && y % 8 == 5 ? 64.0f : 0.0f);
        }
    } else {
        sky.pixels(100, 30) = {3000, 3000, 3000};
    }
    sky.left_edge_azimuth_deg = azimuth_deg;
    return std::make_shared<const ImageSky>(std::move(sky));
}

TEST(SurfaceLight, FewDirectionsShedWhatAllDo) {
    const auto level = [](const std::vector<Light>& lights, double side) {
        double sum = 0;
        for (const Light& l : lights)
            sum += static_cast<double>(l.color.x) * std::max(0.0, -l.direction.y * side);
        return sum;
    };
    for (const SkyKind kind : {SkyKind::gradient, SkyKind::clear, SkyKind::overcast, SkyKind::image}) {
        for (const int samples : {16, 64, 256}) {
            for (const double azimuth : {0.0, 30.0, 77.0, 200.0}) {
                Sky sky;
                sky.kind = kind;
                sky.occlusion = true;
                sky.samples = samples;
                sky.sun_azimuth_deg = azimuth;
                if (kind == SkyKind::image) sky.image = panorama(azimuth, false);
                const FrameSky f = frame_sky(sky, {});
                EXPECT_NEAR(level(f.few, 1), level(f.lights, 1), 0.07 * level(f.lights, 1)) << samples;
                EXPECT_NEAR(level(f.few, -1), level(f.lights, -1), 0.06 * level(f.lights, -1)) << samples;
                // All around: a wall gets as much from below whichever way it looks.
                for (int turn = 0; turn < 360; turn += 30) {
                    const Vec3d n = compass_direction(turn, 0);
                    double wall = 0;
                    for (std::size_t i = 16; i < f.few.size(); ++i)
                        wall += std::max(0.0, -dot(f.few[i].direction, n)) * f.few_sr[i];
                    EXPECT_NEAR(wall, num::pi / 2, 0.2 * num::pi / 2) << turn;
                }
            }
        }
    }
}

TEST(ImageSkies, DottedGroundShedsItsMean) {
    for (const int samples : {16, 64, 256}) {
        Sky sky;
        sky.kind = SkyKind::image;
        sky.occlusion = true;
        sky.samples = samples;
        sky.image = panorama(0, true);
        const FrameSky f = frame_sky(sky, {});
        double down = 0;
        for (std::size_t i = static_cast<std::size_t>(samples); i < f.lights.size(); ++i)
            down += static_cast<double>(f.lights[i].color.x) * f.lights[i].direction.y;
        EXPECT_NEAR(std::abs(down), num::pi, 0.06 * num::pi) << samples;
    }
}

TEST(ImageSkies, TheGradientThatStandsForOneHasItsLight) {
    for (const double azimuth : {0.0, 90.0}) {
        Sky sky;
        sky.kind = SkyKind::image;
        sky.image = panorama(azimuth, false);
        const FrameSky f = frame_sky(sky, {});
        const double expected = unoccluded_irradiance(sky_grid(*f.model, {}), {0, 1, 0}).x;
        const double got = num::pi * (static_cast<double>(f.shade.horizon[0]) / 3 +
                                      2 * static_cast<double>(f.shade.zenith[0]) / 3);
        EXPECT_NEAR(got, expected, 1e-3 * expected);
        EXPECT_NEAR(f.shade.ground[0], 0.02, 1e-4);
        EXPECT_GE(f.shade.horizon[0], 0);
        EXPECT_GE(f.shade.zenith[0], 0);
    }
}

TEST(ImageSkies, LightLevelGroundAsTheyAre) {
    Scene scene = empty_scene(9, 9);
    add(scene, plane(40, 40), 0);
    scene.camera.eye = {0, 2, 0.1};
    scene.camera.look_at = {0, 0, 0};
    scene.sky = Sky{};
    scene.sky.kind = SkyKind::image;
    scene.sky.image = panorama(40, false);
    scene.sky.samples = 64;
    const double expected = unoccluded_irradiance(sky_grid(*scene.sky.image), {0, 1, 0}).x;
    for (const bool occlusion : {false, true}) {
        scene.sky.occlusion = occlusion;
        scene.materials[0].base_color = {1, 1, 1};
        const Frame white = render_frame(scene);
        scene.materials[0].base_color = {0, 0, 0};
        const Frame black = render_frame(scene);
        const double got = static_cast<double>((pixel(white, 4, 4) - pixel(black, 4, 4)).x) * num::pi;
        // Let in, and out again; ambient light is let in whole.
        EXPECT_NEAR(got, 0.96 * (occlusion ? 0.96 : 1) * expected, 0.03 * expected) << occlusion;
    }
    // Another picture is another sky, whatever was kept.
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    const Vec3f before = pixel(frame, 4, 4);
    ImageSky dark = *scene.sky.image;
    for (Vec3f& p : dark.pixels.pixels)
        p = p * 0.5f;
    scene.sky.image = std::make_shared<const ImageSky>(std::move(dark));
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_NEAR(pixel(frame, 4, 4).x, 0.5f * before.x, 1e-3f * before.x);
}

TEST(SurfaceLight, ThinSheetsSendThroughWhatReachesTheirOtherSide) {
    Scene scene = empty_scene(16, 16);
    scene.materials[0].translucency = 0.25f;
    add(scene, plane(4, 4), 0);
    SceneLight sun = directional({0, -1, 0}, {1, 1, 1});
    sun.shadow.method = ShadowMethod::exact;
    scene.lights.push_back(sun);
    send_on(scene, 16, 1);
    const SurfaceLight light = surface_light(scene, frame_sky(scene.sky, {}), {}, nullptr);
    for (std::size_t i = 0; i < light.sent[0].size(); ++i) {
        const PatchMiddle middle = patch_middle(scene.mesh, light.patches, light.patches.patches[i]);
        EXPECT_NEAR(light.sent[0][i].x, (middle.n.y > 0 ? 0.75 : 0.25) / num::pi, 1e-5);
    }
}

TEST(SurfaceLight, SameForEveryIsaAndThreadCountAndCamera) {
    Scene scene = drawn_scene(2);
    SceneLight sun = directional({0.3, -1, 0.2}, {1, 2, 3});
    sun.shadow.method = ShadowMethod::exact;
    scene.lights.push_back(sun);
    scene.lights.push_back(at_point(LightKind::point, {1, 8, -0.7}, {0, -1, 0}, {5, 5, 5}));
    scene.lights.back().light.radius_m = 0.5;
    send_on(scene, 16, 2);
    const FrameSky sky = frame_sky(scene.sky, {});
    const SurfaceLight one = surface_light(scene, sky, {Isa::sse2, 1}, nullptr);
    for (const Isa isa : supported_isas()) {
        if (isa == Isa::ref) continue;
        const SurfaceLight other = surface_light(scene, sky, {isa, 3}, nullptr);
        for (std::size_t l = 0; l < one.sent.size(); ++l)
            ASSERT_EQ(other.sent[l], one.sent[l]) << isa_name(isa);
    }
}

TEST(SurfaceLight, TakesNoMoreThanItSays) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        const Scene scene = drawn_scene(seed);
        const SurfacePatches patches = surface_patches(scene.mesh);
        const auto bytes = static_cast<std::int64_t>(
            patches.patches.size() * (sizeof(SurfacePatch) + SurfaceLight::levels * sizeof(Vec3f)) +
            patches.triangles.size() * sizeof(TrianglePatches));
        EXPECT_LE(bytes, surface_light_bytes(size_of(scene.mesh)));
    }
}

TEST(SurfaceLight, StopsWhenCancelled) {
    Scene scene = drawn_scene(0);
    send_on(scene, 16, 1);
    const std::atomic<bool> cancel = true;
    EXPECT_TRUE(surface_light(scene, frame_sky(scene.sky, {}), {}, &cancel).empty());
}

TEST(SurfaceLight, NothingThatCastsSendsNothing) {
    Scene scene = drawn_scene(0);
    for (Object& o : scene.mesh.objects)
        o.casts_shadow = false;
    send_on(scene, 16, 1);
    EXPECT_FALSE(surface_light(scene, frame_sky(scene.sky, {}), {}, nullptr).empty());
    EXPECT_TRUE(render_frame(scene).complete);
}

}  // namespace
}  // namespace obscura
