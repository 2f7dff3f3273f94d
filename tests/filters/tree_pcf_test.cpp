// Filtering on trees: shared = naive = the dense map's filter, bit for bit, wherever the kernel lies.

#include "filters/tree_pcf.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <tuple>

#include "app/frame/scene_light.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/facet/facet.h"
#include "raster/view.h"
#include "tests/filters/tree_pcf_samples.h"
#include "tests/frame/scenes.h"
#include "tests/hierarchy/code_cases.h"

namespace obscura {
namespace {

using Visibility = std::vector<float>;

template <class Run>
Visibility visibility_of(const std::vector<SurfaceBlock>& blocks, Run&& run) {
    Visibility v(blocks.size() * block_samples);
    for (std::size_t b = 0; b < blocks.size(); ++b)
        run(blocks[b], v.data() + b * block_samples);
    return v;
}

Visibility by_map(const std::vector<SurfaceBlock>& blocks, const PcfLight& light) {
    return visibility_of(blocks, [&](const SurfaceBlock& s, float* v) { ref::pcf_block(s, light, v); });
}

/// First difference of every instruction set, naive and shared, to `expected`.
void expect_all(const std::vector<SurfaceBlock>& blocks, const PcfLight& light, const Visibility& expected,
                const std::string& what) {
    for (const Isa isa : supported_isas()) {
        const Visibility naive = visibility_of(blocks, [&](const SurfaceBlock& s, float* v) {
            OBSCURA_DISPATCH(isa, naive_tree_pcf_block, s, light, v);
        });
        const Visibility shared = visibility_of(
            blocks, [&](const SurfaceBlock& s, float* v) { OBSCURA_DISPATCH(isa, pcf_block, s, light, v); });
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto bits = std::bit_cast<std::uint32_t>(expected[i]);
            ASSERT_EQ(std::bit_cast<std::uint32_t>(naive[i]), bits)
                << what << ", naive, " << isa_name(isa) << ", sample " << i << ": " << naive[i] << " not "
                << expected[i];
            ASSERT_EQ(std::bit_cast<std::uint32_t>(shared[i]), bits)
                << what << ", shared, " << isa_name(isa) << ", sample " << i << ": " << shared[i] << " not "
                << expected[i];
        }
    }
}

int between_light_and_dark(const Visibility& v) {
    return static_cast<int>(std::count_if(v.begin(), v.end(), [](float f) { return f > 0 && f < 1; }));
}

struct ChosenMap {
    MultiresTree tree;
    StoredDepths map;
};

StoredDepths dense_map(const MultiresTree& tree, int size) {
    return chosen::dense(size, [&](int x, int y) {
        return value_at(tree, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    });
}

ChosenMap chosen_map(int size, std::uint32_t seed) {
    ChosenMap m;
    m.tree = build_bottom_up(chosen::patchy_intervals(size, seed).view());
    m.map = dense_map(m.tree, size);
    return m;
}

/// Side of the map, and of the kernel.
class TreePcf : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(TreePcf, EqualsTheDenseMapAtEveryAlignmentAndBorder) {
    const auto [size, side] = GetParam();
    const ChosenMap m = chosen_map(size, 7);
    for (const bool parallel : {true, false}) {
        for (const float tilt : {0.0f, 0.02f}) {
            const std::vector<SurfaceBlock> blocks =
                chosen::blocks_at(chosen::places_everywhere(size, 3), tilt, 4);
            PcfLight dense = chosen::light_above(size, side, parallel), light = dense;
            for (const CodeCase& row : code_cases) {
                ShadowTree tree = encode_tree(m.tree, {}, params_of(row));
                const StoredDepths map = dense_map(tree_behind(tree, m.tree), size);
                dense.view[0].stored = map.depth.data();
                const Visibility expected = by_map(blocks, dense);
                if (side > 1 && size > 4) {
                    EXPECT_GT(between_light_and_dark(expected), 20);
                }
                for (const int top : {0, 2}) {
                    set_top_grid(tree, top);
                    light.view[0].tree = &tree.code;
                    expect_all(blocks, light, expected, row.name);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(DenseKernels, TreePcf,
                         testing::Combine(testing::Values(4, 8, 32), testing::Values(1, 3, 5)),
                         [](const auto& one) {
                             return std::to_string(std::get<0>(one.param)) + "_" +
                                    std::to_string(std::get<1>(one.param));
                         });

class TreePcfKernels : public testing::TestWithParam<int> {};

TEST_P(TreePcfKernels, OfAnyOddSideAreTheMeanOfTheirTaps) {
    const int side = GetParam();
    const ChosenMap m = chosen_map(32, 9);
    const ShadowTree tree = encode_tree(m.tree, {});
    PcfLight light = chosen::light_above(32, side, true);
    light.view[0].tree = &tree.code;
    const std::vector<SurfaceBlock> blocks = chosen::blocks_at(chosen::places_everywhere(32, 5), 0.01f, 6);
    const Visibility expected = visibility_of(
        blocks, [&](const SurfaceBlock& s, float* v) { ref::naive_tree_pcf_block(s, light, v); });
    EXPECT_GT(between_light_and_dark(expected), 500);
    EXPECT_GT(std::count(expected.begin(), expected.end(), 1.0f), 100);
    expect_all(blocks, light, expected, "side " + std::to_string(side));
    // The definition itself, of a level receiver: the box of side - 1 texels around it.
    const Visibility level = by_map(chosen::blocks_at({{16.25f, 15.5f, 0.6f}}, 0, 1), light);
    double sum = 0, weights = 0;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const int reach = side / 2, x = 16 + i - reach, y = 15 + j - reach;
            const double wx = i == 0 ? 0.75 : (i == side - 1 ? 0.25 : 1),
                         wy = j == 0 || j == side - 1 ? 0.5 : 1;
            weights += wx * wy;
            sum += m.map.at(x, y) >= 0.6f ? wx * wy : 0;
        }
    }
    EXPECT_EQ(weights, (side - 1.0) * (side - 1));
    EXPECT_NEAR(static_cast<double>(level[0]), sum / weights, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sides, TreePcfKernels, testing::Values(7, 9, 11, 13, 15));

/// Surfaces of a picture, four rows at a time.
std::vector<SurfaceBlock> surfaces_of(const Scene& scene) {
    FrameCache cache;
    FrameStats stats;
    prepare_scene(scene, Exec{}, cache, stats);
    const TileScene tiles = prepare_tiles(scene, Exec{}, cache);
    std::vector<SurfaceBlock> blocks;
    const auto work = std::make_unique<TileWork>();
    for (int row = 0; row * frame_tile_side < scene.render.height; ++row) {
        for (int column = 0; column * frame_tile_side < scene.render.width; ++column) {
            const TileRect tile = tile_visibility(tiles, column, row, tiles.pattern[0], best_isa(), *work);
            for (int y = 0; y < frame_tile_side; y += block_rows) {
                block_surface(tiles, tile, y, best_isa(), *work);
                blocks.push_back(work->surface);
            }
        }
    }
    return blocks;
}

/// A box and a ball on the ground, before a light of this kind that has no shadows of its own.
Scene solids_before(LightKind kind) {
    Scene scene = frame_scenes::empty_scene(128, 64);
    frame_scenes::add(scene, box({-4, -0.5, -4}, {4, 0, 4}), 0);
    frame_scenes::add(scene, box({-1.6f, 0, -0.6f}, {-0.6f, 1.4f, 0.5f}), 0);
    frame_scenes::add(scene, sphere(0.7, 16, 9), 0, {0.7f, 0.9f, 0.2f});
    scene.camera.eye = {1.5, 3, 5};
    scene.camera.look_at = {0, 0.3, 0};
    SceneLight light = kind == LightKind::directional
                           ? frame_scenes::directional({0.6, -1, -0.3}, {1, 1, 1}, 3, 256)
                           : frame_scenes::at_point(kind, {0.2, 2.6, 1.4}, {-0.1, -1, -0.5}, {1, 1, 1});
    light.light.outer_cone_deg = 70;
    light.shadow.method = ShadowMethod::none;
    scene.lights.push_back(light);
    return scene;
}

TEST(TreePcfScenes, LightsOfEveryKindSeeWhatTheirDenseMapsShow) {
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        Scene scene = solids_before(kind);
        frame_scenes::add(scene, plane(1.5, 1.5), 0, {1.8f, 1.0f, 1.3f});
        SceneLight light = scene.lights[0];
        const std::vector<SurfaceBlock> blocks = surfaces_of(scene);
        ShadowMap map;
        map.views = shadow_views(light, bounds_of(scene.mesh));
        std::vector<ShadowTree> trees;
        for (std::size_t i = 0; i < map.views.size(); ++i) {
            const MultiresTree tree = build_bottom_up(interval_map(scene.mesh, map.views[i], {}, {}).view());
            // Views may have different codes and layouts.
            trees.push_back(
                encode_tree(tree, map.views[i], params_of(code_cases[i % std::size(code_cases)])));
            map.stored.push_back(dense_map(tree_behind(trees.back(), tree), map.views[i].width));
        }
        for (const int side : {1, 3, 5}) {
            light.shadow.filter_px = side;
            const Visibility expected = by_map(blocks, pcf_light(light, map, scene.camera.eye));
            const auto lit = std::count(expected.begin(), expected.end(), 1.0f);
            EXPECT_GT(lit, 1000);
            EXPECT_GT(std::count(expected.begin(), expected.end(), 0.0f), 300);
            const PcfLight by_trees = pcf_light(light, trees, scene.camera.eye);
            expect_all(blocks, by_trees, expected, "light " + std::to_string(static_cast<int>(kind)));

            // A trace tells the same, and that sharing saves steps.
            long naive = 0, shared = 0;
            for (std::size_t i = 0; i < expected.size(); i += 61) {
                const SurfaceBlock& block = blocks[i / block_samples];
                const auto at = static_cast<int>(i % block_samples);
                const ref::PcfTrace trace = ref::trace_pcf(block, by_trees, at);
                EXPECT_EQ(trace.visibility, expected[i]);
                const ref::PcfSteps steps = ref::pcf_steps(block, by_trees, at);
                EXPECT_EQ(steps.naive, trace.steps.naive);
                EXPECT_LE(steps.shared, steps.naive);
                naive += steps.naive;
                shared += steps.shared;
            }
            EXPECT_GT(naive, 0);
            EXPECT_LE((side == 1 ? 1 : 3) * shared, naive) << "side " << side;
        }
    }
}

/// Where values vary within a leaf, each tap has its own: what lookups of single texels find, level by level.
TEST(TreePcfScenes, PlanesAndEdgesAreFilteredTexelByTexel) {
    for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
        const Scene scene = solids_before(kind);
        SceneLight light = scene.lights[0];
        const std::vector<SurfaceBlock> blocks = surfaces_of(scene);
        ShadowMap map;
        map.views = shadow_views(light, bounds_of(scene.mesh));
        std::vector<ShadowTree> trees;
        std::uint64_t planes = 0, edges = 0;
        for (const LightView& view : map.views) {
            BuildParams params;
            params.receivers = Receivers::static_only;
            trees.push_back(facet_from_mesh(scene.mesh, view, params, {}, nullptr, nullptr));
            planes += facet_stats(trees.back()).planes;
            edges += facet_stats(trees.back()).edges;
            map.stored.push_back(chosen::dense(view.width, [&](int x, int y) {
                return tree_value(trees.back().code, static_cast<std::uint32_t>(x),
                                  static_cast<std::uint32_t>(y));
            }));
        }
        EXPECT_GT(planes, 3u);
        EXPECT_GT(edges, 3u);
        for (const int side : {1, 3, 5}) {
            light.shadow.filter_px = side;
            const Visibility expected = by_map(blocks, pcf_light(light, map, scene.camera.eye));
            EXPECT_GT(std::count(expected.begin(), expected.end(), 1.0f), 1000);
            EXPECT_GT(std::count(expected.begin(), expected.end(), 0.0f), 300);
            expect_all(blocks, pcf_light(light, std::span<const ShadowTree>(trees), scene.camera.eye),
                       expected, "facet, light " + std::to_string(static_cast<int>(kind)));
        }
        // Coarser levels: shared as naive, every instruction set as ref.
        light.shadow.filter_px = 3;
        PcfLight by_trees = pcf_light(light, std::span<const ShadowTree>(trees), scene.camera.eye);
        filter_hierarchically(by_trees, camera_rays(scene.camera, 32, 16));
        const Visibility expected = visibility_of(
            blocks, [&](const SurfaceBlock& s, float* v) { ref::naive_tree_pcf_block(s, by_trees, v); });
        expect_all(blocks, by_trees, expected, "facet, by levels");
    }
}

}  // namespace
}  // namespace obscura
