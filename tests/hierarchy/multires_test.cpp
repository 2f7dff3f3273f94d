// The hierarchy against its definition: losslessness, the corollary of inner nodes, known small cases.

#include <gtest/gtest.h>

#include "hierarchy/combine.h"
#include "hierarchy/multires.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/hierarchy/tree_samples.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

Image<DepthInterval> scene_intervals(std::uint32_t seed, int side, bool open) {
    const Mesh mesh = solids::random_solids(seed, 40, open, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), side);
    return interval_map(mesh, view, {}, Exec{});
}

void expect_lossless(const MultiresTree& tree, const Image<DepthInterval>& map) {
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const float value = value_at(tree, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
            ASSERT_TRUE(contains(map(x, y), value)) << x << "," << y << ": " << value << " not in ["
                                                    << map(x, y).entry << ", " << map(x, y).exit << "]";
        }
    }
}

TEST(Combine, TakesTheFirstOfTheMostStabbedMinima) {
    // Two pairs overlap equally often: the pair whose minimum comes first in child order wins.
    const DepthInterval tie[4] = {{0.5f, 0.6f}, {0.1f, 0.2f}, {0.15f, 0.3f}, {0.55f, 0.7f}};
    const Combined c = combine(tie);
    EXPECT_EQ(c.covered, 0b0110u | 0u) << "0.15 stabs children 1 and 2 and is met before 0.55";
    EXPECT_EQ(c.interval, (DepthInterval{0.15f, 0.2f}));
    const DepthInterval apart[4] = {{0.4f, 0.5f}, {0.1f, 0.2f}, {0.6f, 0.7f}, {0.8f, 0.9f}};
    EXPECT_EQ(combine(apart), (Combined{{0.4f, 0.5f}, 1u}));
    const DepthInterval touching[4] = {{0.1f, 0.5f}, {0.5f, 0.9f}, {0.2f, 0.5f}, {0.5f, 0.5f}};
    EXPECT_EQ(combine(touching), (Combined{{0.5f, 0.5f}, 15u}));
}

TEST(Combine, WorksForEightChildren) {
    DepthInterval eight[8];
    for (int i = 0; i < 8; ++i)
        eight[i] = {0.1f * static_cast<float>(i), 0.1f * static_cast<float>(i) + 0.25f};
    const Combined c = combine(eight);
    EXPECT_EQ(c.covered, 0b111u);
}

TEST(Multires, EveryTexelFindsADepthOfItsInterval) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        for (const Image<DepthInterval>& map :
             {scene_intervals(seed, 256, seed % 2 == 0), random_interval_map(seed, 128)}) {
            expect_lossless(build_bottom_up(map.view()), map);
            expect_lossless(build_top_down(map.view()), map);
        }
    }
}

TEST(Multires, InnerNodesAreExactlyTheSquaresWithoutACommonDepth) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        for (const Image<DepthInterval>& map :
             {scene_intervals(seed, 256, seed % 2 == 0), random_interval_map(seed, 64)}) {
            const MultiresCounts counts = count_nodes(build_bottom_up(map.view()));
            EXPECT_EQ(counts.full + counts.empty, divided_squares(map));
        }
    }
}

TEST(Multires, AnEmptySceneIsOneNode) {
    const Image<DepthInterval> background(64, 64);
    for (const MultiresTree& tree : {build_bottom_up(background.view()), build_top_down(background.view())}) {
        EXPECT_EQ(count_nodes(tree), (MultiresCounts{0, 0, 1}));
        EXPECT_EQ(value_at(tree, 5, 9), 1.0f);
    }
}

TEST(Multires, ConstructionsAreCloseInSize) {
    // The paper finds the two comparable; the sweep sees more at once, so it may not be much larger.
    const Image<DepthInterval> map = scene_intervals(3, 512, false);
    const auto size = [](const MultiresCounts& c) { return 2 * c.full + c.empty + c.leaf; };
    const auto up = size(count_nodes(build_bottom_up(map.view())));
    const auto down = size(count_nodes(build_top_down(map.view())));
    EXPECT_LT(down, up + up / 4);
    EXPECT_LT(up, down + down / 4);
}

TEST(Multires, StacksOfMapsAreOctrees) {
    // A sun that moves: 16 maps of 16 x 16 texels.
    const Mesh mesh = solids::random_solids(9, 30, false, false);
    std::vector<Image<DepthInterval>> maps;
    for (int i = 0; i < 16; ++i) {
        const Vec3d direction = normalize(Vec3d{0.3 + 0.02 * i, -1, 0.2});
        maps.push_back(
            interval_map(mesh, orthographic_light_view(bounds_of(mesh), direction, 16), {}, Exec{}));
    }
    const IntervalSource<3> source = [&](const std::array<std::uint32_t, 3>& at) {
        return maps[at[2]](static_cast<int>(at[0]), static_cast<int>(at[1]));
    };
    std::uint64_t flat = 0;
    for (const Image<DepthInterval>& map : maps)
        flat += build_bottom_up(map.view()).nodes.size() + 1;
    for (const MultiresTree& tree : {build_bottom_up<3>(4, source), build_top_down<3>(4, source)}) {
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const std::array<std::uint32_t, 3> at{i % 16, i / 16 % 16, i / 256};
            ASSERT_TRUE(contains(source(at), value_at<3>(tree, at))) << i;
        }
        EXPECT_LT(tree.nodes.size(), flat) << "maps that change little share nodes";
    }
}

}  // namespace
}  // namespace obscura
