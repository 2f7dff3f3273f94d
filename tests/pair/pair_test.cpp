// From a scene and its edits to two pictures: what the pictures show is what the map says.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "app/frame/memory.h"
#include "app/pair/pair.h"
#include "app/report/pair_notes.h"
#include "app/scene/build.h"
#include "core/error.h"
#include "tests/pair/eyes.h"

namespace obscura {
namespace {

using namespace frame_scenes;
using namespace stereo_eyes;

enum Part : std::uint32_t { floor_part, wall_part, ball_part, globe_part, post_part };

/// A room: floor, wall, two balls and a thin post, in this order of objects.
Scene room(int samples = 1) {
    Scene scene = empty_scene(240, 135, samples);
    scene.sky = Sky{};
    scene.materials.resize(3);
    scene.materials[1].base_color = {0.7f, 0.2f, 0.1f};
    scene.materials[1].roughness = 0.3f;
    scene.materials[2].texture = 0;
    scene.textures.push_back(checkerboard(64, 8));
    add(scene, plane(30, 30, 1, 1), 2, {0, 0, -8});
    add(scene, box({30, 4, 0.4}), 0, {0, 2, -9.2f});
    add(scene, sphere(0.8, 48, 24), 1, {-1.1f, 0.8f, -3});
    add(scene, sphere(0.7, 32, 16), 1, {1.2f, 1.3f, -5});
    add(scene, box({0.08, 2.5, 0.08}), 0, {0.15f, 1.25f, -2.2f});
    scene.camera = {CameraKind::perspective, {0, 1.4, 1.5}, {0, 1.1, -5}, {0, 1, 0}, 42, 10, 0.05};
    scene.lights.push_back(directional({-0.5, -1, -0.7}, {2.5f, 2.4f, 2.2f}, 3));
    return scene;
}

StereoSettings plain_settings() {
    StereoSettings s;
    s.rig.interaxial_m = 0.12;
    s.rig.zero_parallax_m = 5;
    return s;
}

StereoEdit edit_of(const char* name, std::variant<RoundnessEdit, AnchorEdit, InterfaceEdit, MatchEdit> what) {
    StereoEdit edit;
    edit.name = name;
    edit.what = std::move(what);
    return edit;
}

/// Rounder, flatter, nearer, all at once.
StereoSettings edited_settings() {
    StereoSettings s = plain_settings();
    s.edits.push_back(edit_of("round", RoundnessEdit{{{ball_part}, {}}, 2.0}));
    s.edits.push_back(edit_of("flat", RoundnessEdit{{{globe_part}, {}}, 0.2}));
    s.edits.push_back(edit_of("near", AnchorEdit{{{ball_part}, {}}, 2.5}));
    s.edits.push_back(edit_of("far", AnchorEdit{{{wall_part}, {}}, -2}));
    return s;
}

StereoPair pair_of(const Scene& scene, const StereoSettings& settings, const Exec& exec = {}) {
    StereoCache cache;
    StereoPair pair;
    render_stereo_pair(scene, settings, {}, exec, cache, pair);
    return pair;
}

TEST(StereoPair, WithoutEditsIsWhatTheRigSees) {
    const Scene scene = room();
    const StereoSettings settings = plain_settings();
    const StereoPair pair = pair_of(scene, settings);
    ASSERT_TRUE(pair.complete);
    // But for the last bits: gradients are rounded, so the map's own system has a residual.
    for (std::size_t i = 0; i < pair.optimised.pixels.size(); ++i)
        ASSERT_NEAR(pair.optimised.pixels[i], pair.view.disparity.pixels[i], 2e-5f);
    EXPECT_EQ(pair.moved.mesh.triangles.size(), scene.mesh.triangles.size());
    EXPECT_GT(pair.view.margin_px, 4);
    EXPECT_EQ(pair.realised.error.share(), 1);
    EXPECT_LT(pair.realised.error.max_px, 0.01);
    EXPECT_GT(pair.realised.error.pixels, 25000);

    EyesCache cache;
    EyeFrames eyes;
    ASSERT_TRUE(render_eyes(scene, unrefined(scene), unedited(scene, settings.rig), settings.rig, {}, 0, {},
                            cache, eyes));
    int differ = 0;
    for (int y = 0; y < 135; ++y) {
        for (int x = 0; x < 240; ++x)
            differ += std::fabs(pixel(eyes.left, x, y).y - pixel(pair.eyes.left, x, y).y) > 1e-3f;
    }
    EXPECT_LE(differ, 10);  // vertices of other rounding

    StereoSettings as_print = settings;
    as_print.shading = EyeShading::middle;
    EXPECT_NE(hash(pair_of(scene, as_print).eyes.left), hash(pair.eyes.left));
}

void expect_faithful(const StereoPair& pair) {
    ASSERT_TRUE(pair.complete);
    EXPECT_GE(pair.realised.error.share(), 0.999);
    EXPECT_GE(pair.left_error.share(), 0.995);
    EXPECT_GE(pair.right_error.share(), 0.995);
    EXPECT_GT(pair.left_error.pixels, 20000);
    EXPECT_EQ(pair.eyes.left_map.cracks, 0);
    EXPECT_EQ(pair.eyes.right_map.cracks, 0);
}

TEST(StereoPair, ShowsTheEditedMap) {
    const StereoPair pair = pair_of(room(), edited_settings());
    expect_faithful(pair);
    EXPECT_TRUE(pair.solution.report.converged);
    EXPECT_GT(pair.moved.mesh.triangles.size(), room().mesh.triangles.size());
    // The edits did something.
    float most = 0;
    for (std::size_t i = 0; i < pair.optimised.pixels.size(); ++i)
        most = std::max(most, std::fabs(pair.optimised.pixels[i] - pair.view.disparity.pixels[i]));
    EXPECT_GT(most, 1.5f);
}

TEST(StereoPair, ShowsMapsOfLowerResolution) {
    for (const int scale : {2, 4}) {
        StereoSettings settings = edited_settings();
        settings.map_scale = scale;
        const StereoPair pair = pair_of(room(), settings);
        EXPECT_EQ(pair.solution.disparity.width, (pair.view.width() + scale - 1) / scale);
        EXPECT_EQ(pair.optimised.width, pair.view.width());
        expect_faithful(pair);
    }
}

TEST(StereoPair, ShowsOneCurveForAll) {
    StereoSettings settings = edited_settings();
    settings.map_scale = 4;
    settings.remap.kind = RemapKind::linear;
    settings.remap.nearest_px = 2;
    settings.remap.farthest_px = -2;
    const StereoPair pair = pair_of(room(), settings);
    expect_faithful(pair);
    for (std::size_t i = 0; i < pair.optimised.pixels.size(); ++i) {
        if (pair.view.triangle.pixels[i] == nothing_seen) continue;
        ASSERT_LT(pair.optimised.pixels[i], 2.001f);
        ASSERT_GT(pair.optimised.pixels[i], -2.001f);
    }
}

TEST(RealisedDisparity, NoticesWhatIsOff) {
    const Scene scene = room();
    const StereoSettings settings = plain_settings();
    StereoCache cache;
    StereoPair pair;
    render_stereo_pair(scene, settings, {}, {}, cache, pair);
    // The map says half a pixel more than the pictures show.
    DisparityMap other = pair.optimised;
    for (float& d : other.pixels)
        d += 0.5f;
    RasterScratch scratch;
    const RealisedDisparity realised = realised_disparity(
        scene, pair.moved, cache.eyes.left, cache.eyes.right, pair.view, other, 0.1, {}, scratch);
    EXPECT_EQ(realised.error.within, 0);
    EXPECT_NEAR(realised.error.rms_px, 0.5, 0.01);
    EXPECT_NEAR(picture_error(pair.eyes.left_map, Eye::left, pair.view, other, 0.1).rms_px, 0.5, 0.02);
}

TEST(StereoPair, SameBitsForAnyExec) {
    const Scene scene = room();
    const StereoSettings settings = edited_settings();
    const StereoPair expected = pair_of(scene, settings, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 2}) {
            if (isa != best_isa() && threads == 1) continue;
            const StereoPair pair = pair_of(scene, settings, {isa, threads});
            EXPECT_EQ(pair.optimised, expected.optimised) << isa_name(isa);
            EXPECT_EQ(pair.moved.change_px, expected.moved.change_px) << isa_name(isa);
            EXPECT_EQ(hash(pair.eyes.left), hash(expected.eyes.left)) << isa_name(isa);
            EXPECT_EQ(hash(pair.eyes.right), hash(expected.eyes.right)) << isa_name(isa);
            EXPECT_EQ(pair.realised.error.rms_px, expected.realised.error.rms_px) << isa_name(isa);
        }
    }
}

TEST(StereoPair, NoFrameDependsOnThoseBefore) {
    Scene scene = room();
    StereoCache cache, fresh;
    StereoPair pair, alone;
    StereoPairOptions options;
    options.pictures = false;
    render_stereo_pair(scene, edited_settings(), options, {}, cache, pair);
    scene.camera.eye.x += 0.05;
    render_stereo_pair(scene, edited_settings(), options, {}, cache, pair);
    render_stereo_pair(scene, edited_settings(), options, {}, fresh, alone);
    EXPECT_FALSE(pair.warm);
    EXPECT_EQ(pair.optimised, alone.optimised);
}

TEST(StereoPair, StaticSurfacesStaySteady) {
    Scene scene = room();
    StereoSettings settings = edited_settings();
    settings.warm_start = true;
    StereoCache cache;
    StereoPair pair;
    StereoPairOptions options;
    options.pictures = false;
    render_stereo_pair(scene, settings, options, {}, cache, pair);
    EXPECT_FALSE(pair.temporal);
    EXPECT_FALSE(pair.warm);
    EXPECT_TRUE(pair.eyes.left.radiance.pixels.size() == 0);
    // Nothing moves: nothing changes.
    render_stereo_pair(scene, settings, options, {}, cache, pair);
    ASSERT_TRUE(pair.temporal);
    EXPECT_TRUE(pair.warm);
    EXPECT_LT(pair.temporal->error.max_px, 0.05);
    EXPECT_GT(pair.temporal->error.pixels, 20000);
    // The camera takes a step: what is static hardly does.
    scene.camera.eye.x += 0.02;
    scene.camera.look_at.x += 0.02;
    render_stereo_pair(scene, settings, options, {}, cache, pair);
    EXPECT_GT(pair.temporal->error.pixels, 20000);
    EXPECT_LT(pair.temporal->error.rms_px, 0.1);
    EXPECT_GE(pair.temporal->error.share(), 0.98);
    // An edit that changes shows.
    StereoSettings other = settings;
    std::get<AnchorEdit>(other.edits[2].what).offset_px = 0;
    render_stereo_pair(scene, other, options, {}, cache, pair);
    EXPECT_GT(pair.temporal->error.max_px, 1);
}

TEST(StereoPair, RefusesWhatItCannotDo) {
    Scene scene = room();
    scene.camera.kind = CameraKind::orthographic;
    EXPECT_THROW(pair_of(scene, plain_settings()), UsageError);
    scene = room();
    scene.limits.memory_mib = 8;
    EXPECT_THROW(pair_of(scene, plain_settings()), LimitError);
    EXPECT_LT(stereo_bytes(scene, plain_settings()), stereo_bytes(scene, plain_settings(), 1000000));
    StereoSettings wide = plain_settings();
    wide.margin_px = 500;
    EXPECT_LT(stereo_bytes(scene, plain_settings()), stereo_bytes(scene, wide));
}

TEST(StereoNotes, CountOnlyWishesThatHaveAName) {
    StereoPair pair;
    pair.solution.report.converged = true;
    Unsatisfied wish;
    pair.solution.report.unsatisfied.push_back(wish);  // gradients: no edit's wish
    wish.name = "near";
    for (int i = 0; i < 8; ++i)
        pair.solution.report.unsatisfied.push_back(wish);
    EXPECT_EQ(stereo_notes(pair, plain_settings()).size(), 8u);
    for (int i = 0; i < 3; ++i)
        pair.solution.report.unsatisfied.push_back(wish);
    const std::vector<std::string> notes = stereo_notes(pair, plain_settings());
    ASSERT_EQ(notes.size(), 9u);
    EXPECT_EQ(notes.back(), "and 3 more edits are not");
}

TEST(StereoPair, CutsNoMoreTrianglesThanFit) {
    Scene scene = room();
    scene.render.width = 160;
    scene.render.height = 90;
    StereoSettings settings = edited_settings();
    settings.margin_px = 8;
    settings.reproject.tolerance_px = 1e-3;
    const StereoPair free = pair_of(scene, settings);
    const auto all = static_cast<std::int64_t>(free.moved.mesh.triangles.size());
    // Room for the picture and the guess of triangles, not for what such a tolerance asks.
    scene.limits.memory_mib = ((estimate_memory(scene).total() + stereo_bytes(scene, settings)) >> 20) + 1;
    ASSERT_GT(stereo_bytes(scene, settings, all), stereo_bytes(scene, settings) + (3 << 20));
    StereoCache cache;
    StereoPair pair;
    EXPECT_THROW(render_stereo_pair(scene, settings, {}, {}, cache, pair), LimitError);
    const auto cut = static_cast<std::int64_t>(pair.moved.mesh.triangles.size());
    EXPECT_LT(estimate_memory(scene).total() + stereo_bytes(scene, settings, cut),
              (scene.limits.memory_mib << 20) + (1 << 19));
}

TEST(StereoPair, StopsWhenAsked) {
    const std::atomic<bool> cancel = true;
    StereoPairOptions options;
    options.channels.cancel = &cancel;
    StereoCache cache;
    StereoPair pair;
    render_stereo_pair(room(), plain_settings(), options, {}, cache, pair);
    EXPECT_FALSE(pair.complete);
}

}  // namespace
}  // namespace obscura
