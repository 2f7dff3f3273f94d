// Eyes against cameras beside one another, against pictures that are merely shifted, and against themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/frame/frame_glare.h"
#include "app/pair/middle.h"
#include "tests/frame/stage.h"
#include "tests/pair/eyes.h"

namespace obscura {
namespace {

using namespace frame_scenes;
using namespace stereo_eyes;

// ---- Unedited eyes are cameras beside one another.

/// What a picture sees through pixel centres: triangle and world position.
struct SeenPoint {
    std::uint32_t triangle = nothing_seen;
    Vec3d position;
};
Image<SeenPoint> points_of(const TileScene& tiles, Vec3d eye) {
    Image<SeenPoint> points(tiles.view.width, tiles.view.height);
    const auto work = std::make_unique<TileWork>();
    for (std::size_t i = 0; i < tiles.bins->tiles(); ++i) {
        walk_tile(tiles, i, {128, 128}, best_isa(), *work, [&](int x, int y, int at) {
            const SurfaceBlock& s = work->surface;
            points(x, y) = {s.triangle[at], eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]})};
        });
    }
    return points;
}

struct Comparison {
    int both = 0, other = 0, lonely = 0;  ///< same triangle; another; another that is not near either
    double worst_px = 0, worst_depth = 0;
};

bool near_by(const Image<SeenPoint>& points, int x, int y, std::uint32_t triangle) {
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, points.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, points.width - 1); ++i)
            if (points(i, j).triangle == triangle) return true;
    }
    return false;
}

Comparison compare(const Image<SeenPoint>& eye, const Image<SeenPoint>& direct, int shift,
                   const Camera& camera, double focal_px) {
    const Basis basis = look_basis(camera.look_at - camera.eye, camera.up);
    const auto column = [&](Vec3d p) {
        return focal_px * dot(p - camera.eye, basis.right) / dot(p - camera.eye, basis.forward);
    };
    Comparison c;
    for (int y = 0; y < eye.height; ++y) {
        for (int x = 0; x < eye.width; ++x) {
            const SeenPoint &a = eye(x, y), &b = direct(x + shift, y);
            if (a.triangle != b.triangle) {
                ++c.other;
                c.lonely +=
                    !near_by(direct, x + shift, y, a.triangle) || !near_by(eye, x, y, b.triangle) ? 1 : 0;
            } else if (a.triangle != nothing_seen) {
                ++c.both;
                c.worst_px = std::max(c.worst_px, std::fabs(column(a.position) - column(b.position)));
                const double depth = axis_distance(camera, b.position);
                c.worst_depth =
                    std::max(c.worst_depth, std::fabs(axis_distance(camera, a.position) / depth - 1));
            }
        }
    }
    return c;
}

TEST(UneditedEyes, AreCamerasBesideOneAnother) {
    Scene scene = everything(1);
    add(scene, box({0.2, 3, 0.2}), 0, {1.6f, 1.5f, 3.0f});  // near the eyes
    add(scene, plane(60, 60, 2, 2), 0, {0, -0.01f, 0});     // through the near plane, behind the eyes
    for (const int offset : {8, 30}) {
        const StereoRig rig = rig_with_offset(scene, 0.09, offset);
        const DisparityLaw law = disparity_law(rig, scene.camera, scene.render.height);
        const EyePositions seen = unedited(scene, rig);
        for (const Eye eye : {Eye::left, Eye::right}) {
            const OneEye one(scene, rig, eye, eye == Eye::left ? seen.left : seen.right);
            const Scene direct = beside(scene, rig, eye, offset / 2);
            const Stage stage(direct);
            // Column X of the left eye shows X + offset / 2 of the left camera, which is `offset / 2` further
            // right in its wider picture.
            const int shift = eye == Eye::left ? offset : 0;
            const Comparison c =
                compare(points_of(one.tiles, scene.camera.eye), points_of(stage.tiles, direct.camera.eye),
                        shift, direct.camera, law.focal_px);
            EXPECT_GT(c.both, 20000);
            EXPECT_LT(c.worst_px, 0.02);
            EXPECT_LT(c.worst_depth, 2e-3);
            EXPECT_LE(c.other, c.both / 200);
            EXPECT_EQ(c.lonely, 0);
        }
    }
}

TEST(UneditedEyes, MapsTellTheRigsOwnDisparity) {
    const Scene scene = everything(1);
    const StereoRig rig = rig_with_offset(scene, 0.08, 10);
    const EyePositions seen = unedited(scene, rig);
    for (const Eye eye : {Eye::left, Eye::right}) {
        const OneEye one(scene, rig, eye, eye == Eye::left ? seen.left : seen.right);
        const EyeMap map = eye_map(scene, one.tiles, one.moved, rig, eye, {});
        int far = 0;
        for (std::size_t i = 0; i < map.disparity.pixels.size(); ++i) {
            far += std::fabs(map.disparity.pixels[i] - map.original.pixels[i]) > 0.02f ? 1 : 0;
            ASSERT_NEAR(map.disparity.pixels[i], map.original.pixels[i], 0.5f);
            if (map.triangle.pixels[i] == nothing_seen) {
                ASSERT_FLOAT_EQ(map.disparity.pixels[i], -10.0f);
            }
        }
        EXPECT_LE(far, 60);  // borders, where a corner snapped
        EXPECT_EQ(map.cracks, 0);
    }
}

// ---- Light: what both eyes share with the middle.

/// A wall head on whose disparity is a whole number of pixels, with things before it that shed shadows from
/// out of the picture.
struct Wall {
    Scene scene = everything(4);
    StereoRig rig;
    Wall() {
        scene.mesh = Mesh{};
        scene.materials[1].roughness = 0.15f;  // highlights that move with the viewer
        Mesh wall = box({16, 9, 1});
        add(scene, wall, 1, {0, 0, -6.5f});
        scene.camera.eye = {0, 0, 0};
        scene.camera.look_at = {0, 0, -1};
        scene.camera.vfov_deg = 40;
        scene.lights[0].light.direction = normalize(Vec3d{-0.3, -0.4, -1});
        scene.lights[1].light.position = {-1, 0.5, -4};
        scene.lights[2].light.position = {2, 2, -1};
        scene.lights[2].light.direction = normalize(Vec3d{-2, -2, -5});
        rig.interaxial_m = 0.5;
        // d(6) = scale (1 / 6 - 1 / zp) = 8.
        const double scale = disparity_law(rig, scene.camera, scene.render.height).scale;
        rig.zero_parallax_m = 1 / (1 / 6.0 - 8 / scale);
    }
};

TEST(EyesLight, CanBeTheMiddlesOwn) {
    const Wall wall;
    ASSERT_GT(wall.rig.zero_parallax_m, 6);
    EyesCache cache;
    EyeFrames eyes;
    EyesWanted wanted;
    wanted.shading = EyeShading::middle;
    wanted.middle_margin_px = 4;
    ASSERT_TRUE(render_eyes(wall.scene, unrefined(wall.scene), unedited(wall.scene, wall.rig), wall.rig,
                            wanted, 0, {}, cache, eyes));
    ASSERT_TRUE(eyes.middle);
    // All of the picture is wall: pixels are the middle's, four columns to the right or left.
    float brightest = 0;
    for (int y = 0; y < eyes.left.height; ++y) {
        for (int x = 0; x < eyes.left.width; ++x) {
            const Vec3f l = pixel(eyes.left, x, y), r = pixel(eyes.right, x, y);
            const Vec3f for_left = pixel(*eyes.middle, x - 4 + 4, y),
                        for_right = pixel(*eyes.middle, x + 4 + 4, y);
            ASSERT_NEAR(l.y, for_left.y, 1e-3f * (1 + for_left.y)) << x << " " << y;
            ASSERT_NEAR(r.y, for_right.y, 1e-3f * (1 + for_right.y)) << x << " " << y;
            brightest = std::max(brightest, l.y);
        }
    }
    EXPECT_GT(brightest, 1.0f);  // a highlight, which each camera of its own would see elsewhere
    const Frame direct = render_frame(beside(wall.scene, wall.rig, Eye::left, 0));
    float difference = 0;
    for (int y = 0; y < direct.height; ++y) {
        for (int x = 0; x < direct.width - 20; ++x) {
            const int at = x + static_cast<int>(
                                   std::lround(0.5 * disparity_law(wall.rig, wall.scene.camera, 130).offset));
            if (at >= direct.width) continue;
            difference = std::max(difference, std::fabs(pixel(direct, at, y).y - pixel(eyes.left, x, y).y));
        }
    }
    EXPECT_GT(difference, 0.2f);
}

TEST(EyesLight, SkyStandsAtInfinity) {
    Scene scene = empty_scene(96, 64, 4);
    scene.sky = Sky{};
    scene.camera = {CameraKind::perspective, {0, 1, 0}, {0, 1.2, -1}, {1, 1, 0}, 50, 10, 0.05};  // rolled
    const StereoRig rig = rig_with_offset(scene, 0.1, 12);
    EyesCache cache;
    EyeFrames eyes;
    EyesWanted wanted;
    wanted.middle_margin_px = 6;
    ASSERT_TRUE(render_eyes(scene, unrefined(scene), unedited(scene, rig), rig, wanted, 0, {}, cache, eyes));
    float low = 1, high = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 96; ++x) {
            ASSERT_NEAR(pixel(eyes.left, x, y).x, pixel(*eyes.middle, x + 6 + 6, y).x, 1e-4f);
            ASSERT_NEAR(pixel(eyes.right, x, y).x, pixel(*eyes.middle, x + 6 - 6, y).x, 1e-4f);
            low = std::min(low, pixel(eyes.left, x, y).x);
            high = std::max(high, pixel(eyes.left, x, y).x);
        }
    }
    EXPECT_GT(high - low, 0.1f);
}

Frame eye_picture(const Scene& scene, const StereoRig& rig, Eye eye, EyesCache& cache,
                  const Exec& exec = {}) {
    EyeFrames eyes;
    EXPECT_TRUE(render_eyes(scene, unrefined(scene), unedited(scene, rig), rig, {}, 0, exec, cache, eyes));
    return eye == Eye::left ? std::move(eyes.left) : std::move(eyes.right);
}

TEST(EyesLight, PartialShadowMapsHoldWhatBothEyesLookUp) {
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        Scene scene = staged(kind, false);
        scene.lights[0].shadow.resolution = 1024;
        const StereoRig rig = rig_with_offset(scene, 0.4, 30);  // much that the middle does not see
        for (const ShadowFilter filter : {ShadowFilter::pcf, ShadowFilter::hierarchical}) {
            scene.lights[0].shadow.filter = filter;
            EyesCache partial, whole;
            Scene full = scene;
            full.lights[0].shadow.scope = ShadowScope::full;
            for (const Eye eye : {Eye::left, Eye::right}) {
                EXPECT_EQ(hash(eye_picture(scene, rig, eye, partial)),
                          hash(eye_picture(full, rig, eye, whole)));
            }
            EXPECT_EQ(partial.frame.shadows[0].stats.scope, ShadowScope::frame);
            EXPECT_GT(partial.frame.shadows[0].stats.needed, 0);
        }
    }
}

TEST(EyesLight, ShadowsFollowEditsThoughTheCameraStays) {
    Scene scene = staged(LightKind::directional, false);
    const StereoRig rig = rig_with_offset(scene, 0.1, 10), wider = rig_with_offset(scene, 0.5, 30);
    EyesCache kept, fresh;
    eye_picture(scene, rig, Eye::left, kept);
    EXPECT_EQ(hash(eye_picture(scene, wider, Eye::left, kept)),
              hash(eye_picture(scene, wider, Eye::left, fresh)));
}

TEST(EyesLight, GlareIsAddedToEach) {
    Scene scene = everything(1);
    scene.materials[2].emission = {200, 180, 150};
    const StereoRig rig = rig_with_offset(scene, 0.08, 10);
    EyesCache cache;
    Frame plain = eye_picture(scene, rig, Eye::right, cache);
    scene.optics.enabled = true;
    scene.optics.shape.kind = ApertureKind::slit;
    scene.optics.mask_px = 64;
    scene.optics.f_number = 200;
    scene.optics.wavelengths = 5;
    scene.optics.radius_px = 20;
    const Frame glaring = eye_picture(scene, rig, Eye::right, cache);
    ASSERT_TRUE(glaring.stats.glare);
    EXPECT_GT(glaring.stats.glare->sources, 0);
    EXPECT_TRUE(glaring.stats.glare->kept);  // the left eye's pattern serves
    EXPECT_NE(hash(plain), hash(glaring));
    std::optional<KeptPsf> psf;
    add_frame_glare(scene, {}, {}, psf, plain);
    EXPECT_EQ(hash(plain), hash(glaring));
}

TEST(EyesLight, LampsAreHiddenFromTheLensOfEach) {
    // A lamp at 10 m, half behind a post at 3 m.
    Scene scene = empty_scene(96, 64);
    scene.materials.resize(2);
    scene.materials[1].emission = {500, 500, 500};
    add(scene, sphere(0.1, 48, 24), 1, {0, 0, -10});
    add(scene, box({0.03, 4, 0.03}), 0, {0.02f, 0, -3});
    scene.camera = {CameraKind::perspective, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 3.4, 10, 0.05};
    scene.optics.enabled = true;
    scene.optics.shape.kind = ApertureKind::circle;
    scene.optics.focal_length_mm = 400;
    scene.optics.mask_px = 32;
    scene.optics.wavelengths = 1;
    scene.optics.radius_px = 8;
    scene.optics.visibility = PupilVisibility::exact;
    // Infinity's disparity is a whole number of pixels each way, so that all pictures sample the lamp alike.
    const StereoRig rig = rig_with_offset(scene, 0.03, 4);
    EyesCache cache;
    EyeFrames eyes;
    ASSERT_TRUE(render_eyes(scene, unrefined(scene), unedited(scene, rig), rig, {}, 0, {}, cache, eyes));
    const auto blocked = [](const Frame& frame) { return frame.stats.glare->blocked; };
    const double left = blocked(render_frame(beside(scene, rig, Eye::left, 0))),
                 right = blocked(render_frame(beside(scene, rig, Eye::right, 0)));
    EXPECT_GT(std::fabs(left - right), 0.1 * left);
    EXPECT_NEAR(blocked(eyes.left), left, 0.01 * left);
    EXPECT_NEAR(blocked(eyes.right), right, 0.01 * right);
    EXPECT_EQ(eyes.left.shift_px.width, 0) << "channels that nobody wanted are gone";
}

// ---- Bits.

TEST(Eyes, SameBitsForAnyExec) {
    for (const int samples : {1, 4, 16}) {
        Scene scene = everything(samples);
        scene.render.width = 80;
        scene.render.height = 50;
        const StereoRig rig = rig_with_offset(scene, 0.2, 14);
        EyesCache first;
        const std::uint64_t expected = hash(eye_picture(scene, rig, Eye::left, first, {Isa::ref, 1}));
        for (const Isa isa : supported_isas()) {
            if (samples == 16 && isa != best_isa()) continue;
            EyesCache cache;
            EXPECT_EQ(hash(eye_picture(scene, rig, Eye::left, cache, {isa, 2})), expected)
                << samples << " " << isa_name(isa);
        }
    }
}

TEST(Eyes, CancelledPairsSaySo) {
    const Scene scene = everything(1);
    const std::atomic<bool> cancel = true;
    EyesWanted wanted;
    wanted.channels.cancel = &cancel;
    EyesCache cache;
    EyeFrames eyes;
    EXPECT_FALSE(render_eyes(scene, unrefined(scene), unedited(scene, {}), {}, wanted, 0, {}, cache, eyes));
}

}  // namespace
}  // namespace obscura
