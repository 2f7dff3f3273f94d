// Frames with exact shadows: the same bits however they are rendered, one answer together with trees, and
// work that follows the picture.

#include <gtest/gtest.h>

#include <memory>

#include "app/frame/exact_tile.h"
#include "app/frame/shadows.h"
#include "app/frame/tree_shadow.h"
#include "tests/frame/scenes.h"

namespace obscura {
namespace {

using namespace frame_scenes;

Scene exact_everything(int samples, bool orthographic = false) {
    Scene scene = everything(samples, orthographic);
    for (SceneLight& light : scene.lights)
        light.shadow.method = ShadowMethod::exact;
    return scene;
}

TEST(ExactFrame, SamePictureOnEveryIsaThreadCountAndCrop) {
    for (const int samples : {1, 4, 16})
        expect_one_picture(exact_everything(samples, samples == 1), {37, 21, 101, 77}, {Isa::ref, 1},
                           {1, 2, 5});
}

TEST(ExactFrame, ALightThatStaysKeepsItsCastersForOtherCameras) {
    Scene scene = exact_everything(1);
    FrameCache cache;
    Frame frame;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 1 + 6 + 1);
    scene.camera.eye = {-3, 1.5, 5};
    scene.lights[0].light.color = {1, 2, 3};
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 0);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
    scene.lights[2].light.position.x += 0.5;
    render_frame(scene, {}, {}, cache, frame);
    EXPECT_EQ(frame.stats.shadow_maps, 1);
    EXPECT_EQ(hash(frame), hash(render_frame(scene)));
}

/// A ground with a wall, and a ball over it that is somewhere else in every frame.
Scene wall_and_ball() {
    Scene scene = empty_scene(128, 96);
    add(scene, box({-4, -0.5, -4}, {4, 0, 4}), 0);
    add(scene, box({-1, 0, -1.2}, {1.5, 1.2f, -0.9f}), 0);
    add(scene, sphere(0.5, 32, 16), 0, {0.3f, 1.4f, 0.6f});
    scene.camera.eye = {2.5, 3.5, 4.5};
    scene.camera.look_at = {0, 0.4, 0};
    scene.lights.push_back(directional({-0.4, -1, 0.5}, {1, 1, 1}));
    return scene;
}

/// Only what stands still, or only what moves, casts shadows.
Mesh casters_of(const Mesh& mesh, bool moving) {
    Mesh part = mesh;
    for (std::size_t o = 0; o < part.objects.size(); ++o)
        part.objects[o].casts_shadow = (o + 1 == part.objects.size()) == moving;
    return part;
}

/// Visibility of the only light at every pixel.
std::vector<float> visibility_of(const TileScene& tiles) {
    const int width = tiles.view.width, height = tiles.view.height;
    std::vector<float> all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -1.0f);
    const auto work = std::make_unique<TileWork>();
    ExactTile exact(1);
    for (int row = 0; row < tiles.bins->rows; ++row) {
        for (int column = 0; column < tiles.bins->columns; ++column) {
            exact.run(tiles, column, row, 0, 1, 0, frame_tile_side, best_isa(), *work);
            for (int first = 0; first < frame_tile_side; first += block_rows) {
                exact.restore(0, *work);
                const TileRect tile{64 * column, 64 * row, 64, 64, 128, 128};
                block_surface(tiles, tile, first, best_isa(), *work);
                block_shade(tiles, {&exact, 0, first}, best_isa(), true, *work);
                for (int at = 0; at < block_samples; ++at) {
                    const int x = tile.x0 + at % 64, y = tile.y0 + first + at / 64;
                    const bool covered = (work->surface.covered[at / 16] >> (at % 16) & 1u) != 0;
                    if (x >= width || y >= height || !covered) continue;
                    all[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x)] = work->shadow_sum[at];
                }
            }
        }
    }
    return all;
}

TEST(ExactFrame, ATreeOfWhatStandsAndSamplesOfWhatMovesAreOneAnswer) {
    const Scene scene = wall_and_ball();
    FrameCache cache;
    FrameStats stats;
    const Exec exec;
    prepare_scene(scene, exec, cache, stats);
    TileScene tiles = prepare_tiles(scene, exec, cache);
    ASSERT_EQ(tiles.lights.size(), 1u);

    const Light& light = scene.lights[0].light;
    CasterScratch scratch;
    const auto everything_casts = build_casters(scene.mesh, light, exec, scratch);
    tiles.lights[0].exact = exact_light(light, everything_casts, scene.mesh, tiles.rays);
    const std::vector<float> alone = visibility_of(tiles);

    const Mesh still = casters_of(scene.mesh, false), moving = casters_of(scene.mesh, true);
    SceneLight tree_light = scene.lights[0];
    tree_light.shadow.method = ShadowMethod::compressed;
    tree_light.shadow.receivers = Receivers::any;
    tree_light.shadow.filter_px = 1;
    tree_light.shadow.resolution = 65536;
    LightShadow shadow;
    shadow.light = tree_light;
    shadow.casters = caster_box(still, light.direction);
    ASSERT_TRUE(build_light_trees(still, nullptr, exec, std::int64_t{1} << 31, shadow, nullptr));
    const auto ball = build_casters(moving, light, exec, scratch);
    EXPECT_EQ(ball[0].count + build_casters(still, light, exec, scratch)[0].count, everything_casts[0].count);
    tiles.lights[0].pcf = pcf_light(tree_light, std::span<const ShadowTree>(shadow.trees), scene.camera.eye);
    tiles.lights[0].exact = exact_light(light, ball, scene.mesh, tiles.rays);
    const std::vector<float> both = visibility_of(tiles);

    int dark = 0, different = 0;
    for (std::size_t i = 0; i < alone.size(); ++i) {
        dark += alone[i] == 0.0f;
        different += alone[i] != both[i];
    }
    EXPECT_GT(dark, 1000);
    // Outlines of the wall may fall elsewhere by a texel of the tree.
    EXPECT_LE(different, 6);
    tiles.lights[0].pcf.reset();
    const std::vector<float> ball_alone = visibility_of(tiles);
    int of_wall = 0;
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_LE(both[i], ball_alone[i]);
        of_wall += both[i] != ball_alone[i];
    }
    EXPECT_GT(of_wall, 100) << "the tree must have its share";
}

TEST(ExactFrame, WorkGrowsFarLessThanTriangles) {
    const auto work_of = [](int facets) {
        Scene scene = empty_scene(192, 144, 4);
        add(scene, box({-6, -0.5, -6}, {6, 0, 6}), 0);
        for (int i = 0; i < 9; ++i)
            add(scene, sphere(0.5, 2 * facets, facets), 0,
                {1.4f * static_cast<float>(i % 3 - 1), 0.8f, 1.4f * static_cast<float>(i / 3 - 1)});
        scene.camera.eye = {3, 4, 6};
        scene.camera.look_at = {0, 0.5, 0};
        scene.lights.push_back(directional({-0.4, -1, -0.5}, {1, 1, 1}));
        scene.lights[0].shadow.method = ShadowMethod::exact;
        const Frame frame = render_frame(scene);
        EXPECT_GT(frame.stats.exact.samples, 50'000);
        return std::pair(
            static_cast<double>(frame.stats.exact.groups) / static_cast<double>(frame.stats.exact.samples),
            static_cast<double>(frame.stats.exact.triangles) /
                static_cast<double>(frame.stats.exact.samples));
    };
    // 2,000 and 36,000 triangles: sixteen times as many, of which the sixteen samples of a bunch see more
    // each.
    const auto [few_groups, few_triangles] = work_of(8);
    const auto [many_groups, many_triangles] = work_of(32);
    RecordProperty("few",
                   std::to_string(few_groups) + " groups, " + std::to_string(few_triangles) + " triangles");
    RecordProperty("many",
                   std::to_string(many_groups) + " groups, " + std::to_string(many_triangles) + " triangles");
    EXPECT_LT(few_groups, 1.0);
    EXPECT_LT(many_groups, 4 * few_groups);
    EXPECT_LT(many_triangles, 10 * few_triangles);
}

}  // namespace
}  // namespace obscura
