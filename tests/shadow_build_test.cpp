// The construction from triangles against its definition: bottom-up over every texel's interval, bit for bit.

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "core/topology.h"
#include "hard_meshes.h"
#include "hierarchy/build.h"
#include "hierarchy/combine.h"
#include "raster/view.h"
#include "raster_solids.h"
#include "scenes/shapes.h"
#include "tree_compare.h"

namespace obscura {
namespace {

LightView oblique_view(const Mesh& mesh, int side) {
    return orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.31, -1, 0.23}), side);
}

/// All of them but the seconds.
std::vector<std::uint64_t> counts_of(const BuildStats& s) {
    return {s.nodes_visited,     s.certified_cover, s.certified_mesh,
            s.texels_rasterized, s.list_operations, s.facets};
}

void expect_equal(const Mesh& mesh, const LightView& view, Receivers receivers = Receivers::any) {
    BuildParams params;
    params.receivers = receivers;
    const MultiresTree expected = bottom_up_tree(mesh, view, receivers);
    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected));
    params.mesh_certificate = false;
    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected));
}

TEST(ShadowBuild, EqualsBottomUpOnRandomSolids) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 40, seed % 2 == 0, seed % 3 == 0);
        for (const int side : {1, 2, 8, 16, 64, 512}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", side " << side);
            expect_equal(mesh, oblique_view(mesh, side),
                         seed % 4 == 0 ? Receivers::static_only : Receivers::any);
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpStraightDown) {
    // Faces of constant depth, edge-on walls, coinciding faces.
    for (std::uint32_t seed = 20; seed <= 24; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 60, true, false);
        const LightView view = orthographic_light_view(bounds_of(mesh), {0, -1, 0}, 512);
        expect_equal(mesh, view);
        expect_equal(mesh, view, Receivers::static_only);
    }
}

TEST(ShadowBuild, EqualsBottomUpInPerspective) {
    for (std::uint32_t seed = 30; seed <= 34; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 50, seed % 2 == 0, false);
        for (const LightView& view :
             {perspective_light_view({0.5, 9, 0.3}, normalize(Vec3d{0.1, -1, 0.2}), 70, 0.1, 30, 512),
              perspective_light_view({0.2, 0.1, 0.3}, normalize(Vec3d{1, -0.2, 0.4}), 100, 0.05, 20, 256)}) {
            expect_equal(mesh, view);
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpOnSmoothMeshes) {
    // Many facets to a surface: the mesh certificate's own ground.
    Mesh mesh;
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> place(-3, 3);
    for (int i = 0; i < 7; ++i)
        solids::add(mesh, solids::shifted(sphere(1.2, 64, 32), {place(rng), place(rng), place(rng)}));
    for (const int side : {128, 1024, 2048})
        expect_equal(mesh, oblique_view(mesh, side));
}

TEST(ShadowBuild, StopsBeforeItGrowsTooLarge) {
    const Mesh mesh = solids::random_solids(5, 60, true, false);
    const LightView view = oblique_view(mesh, 1024);
    BuildParams params;
    params.max_nodes = build_shadow_tree(mesh, view, params, Exec{}).nodes.size();
    EXPECT_NO_THROW(build_shadow_tree(mesh, view, params, Exec{}));
    params.max_nodes /= 2;
    EXPECT_THROW(build_shadow_tree(mesh, view, params, Exec{}), LimitError);
}

TEST(ShadowBuild, SameBitsForEveryExec) {
    const Mesh mesh = solids::random_solids(5, 60, true, false);
    const LightView view = oblique_view(mesh, 1024);
    BuildStats expected_stats;
    std::vector<BuildSquare> expected_trace;
    BuildParams params;
    params.trace = &expected_trace;
    const MultiresTree expected = build_shadow_tree(mesh, view, params, {Isa::ref, 1}, &expected_stats);
    EXPECT_GT(expected_stats.certified_cover, 0u);
    EXPECT_GT(expected_stats.texels_rasterized, 0u);
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 2, 3, 7}) {
            BuildStats stats;
            std::vector<BuildSquare> trace;
            params.trace = &trace;
            EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, {isa, threads}, &stats), expected));
            EXPECT_EQ(counts_of(stats), counts_of(expected_stats));
            EXPECT_TRUE(std::equal(trace.begin(), trace.end(), expected_trace.begin(), expected_trace.end(),
                                   [](const BuildSquare& p, const BuildSquare& q) {
                                       return p.fate == q.fate && p.x0 == q.x0 && p.y0 == q.y0 &&
                                              p.side == q.side;
                                   }));
            EXPECT_EQ(trace.size(), stats.nodes_visited);
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpOverTheOracle) {
    // Nothing but the records of triangles is shared with the oracle; every instruction set, some threads.
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
        hard::Source source(seed);
        const Mesh mesh = source.mesh();
        const LightView view = source.view(mesh, 16 << source.pick(3));
        for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed);
            const Image<DepthInterval> intervals = oracle_intervals(mesh, view, receivers);
            const MultiresTree expected = build_bottom_up(intervals.view());
            BuildParams params;
            params.receivers = receivers;
            for (const Isa isa : supported_isas()) {
                for (const int threads : {1, 3}) {
                    const MultiresTree tree = build_shadow_tree(mesh, view, params, {isa, threads});
                    EXPECT_TRUE(same_tree(tree, expected));
                    const MultiresCounts counts = count_nodes(tree);
                    // A tree of one node has a leaf for a root, and no inner node.
                    EXPECT_EQ(counts.full + counts.empty, divided_squares(intervals));
                }
            }
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpOnHardMeshes) {
    const std::uint32_t seeds = slow_tests() ? 8000 : 160;
    for (std::uint32_t seed = 1000; seed < 1000 + seeds; ++seed) {
        hard::Source source(seed);
        const Mesh mesh = source.mesh();
        const LightView view = source.view(mesh, 16 << source.pick(5));
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        expect_equal(mesh, view);
        expect_equal(mesh, view, Receivers::static_only);
        if (HasFailure()) return;
    }
}

TEST(ShadowBuild, SameTreeHoweverTheWorkIsCut) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        hard::Source source(seed + 100);
        const Mesh mesh = source.mesh();
        const LightView view = source.view(mesh, 256);
        const MultiresTree expected = bottom_up_tree(mesh, view, Receivers::any);
        BuildParams params;
        for (const int block : {1, 2, 4, 8}) {
            for (const int tile : {1, 8, 32, 64}) {
                for (const int texels : {1, 16, 4096}) {
                    params.tuning.block_side = block;
                    params.tuning.tile_side = tile;
                    params.tuning.texels_per_facet = texels;
                    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected))
                        << "seed " << seed << ", block " << block << ", tile " << tile << ", " << texels;
                }
            }
        }
        params.tuning = {};
        for (const std::size_t open : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{100000}}) {
            for (const int smallest : {1, 16, 256}) {
                for (const std::size_t longest : {std::size_t{0}, std::size_t{3}, std::size_t{100000}}) {
                    params.tuning.open_squares = open;
                    params.tuning.smallest_task = smallest;
                    params.tuning.longest_surface = longest;
                    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected))
                        << "seed " << seed << ", open " << open << ", smallest " << smallest;
                }
            }
        }
    }
}

}  // namespace
}  // namespace obscura
