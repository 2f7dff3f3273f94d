// The same bits from every kernel, thread count, crop and order of frames.

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "app/frame/memory.h"
#include "app/frame/shadows.h"
#include "app/scene/build.h"
#include "tests/frame/scenes.h"
#include "tests/frame/undefined.h"

namespace obscura {
namespace {

using namespace frame_scenes;

class EveryIsa : public testing::TestWithParam<bool> {};

TEST_P(EveryIsa, StagesAgreeWithTheReferenceBitForBit) {
    const Scene scene = everything(4, GetParam());
    FrameCache cache;
    FrameStats stats;
    const Exec exec;
    prepare_scene(scene, exec, cache, stats);
    TileScene tiles = prepare_tiles(scene, exec, cache);
    prepare_shadows(scene, 0, exec, cache, tiles, stats);
    const auto expected = std::make_unique<TileWork>(), actual = std::make_unique<TileWork>();
    std::int64_t blocks = 0, textured = 0, thin = 0, open = 0;
    for (int tile_row = 0; tile_row < tiles.bins->rows; ++tile_row) {
        for (int column = 0; column < tiles.bins->columns; ++column) {
            for (int row = 0; row < frame_tile_side; row += block_rows) {
                for (const Isa isa : supported_isas()) {
                    TileWork& work = isa == Isa::ref ? *expected : *actual;
                    std::memset(static_cast<void*>(&work), 0, sizeof work);
                    const TileRect tile =
                        tile_visibility(tiles, column, tile_row, tiles.pattern[1], best_isa(), work);
                    block_surface(tiles, tile, row, isa, work);
                    block_shade(tiles, {}, isa, true, work);
                    forget_undefined(work.surface);
                    forget_undefined(work.surface, work.shade);
                    ASSERT_EQ(0, std::memcmp(&expected->surface, &work.surface, sizeof work.surface))
                        << isa_name(isa) << " surface, tile " << column << "," << tile_row << " row " << row;
                    ASSERT_EQ(0, std::memcmp(&expected->shade, &work.shade, sizeof work.shade))
                        << isa_name(isa) << " shade, tile " << column << "," << tile_row << " row " << row;
                    ASSERT_EQ(0, std::memcmp(expected->shadow_sum, work.shadow_sum, sizeof work.shadow_sum))
                        << isa_name(isa) << " visibility, tile " << column << "," << tile_row;
                }
                ++blocks;
                for (int g = 0; g < block_groups; ++g) {
                    textured += expected->surface.textured[g] != 0;
                    thin += expected->surface.thin[g] != 0;
                    open += expected->surface.open[g] != 0;
                }
            }
        }
    }
    // The scene did ask every question.
    EXPECT_GT(blocks, 100);
    EXPECT_GT(textured, 100);
    EXPECT_GT(thin, 10);
    EXPECT_GT(open, 100);
}
INSTANTIATE_TEST_SUITE_P(Cameras, EveryIsa, testing::Bool());

TEST(FrameDeterminism, SamePictureOnEveryIsaThreadCountAndCrop) {
    for (const int samples : {1, 4})
        expect_one_picture(everything(samples), {37, 21, 101, 77}, {Isa::ref, 1}, {1, 2, 3, 7});
}

TEST(FrameDeterminism, HoursOfSunAreThoseOfTheWhole) {
    // The scalar reference asks every triangle for every pixel and sun: a small picture of two tiles.
    Scene scene = everything(1);
    scene.render.width = 72;
    scene.render.height = 40;
    SceneLight& sun = scene.lights.emplace_back();
    sun.light.kind = LightKind::sun;
    sun.light.below_horizon = true;
    sun.light.path = SunPath{2026, 6, 21, 1, 0, 24, 48.2, 15, 3};
    // Only the lens's margin matters: nothing is so bright that it needs the pattern, which takes seconds.
    scene.optics.margin_px = 7;
    scene.optics.clip = 1e9;
    FrameOptions options;
    options.sun_hours = true;
    const Frame whole = render_frame(scene, options, {Isa::ref, 1});
    options.crop = {17, 11, 45, 27};
    for (const bool lens : {false, true}) {
        // Glare takes the picture with a margin, whose tiles lie elsewhere.
        scene.optics.enabled = lens;
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 3}) {
                // The reference has drawn the whole.
                if (isa == Isa::ref) continue;
                const Frame part = render_frame(scene, options, {isa, threads});
                ASSERT_EQ(part.sun_hours.width, 45);
                ASSERT_EQ(part.sun_hours.height, 27);
                for (int y = 0; y < part.height; ++y)
                    ASSERT_EQ(0, std::memcmp(part.sun_hours.row(y), &whole.sun_hours(17, y + 11),
                                             sizeof(float) * 45))
                        << isa_name(isa) << ", " << threads << " threads, row " << y
                        << (lens ? ", lens" : "");
            }
        }
    }
}

TEST(FrameDeterminism, KeptMapsGiveTheSamePictureAsNewOnes) {
    Scene scene = everything(1);
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 1 + 6 + 1);

    // Another camera and another colour: every map stays.
    scene.camera.eye = {-3, 1.5, 5};
    scene.lights[0].light.color = {1, 2, 3};
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 0);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));

    // A light that moves gets a new map, the others keep theirs.
    scene.lights[2].light.position.x += 0.5;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 1);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
}

TEST(FrameDeterminism, DoubledLightDoublesThePictureExactly) {
    Scene scene = everything(1);
    const Frame once = render_frame(scene);
    for (SceneLight& light : scene.lights)
        light.light.color = light.light.color * 2.0f;
    for (Material& material : scene.materials)
        material.emission = material.emission * 2.0f;
    for (Vec3f* sky : {&scene.sky.zenith, &scene.sky.horizon, &scene.sky.ground})
        *sky = *sky * 2.0f;
    const Frame twice = render_frame(scene);
    for (int y = 0; y < once.height; ++y) {
        for (int x = 0; x < once.width; ++x)
            ASSERT_EQ(pixel(twice, x, y), pixel(once, x, y) * 2.0f) << x << "," << y;
    }
}

TEST(FrameDeterminism, CancelStopsAndProgressEndsAtOne) {
    Scene scene = everything(1);
    FrameOptions options;
    double last = 0;
    int calls = 0;
    options.progress = [&](double share) {
        EXPECT_GT(share, last);
        last = share;
        ++calls;
    };
    EXPECT_TRUE(render_frame(scene, options).complete);
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(calls, 3);
    scene.lights[0].light.path = SunPath{2026, 6, 21, 1, 0, 24, 48.2, 15, 144};
    options.sun_hours = true;
    last = 0;
    EXPECT_TRUE(render_frame(scene, options).complete);
    EXPECT_EQ(last, 1.0);
    std::atomic<bool> cancel = true;
    options.cancel = &cancel;
    EXPECT_FALSE(render_frame(scene, options).complete);
}

TEST(FrameDeterminism, MemoryIsCheckedBeforeTheWork) {
    Scene scene = everything(1);
    scene.lights[1].shadow.resolution = 16384;
    scene.limits.memory_mib = 4096;
    EXPECT_GT(estimate_memory(scene).total(), std::int64_t{6} * 16384 * 16384 * 4);
    EXPECT_THROW(render_frame(scene), LimitError);
}

}  // namespace
}  // namespace obscura
