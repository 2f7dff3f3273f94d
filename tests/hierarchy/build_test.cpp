// The construction from triangles against its definition: bottom-up over every texel's interval, bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>
#include <random>

#include "core/error.h"
#include "core/topology.h"
#include "hierarchy/build.h"
#include "hierarchy/combine.h"
#include "raster/coverage.h"
#include "raster/view.h"
#include "scenes/shapes.h"
#include "tests/hierarchy/hard_meshes.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/raster/raster_solids.h"

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
    const std::uint32_t seeds = slow_tests() ? 1000 : 160;
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

/// The recursion at its simplest, for any formula of depth: a square is decided when every triangle near it
/// covers its four corner texels, in one order with room to spare; K is then taken from the corners.
class CornerTree {
  public:
    using DepthAt = float (*)(const TriangleRecord& t, int x, int y);
    using Quadtree = MultiresBuilder<2>;

    CornerTree(std::vector<TriangleRecord> records, DepthAt depth)
        : records_(std::move(records)), depth_(depth) {}

    Quadtree::Part build(int x0, int y0, int side, const std::vector<std::uint32_t>& from) {
        if (side == 1) return Quadtree::texel(interval_of(crossings(from, x0, y0), Receivers::any));
        std::vector<std::uint32_t> list;
        for (const std::uint32_t i : from) {
            if (reaches(records_[i], x0, y0, side)) list.push_back(i);
        }
        if (const auto common = decide(x0, y0, side, list)) {
            decided += !list.empty() && side > 2;
            return Quadtree::texel(*common);
        }
        const int half = side / 2;
        const Quadtree::Part child[4] = {build(x0, y0, half, list), build(x0 + half, y0, half, list),
                                         build(x0, y0 + half, half, list),
                                         build(x0 + half, y0 + half, half, list)};
        return tree.join(child);
    }
    MultiresTree whole(int side) {
        std::vector<std::uint32_t> all(records_.size());
        std::iota(all.begin(), all.end(), 0u);
        const Quadtree::Part root = build(0, 0, side, all);
        MultiresTree result;
        result.levels = std::countr_zero(static_cast<unsigned>(side));
        result.root = MultiresNode(stored_depth(root.interval), root.kinds, root.first_child);
        result.root_interval = root.interval;
        result.nodes = tree.nodes;
        return result;
    }
    /// The definition with the same formula of depth.
    MultiresTree bottom_up(int side) const {
        std::vector<std::uint32_t> all(records_.size());
        std::iota(all.begin(), all.end(), 0u);
        Image<DepthInterval> map(side, side);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x)
                map(x, y) = interval_of(crossings(all, x, y), Receivers::any);
        }
        return build_bottom_up(map.view());
    }
    int decided = 0;
    Quadtree tree;

  private:
    /// Not when all four corner texels lie outside one of its edges.
    static bool reaches(const TriangleRecord& t, int x0, int y0, int side) {
        for (int k = 0; k < 3; ++k) {
            const EdgeFunction e = edge_function(t, k);
            int outside = 0;
            for (int c = 0; c < 4; ++c)
                outside +=
                    e.at((x0 + c % 2 * (side - 1)) * 256 + 128, (y0 + c / 2 * (side - 1)) * 256 + 128) < 0;
            if (outside == 4) return false;
        }
        return true;
    }
    DepthInterval interval_of(const std::vector<LayerCrossing>& c, Receivers receivers) const {
        return c.empty() ? DepthInterval{} : obscura::interval_of(c, receivers);
    }
    std::vector<LayerCrossing> crossings(const std::vector<std::uint32_t>& list, int x, int y) const {
        std::vector<LayerCrossing> c;
        for (const std::uint32_t i : list) {
            if (covers(records_[i], x, y))
                c.push_back({depth_(records_[i], x, y), records_[i].crossing, records_[i].triangle});
        }
        std::sort(c.begin(), c.end(), comes_before);
        return c;
    }
    std::optional<DepthInterval> decide(int x0, int y0, int side,
                                        const std::vector<std::uint32_t>& list) const {
        DepthInterval common{0, 1};
        std::vector<std::uint32_t> order;
        for (int k = 0; k < 4; ++k) {
            const auto c = crossings(list, x0 + k % 2 * (side - 1), y0 + k / 2 * (side - 1));
            if (c.size() != list.size()) return {};
            std::vector<std::uint32_t> here;
            for (std::size_t i = 0; i < c.size(); ++i) {
                if (i > 0 && c[i].depth - c[i - 1].depth < 1e-5f) return {};
                here.push_back(c[i].triangle);
            }
            if (k > 0 && here != order) return {};
            order = here;
            const DepthInterval interval = interval_of(c, Receivers::any);
            common = {std::max(common.entry, interval.entry), std::min(common.exit, interval.exit)};
        }
        if (common.entry > common.exit) return {};
        return common;
    }

    std::vector<TriangleRecord> records_;
    DepthAt depth_;
};

float plane_depth(const TriangleRecord& t, int x, int y) {
    return depth_at(t, x + 0.5, y + 0.5);
}

/// The mean of the corners' depths by the areas across from them, in float: not monotone along a row.
float barycentric_depth(const TriangleRecord& t, int x, int y) {
    const auto area = [](double ax, double ay, double bx, double by, double cx, double cy) {
        return static_cast<float>((bx - ax) * (cy - ay) - (cx - ax) * (by - ay));
    };
    double X[3], Y[3];
    float z[3];
    for (int k = 0; k < 3; ++k) {
        X[k] = t.x[k] / 256.0;
        Y[k] = t.y[k] / 256.0;
        z[k] = depth_at(t, X[k], Y[k]);
    }
    const double px = x + 0.5, py = y + 0.5;
    const float all = area(X[0], Y[0], X[1], Y[1], X[2], Y[2]);
    const float u = area(px, py, X[1], Y[1], X[2], Y[2]) / all;
    const float v = area(X[0], Y[0], px, py, X[2], Y[2]) / all;
    const float depth = u * z[0] + v * z[1] + (1 - u - v) * z[2];
    return std::max(std::min(depth, t.zmax), t.zmin);
}

TEST(ShadowBuild, NeedsTheOneFormulaOfDepth) {
    // The negative control: corners decide squares because depth is monotone in x and in y. Interpolated
    // from a triangle's corners it is not, and the recursion no longer equals the bottom-up construction.
    int differ = 0;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        // Slabs above each other, with faces of many texels.
        Mesh mesh;
        for (int i = 0; i < 3; ++i) {
            const Mesh slab = box({6.0 - i, 0.2, 5.0 - i});
            solids::add(mesh,
                        solids::shifted(solids::moved(slab, solids::rotation({0.1, 1, 0.02 * seed}, 0.3 * i)),
                                        {0.1 * i, 1.5 * i, 0}));
        }
        const LightView view =
            orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.1 * seed, -1, 0.07}), 128);
        const std::vector<TriangleRecord> records = records_of(mesh, view);
        CornerTree planes(records, plane_depth), interpolated(records, barycentric_depth);
        const MultiresTree expected = planes.bottom_up(128);
        EXPECT_TRUE(same_tree(planes.whole(128), expected));
        EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, {}, Exec{}), expected));
        EXPECT_GT(planes.decided, 50);
        differ += !same_tree(interpolated.whole(128), interpolated.bottom_up(128));
    }
    EXPECT_GE(differ, 2);
}

}  // namespace
}  // namespace obscura
