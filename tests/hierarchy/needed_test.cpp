// Trees of only what some lookups need: what they look up is as good as in the whole tree.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hierarchy/build.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/query.h"
#include "hierarchy/combine.h"
#include "tests/hierarchy/hard_meshes.h"
#include "tests/hierarchy/region_oracle.h"
#include "tests/hierarchy/tree_compare.h"

namespace obscura {
namespace {

struct Wanted {
    int x, y, level;
    bool texels;
};

NeededNodes needed_of(const std::vector<Wanted>& wanted) {
    NeededNodes needed;
    for (const Wanted& w : wanted) {
        const auto x = static_cast<std::uint32_t>(w.x), y = static_cast<std::uint32_t>(w.y);
        w.texels ? needed.add_texels(x, y, w.level) : needed.add(x, y, w.level);
    }
    needed.finish();
    return needed;
}

MultiresTree tree_of(const Mesh& mesh, const LightView& view, const std::vector<Wanted>& wanted,
                     Receivers receivers, const Exec& exec = {}) {
    const NeededNodes needed = needed_of(wanted);
    BuildParams params;
    params.needed = &needed;
    params.receivers = receivers;
    return build_shadow_tree(mesh, view, params, exec);
}

/// Squares of every size, alone, in heaps and inside each other.
std::vector<Wanted> random_wanted(hard::Source& source, int levels) {
    std::vector<Wanted> wanted;
    const int count = 1 + source.pick(source.chance(30) ? 300 : 12);
    for (int i = 0; i < count; ++i) {
        const int level = source.chance(60) ? 0 : source.pick(source.chance(20) ? levels + 1 : 4);
        const int squares = 1 << (levels - level);
        int x = source.pick(squares), y = source.pick(squares);
        if (!wanted.empty() && source.chance(40)) {  // near or inside the one before
            x = std::min((wanted.back().x << wanted.back().level) >> level, squares - 1);
            y = std::min((wanted.back().y << wanted.back().level) >> level, squares - 1);
        }
        wanted.push_back({x, y, level, level == 0 || (level < levels && source.chance(30))});
    }
    return wanted;
}

/// What the whole construction gives a square.
DepthInterval square_interval(const Image<DepthInterval>& map, const Wanted& w) {
    const int side = 1 << w.level;
    Image<DepthInterval> part(side, side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            part(x, y) = map((w.x << w.level) + x, (w.y << w.level) + y);
    }
    return build_bottom_up(part.view()).root_interval;
}

float looked_up(const ShadowTree& tree, int x, int y, int level) {
    float value = -1;
    OBSCURA_DISPATCH(Exec{}.isa, stored_values, tree.code, &x, &y, 1, level, &value);
    return value;
}

TEST(NeededNodes, WhatIsNeededIsAsInTheWholeTree) {
    std::size_t values = 0, smaller = 0;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        hard::Source source(seed + 5000);
        const Mesh mesh = source.mesh();
        const int levels = 4 + source.pick(5);
        const LightView view = source.view(mesh, 1 << levels);
        const Receivers receivers = source.chance(50) ? Receivers::any : Receivers::static_only;
        const std::vector<Wanted> wanted = random_wanted(source, levels);
        const MultiresTree part = tree_of(mesh, view, wanted, receivers);
        const ShadowTree tree = encode_tree(part, view);
        IntervalParams params;
        params.receivers = receivers;
        const Image<DepthInterval> map = interval_map(mesh, view, params, Exec{});
        smaller += part.nodes.size() < build_bottom_up(map.view()).nodes.size();
        for (const Wanted& w : wanted) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << w.x << "," << w.y << " level "
                                              << w.level << (w.texels ? " texels" : ""));
            if (!w.texels) {
                const float value = looked_up(tree, w.x << w.level, w.y << w.level, w.level);
                ASSERT_TRUE(contains(square_interval(map, w), value)) << value;
                ++values;
                continue;
            }
            for (int i = 0; i < 1 << (2 * w.level); ++i) {
                const int side = 1 << w.level, x = w.x * side + i % side, y = w.y * side + i / side;
                ASSERT_TRUE(contains(map(x, y), looked_up(tree, x, y, 0))) << x << "," << y;
            }
        }
    }
    EXPECT_GT(values, 200u);
    EXPECT_GT(smaller, 20u) << "trees of few squares should be smaller than whole ones";
}

TEST(NeededNodes, EverythingNeededIsTheWholeTree) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        hard::Source source(seed + 6000);
        const Mesh mesh = source.mesh();
        const LightView view = source.view(mesh, 32);
        const MultiresTree whole = bottom_up_tree(mesh, view, Receivers::any);
        EXPECT_TRUE(same_tree(tree_of(mesh, view, {{0, 0, 5, true}}, Receivers::any), whole));
        // The same, named texel by texel, and by quadrants.
        std::vector<Wanted> texels, quadrants;
        for (int i = 0; i < 32 * 32; ++i)
            texels.push_back({i % 32, i / 32, 0, true});
        for (int i = 0; i < 4; ++i)
            quadrants.push_back({i % 2, i / 2, 4, true});
        EXPECT_TRUE(same_tree(tree_of(mesh, view, texels, Receivers::any), whole));
        EXPECT_TRUE(same_tree(tree_of(mesh, view, quadrants, Receivers::any), whole));
    }
}

TEST(NeededNodes, NothingNeededIsOneNode) {
    hard::Source source(1);
    const Mesh mesh = source.mesh();
    const LightView view = source.view(mesh, 128);
    const MultiresTree tree = tree_of(mesh, view, {}, Receivers::any);
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_EQ(tree.root.kinds, 0u);
}

TEST(NeededNodes, ASquaresValueBringsNothingBelowIt) {
    const Mesh mesh = solids::random_solids(8, 60, false, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), 256);
    const MultiresTree whole = build_shadow_tree(mesh, view, {}, Exec{});
    const MultiresTree root = tree_of(mesh, view, {{0, 0, 8, false}}, Receivers::any);
    EXPECT_TRUE(root.nodes.empty());
    EXPECT_EQ(root.root_interval, whole.root_interval);
    EXPECT_LE(tree_of(mesh, view, {{3, 2, 5, false}}, Receivers::any).nodes.size(), 3u * 4);
}

/// A view of the largest map that sees a piece of the scene: much of it lies off the map, to the guard band
/// and beyond.
LightView close_view(hard::Source& source, const Mesh& mesh) {
    const Vec3d centre = source.point(), reach = Vec3d{1, 1, 1} * std::pow(10.0, source.uniform(-3, 0.8));
    const Vec3d way = normalize(Vec3d{source.uniform(-1, 1), -1, source.uniform(-1, 1)});
    if (source.chance(30))
        return perspective_light_view(centre, way, source.uniform(1, 140), 0.01, 40, 1 << 20);
    if (source.chance(30)) return orthographic_light_view(bounds_of(mesh), way, 1 << 20);
    return orthographic_light_view({centre - reach, centre + reach}, way, 1 << 20);
}

TEST(NeededNodes, HardMeshesOnTheLargestMap) {
    // 64 x 64 texels here and there against the rasterizer's tiles, some of them against the slow oracle.
    const std::uint32_t seeds = slow_tests() ? 300 : 60;
    std::size_t compared = 0, seen = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        hard::Source source(seed + 9000);
        const Mesh mesh = source.mesh();
        const LightView view = close_view(source, mesh);
        std::vector<std::pair<int, int>> at;
        std::vector<Wanted> wanted;
        for (int i = 0; i < 12; ++i) {
            const Triangle& t =
                mesh.triangles[static_cast<std::size_t>(source.pick(1 << 20)) % mesh.triangles.size()];
            const Vec3d p = to_double(mesh.positions[t.v[0]]), q = to_double(mesh.positions[t.v[1]]);
            const Vec3d m = to_map_space(view, p + (q - p) * source.uniform(0, 1));
            const auto place = [&](double v) {
                const bool on_map = v > 0 && v < view.width && source.chance(80);
                return on_map ? std::min(static_cast<int>(v) / 64, view.width / 64 - 1)
                              : source.pick(view.width / 64);
            };
            at.emplace_back(place(m.x), place(m.y));
            wanted.push_back({at.back().first, at.back().second, 6, true});
        }
        const Receivers receivers = source.chance(50) ? Receivers::any : Receivers::static_only;
        const ShadowTree tree = encode_tree(tree_of(mesh, view, wanted, receivers), view);
        const std::vector<TriangleRecord> records = records_of(mesh, view);
        RegionOracle oracle(mesh, view, receivers);
        for (const auto& [column, row] : at) {
            const std::vector<DepthInterval>& intervals = oracle.intervals(64 * column, 64 * row);
            for (int i = 0; i < 64 * 64; ++i) {
                const int x = 64 * column + i % 64, y = 64 * row + i / 64;
                const DepthInterval interval = intervals[static_cast<std::size_t>(i)];
                ASSERT_TRUE(contains(interval, looked_up(tree, x, y, 0))) << x << "," << y;
                ++compared;
                seen += interval != DepthInterval{};
                if (i % 509 != 0) continue;
                ASSERT_EQ(interval, oracle::interval(oracle::hits_at(records, x, y),
                                                     receivers == Receivers::static_only))
                    << x << "," << y;
            }
        }
    }
    EXPECT_GT(seen, compared / 4);
}

TEST(NeededNodes, SameBitsForEveryExec) {
    hard::Source source(77);
    const Mesh mesh = solids::random_solids(5, 60, true, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), 512);
    const std::vector<Wanted> wanted = random_wanted(source, 9);
    const MultiresTree expected = tree_of(mesh, view, wanted, Receivers::any, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 4})
            EXPECT_TRUE(same_tree(tree_of(mesh, view, wanted, Receivers::any, {isa, threads}), expected));
    }
}

}  // namespace
}  // namespace obscura
