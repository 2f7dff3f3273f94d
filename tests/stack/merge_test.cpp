// The octree of a stack, merged from its maps' certain squares, is that of the bottom-up construction over
// all texels.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "hierarchy/build.h"
#include "hierarchy/stack/build_tree.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/stack/stack_oracle.h"

namespace obscura {
namespace {

using oracle::Maps;
using oracle::same_octree;

StackTree merged(const Maps& maps, std::vector<int> anisotropies, const Exec& exec = {},
                 StackTreeStats* stats = nullptr) {
    StackTreeParams params;
    params.anisotropies = std::move(anisotropies);
    params.count_quadtrees = true;
    int levels = 0;
    while (1 << levels < maps[0].width)
        ++levels;
    return build_stack_tree(
        static_cast<int>(maps.size()), levels,
        [&](int k) { return oracle::certain_tree_of(maps[static_cast<std::size_t>(k)]); }, params, exec,
        stats);
}

void expect_oracle(const Maps& maps, int first_anisotropy, int last_anisotropy) {
    for (int a = first_anisotropy; a <= last_anisotropy; ++a) {
        const StackTree ours = merged(maps, {a});
        EXPECT_TRUE(same_octree(ours.tree, oracle::BottomUpStack(maps, ours.shape).tree))
            << "anisotropy " << a;
    }
}

TEST(CertainTree, GivesTheTreeOfDepths) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const Maps maps = oracle::drawn_maps(seed, 32, 1, 1 << (seed % 3), 0);
        EXPECT_TRUE(
            same_tree(multires_of(oracle::certain_tree_of(maps[0])), build_bottom_up(maps[0].view())));
        const Mesh mesh = solids::random_solids(seed, 30, seed % 2 == 0, seed % 3 == 0);
        for (const LightView& view : oracle::turning_views(mesh, 128, 2, 0.1)) {
            for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
                BuildParams params;
                params.receivers = receivers;
                const CertainTree tree = build_certain_tree(mesh, view, params, Exec{});
                EXPECT_TRUE(same_tree(multires_of(tree), build_shadow_tree(mesh, view, params, Exec{})));
            }
        }
    }
}

TEST(StackTree, EqualsBottomUpOverDrawnMaps) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const int side = 2 << (seed % 4), count = 1 + static_cast<int>(seed * 5 % 19);
        expect_oracle(oracle::drawn_maps(seed, side, count, 1 + static_cast<int>(seed % 2), 90), -5, 4);
    }
    expect_oracle(oracle::drawn_maps(20, 1, 9, 1, 50), -4, 0);
    expect_oracle(oracle::drawn_maps(21, 32, 32, 2, 97), 0, 2);
    expect_oracle(oracle::drawn_maps(22, 4, 64, 1, 95), -6, 2);
}

TEST(StackTree, EqualsBottomUpOverSolids) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const bool open = seed % 2 == 0;
        const Mesh mesh = solids::random_solids(seed, 25, open, seed == 3);
        const Maps cube = oracle::interval_maps(mesh, oracle::turning_views(mesh, 32, 32, 0.01),
                                                seed > 2 ? Receivers::static_only : Receivers::any);
        expect_oracle(cube, seed == 1 ? -5 : -2, seed == 1 ? 5 : 1);
    }
    const Mesh mesh = solids::random_solids(9, 40, true, false);
    const Maps maps =
        oracle::interval_maps(mesh, oracle::turning_views(mesh, 128, 64, 0.002), Receivers::any);
    for (const int a : {0, 3, 7})
        expect_oracle(maps, a, a);
}

/// From triangles, not from texels.
TEST(StackTree, EqualsBottomUpFromTriangles) {
    const Mesh mesh = solids::random_solids(5, 40, true, false);
    const std::vector<LightView> views = oracle::turning_views(mesh, 128, 16, 0.004);
    const Maps maps = oracle::interval_maps(mesh, views, Receivers::any);
    for (const int a : {-2, 0, 1, 3, 7}) {
        StackTreeParams params;
        params.anisotropies = {a};
        BuildParams of_map;
        of_map.detail_height = std::max(a, 0);
        const StackTree ours = build_stack_tree(
            16, 7,
            [&](int k) {
                return build_certain_tree(mesh, views[static_cast<std::size_t>(k)], of_map,
                                          Exec{best_isa(), 1});
            },
            params, Exec{});
        EXPECT_TRUE(same_octree(ours.tree, oracle::BottomUpStack(maps, ours.shape).tree)) << a;
    }
}

/// Cubes of N maps, of which only some are there, as the paper fills them up.
TEST(StackShape, PlaceholdersAreAxesThatAreNotDivided) {
    for (const int count : {1, 2, 3, 4, 8, 13}) {
        const Maps maps = oracle::drawn_maps(static_cast<std::uint32_t>(count), 16, count, 2, 90);
        const MultiresTree cube = build_bottom_up<3>(4, [&](const std::array<std::uint32_t, 3>& at) {
            return at[2] < maps.size() ? maps[at[2]](static_cast<int>(at[0]), static_cast<int>(at[1]))
                                       : DepthInterval{0.0f, 1.0f};
        });
        EXPECT_TRUE(same_octree(merged(maps, {0}).tree, cube)) << count;
    }
    // More maps than texels a side: the cube is filled up with placeholders beside the maps.
    const Maps maps = oracle::drawn_maps(77, 4, 16, 1, 90);
    const MultiresTree cube = build_bottom_up<3>(4, [&](const std::array<std::uint32_t, 3>& at) {
        return at[0] < 4 && at[1] < 4 ? maps[at[2]](static_cast<int>(at[0]), static_cast<int>(at[1]))
                                      : DepthInterval{0.0f, 1.0f};
    });
    EXPECT_TRUE(same_octree(merged(maps, {0}).tree, cube));
}

TEST(StackTree, TheCheapestAnisotropyIsTaken) {
    const Maps maps = oracle::drawn_maps(3, 16, 16, 1, 97);
    StackTreeStats stats;
    const StackTree best = merged(maps, {0, 1, 2, -1, -2, 9, 4}, {}, &stats);
    ASSERT_EQ(stats.trials.size(), 6u) << "9 is 4, which is there once";
    std::uint64_t least = UINT64_MAX;
    for (const StackTrial& trial : stats.trials) {
        const MultiresTree oracle_tree = oracle::BottomUpStack(maps, {4, 4, trial.anisotropy}).tree;
        EXPECT_EQ(trial.bytes, word_bytes(count_nodes(oracle_tree))) << trial.anisotropy;
        least = std::min(least, trial.bytes);
    }
    EXPECT_EQ(word_bytes(count_nodes(best.tree)), least);
    EXPECT_NE(stats.trials[0].bytes, stats.trials[4].bytes);
    MultiresCounts quadtrees;
    for (const Image<DepthInterval>& map : maps) {
        const MultiresCounts c = count_nodes(build_bottom_up(map.view()));
        quadtrees.full += c.full;
        quadtrees.empty += c.empty;
        quadtrees.leaf += c.leaf;
    }
    EXPECT_EQ(stats.quadtrees, quadtrees);
}

TEST(StackTree, GivesUpWhatGetsTooLarge) {
    const Maps maps = oracle::drawn_maps(3, 16, 13, 1, 50);
    const std::size_t nodes = merged(maps, {1}).tree.nodes.size();
    StackTreeParams params;
    params.anisotropies = {1};
    const auto build = [&](std::uint64_t most) {
        params.max_nodes = most;
        return build_stack_tree(
            13, 4, [&](int k) { return oracle::certain_tree_of(maps[static_cast<std::size_t>(k)]); }, params,
            Exec{});
    };
    EXPECT_EQ(build(nodes).tree.nodes.size(), nodes);
    EXPECT_THROW(build(nodes - 1), LimitError);
    EXPECT_THROW(build(0), LimitError);
}

TEST(StackTree, NoMapIsMadeThatNobodyWaitsFor) {
    const Maps maps = oracle::drawn_maps(3, 16, 64, 1, 50);
    StackTreeParams params;
    params.anisotropies = {0, 1};
    std::atomic<bool> cancel{false};
    std::atomic<int> made{0};
    const auto one = [&](int k) {
        if (++made == 10) cancel = true;
        return oracle::certain_tree_of(maps[static_cast<std::size_t>(k)]);
    };
    EXPECT_NO_THROW(build_stack_tree(64, 4, one, params, Exec{best_isa(), 1}, nullptr, &cancel));
    EXPECT_EQ(made, 10);
}

TEST(StackTree, IsTheSameForAnyThreads) {
    const Maps maps = oracle::drawn_maps(8, 16, 21, 1, 95);
    const StackTree one = merged(maps, {0, 1, -1}, Exec{best_isa(), 1});
    for (const int threads : {2, 7}) {
        const StackTree many = merged(maps, {0, 1, -1}, Exec{best_isa(), threads});
        EXPECT_TRUE(same_tree(one.tree, many.tree)) << threads;
        EXPECT_EQ(one.shape, many.shape);
    }
}

}  // namespace
}  // namespace obscura
