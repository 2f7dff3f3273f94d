// Layers and intervals of whole meshes, against the oracle and against what must hold.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/hash.h"
#include "raster/depth_map.h"
#include "raster/interval_map.h"
#include "raster/layers.h"
#include "raster/view.h"
#include "tests/raster/raster_oracle.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

LightView view_of(const Mesh& mesh, Vec3d direction, int resolution) {
    return orthographic_light_view(bounds_of(mesh), normalize(direction), resolution);
}

std::vector<TriangleRecord> records_of(const Mesh& mesh, const LightView& view) {
    TriangleSetup setup;
    setup_triangles(mesh, view, {}, Exec{Isa::ref, 1}, setup);
    std::vector<TriangleRecord> records;
    for (const RecordBlock& b : setup.blocks) {
        for (std::size_t i = b.begin; i < b.begin + b.count; ++i)
            records.push_back(setup.records[i]);
    }
    return records;
}

std::uint64_t hash_of(const Image<DepthInterval>& map) {
    return Hasher().values(map.pixels).state;
}

Image<DepthInterval> intervals(const Mesh& mesh, const LightView& view, Receivers receivers, Isa isa,
                               int threads) {
    return interval_map(mesh, view, {receivers, true}, Exec{isa, threads});
}

class RandomSolids : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(RandomSolids, IntervalsEqualTheOracleBitForBit) {
    const auto [seed, perspective] = GetParam();
    const Mesh mesh =
        solids::random_solids(static_cast<std::uint32_t>(seed), 40, seed % 2 == 0, seed % 3 == 0);
    // 200 is no multiple of the tile: borders are cut.
    const LightView view =
        perspective ? perspective_light_view({7, 9, 5}, normalize(Vec3d{-7, -9, -5}), 70, 0.5, 40, 200)
                    : view_of(mesh, {0.3, -1, 0.2}, 200);
    const std::vector<TriangleRecord> records = records_of(mesh, view);
    for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
        Image<DepthInterval> expected(view.width, view.height);
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                expected(x, y) =
                    oracle::interval(oracle::hits_at(records, x, y), receivers == Receivers::static_only);
            }
        }
        for (const Isa isa : supported_isas()) {
            ASSERT_EQ(intervals(mesh, view, receivers, isa, 2), expected) << isa_name(isa);
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomSolids, testing::Combine(testing::Range(1, 7), testing::Bool()));

TEST(Layers, ListsEqualTheOracleOnEveryIsa) {
    const Mesh mesh = solids::random_solids(21, 60, true, true);
    const LightView view = view_of(mesh, {0.2, -1, 0.4}, 150);
    const std::vector<TriangleRecord> records = records_of(mesh, view);
    const Region region{13, 21, 101, 97};
    for (const Isa isa : supported_isas()) {
        const Layers layers = layers_of(mesh, view, region, Exec{isa, 2});
        std::size_t deepest = 0;
        for (int y = region.y0; y < region.y0 + region.height; ++y) {
            for (int x = region.x0; x < region.x0 + region.width; ++x) {
                const auto expected = oracle::hits_at(records, x, y);
                const auto actual = layers.at(x, y);
                ASSERT_EQ(actual.size(), expected.size()) << isa_name(isa) << " at " << x << "," << y;
                for (std::size_t i = 0; i < actual.size(); ++i) {
                    ASSERT_EQ(actual[i].depth, expected[i].depth);
                    ASSERT_EQ(static_cast<int>(actual[i].crossing), expected[i].kind);
                    ASSERT_EQ(actual[i].triangle, expected[i].triangle);
                }
                deepest = std::max(deepest, actual.size());
            }
        }
        EXPECT_GT(deepest, 8u) << "the test should reach past the layers in place";
    }
}

TEST(Layers, ClosedSolidsBalanceAtEverySample) {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 60, false, true);
        const LightView view = view_of(mesh, {0.1 * seed, -1, 0.3}, 192);
        const Layers layers = layers_of(mesh, view, {0, 0, 192, 192}, Exec{best_isa(), 2});
        ASSERT_GT(layers.crossings.size(), 10000u);
        for (int y = 0; y < 192; ++y) {
            for (int x = 0; x < 192; ++x) {
                int sum = 0;
                for (const LayerCrossing& c : layers.at(x, y))
                    sum += c.crossing == Crossing::entry ? 1 : -1;
                ASSERT_EQ(sum, 0) << x << "," << y << " seed " << seed;
            }
        }
    }
}

TEST(Layers, VerticesOnTexelCentresStillBalance) {
    // Texels of one metre seen straight down: every corner of these boxes lies exactly on a centre.
    Mesh mesh;
    for (int i = 0; i < 9; ++i) {
        const double x = 2.5 + 5 * (i % 3), z = 2.5 + 5 * (i / 3);
        solids::add(mesh, box({x, 0.0, z}, {x + 5, 1.0 + i, z + 5}));
    }
    LightView view;
    view.width = view.height = 20;
    view.to_map = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -0.05, 0, 0.75}, {0, 0, 0, 1}}};
    for (const Isa isa : supported_isas()) {
        const Layers layers = layers_of(mesh, view, {0, 0, 20, 20}, Exec{isa, 1});
        int covered = 0;
        for (int y = 0; y < 20; ++y) {
            for (int x = 0; x < 20; ++x) {
                // Each centre inside the block of boxes belongs to exactly one of them.
                const auto list = layers.at(x, y);
                ASSERT_TRUE(list.empty() || list.size() == 2) << x << "," << y;
                covered += !list.empty();
            }
        }
        EXPECT_EQ(covered, 15 * 15);
    }
}

TEST(Layers, ThreeHundredLayersAreAllThere) {
    Mesh mesh;
    for (int i = 0; i < 150; ++i)
        solids::add(mesh, box({-1.0, 2.0 * i, -1.0}, {1.0, 2.0 * i + 1, 1.0}));
    const LightView view = view_of(mesh, {0, -1, 0}, 300);
    for (const Isa isa : supported_isas()) {
        const Layers layers = layers_of(mesh, view, {140, 140, 20, 20}, Exec{isa, 2});
        for (int y = 140; y < 160; ++y) {
            for (int x = 140; x < 160; ++x) {
                const auto list = layers.at(x, y);
                if (list.empty()) continue;
                ASSERT_EQ(list.size(), 300u);
                ASSERT_TRUE(std::is_sorted(list.begin(), list.end(), comes_before));
            }
        }
        EXPECT_EQ(layers.at(150, 150).size(), 300u);
    }
}

TEST(Intervals, NestedSolidsNeedMoreThanTheLayersInPlace) {
    // Sixty boxes inside one another: the interval is that of the outermost, found behind 118 other
    // crossings.
    Mesh mesh;
    for (int i = 0; i < 60; ++i)
        solids::add(mesh, box(Vec3d{10.0 - 0.1 * i, 10.0 - 0.1 * i, 10.0 - 0.1 * i}));
    const LightView view = view_of(mesh, {0, -1, 0}, 64);
    for (const Isa isa : supported_isas()) {
        const DepthInterval middle = intervals(mesh, view, Receivers::any, isa, 1)(32, 32);
        EXPECT_EQ(middle.entry, static_cast<float>(to_map_space(view, {0, 5, 0}).z));
        EXPECT_EQ(middle.exit, static_cast<float>(to_map_space(view, {0, -5, 0}).z));
    }
}

TEST(Intervals, TouchingSolidsAreOneAndAGapParts) {
    const auto middle = [](double gap) {
        Mesh mesh;
        solids::add(mesh, box({-1, 1 + gap, -1}, {1, 2 + gap, 1}));
        solids::add(mesh, box({-1, 0, -1}, {1, 1, 1}));
        const LightView view = view_of(mesh, {0, -1, 0}, 32);
        const DepthInterval i = intervals(mesh, view, Receivers::any, best_isa(), 1)(16, 16);
        const float end = static_cast<float>(to_map_space(view, {0, gap == 0 ? 0 : 1 + gap, 0}).z);
        EXPECT_EQ(i.exit, end);
        return i;
    };
    EXPECT_GT(middle(0).exit - middle(0).entry, 1.5f * (middle(0.25).exit - middle(0.25).entry));
}

TEST(Intervals, OpenSheetsAreThinAndReachOnOnlyForStaticReceivers) {
    Mesh mesh;
    solids::add(mesh, solids::shifted(plane(2, 2), {0, 3, 0}));
    solids::add(mesh, box({-2, 0, -2}, {2, 1, 2}));
    const LightView view = view_of(mesh, {0, -1, 0}, 64);
    const float sheet = static_cast<float>(to_map_space(view, {0, 3, 0}).z);
    const float top = static_cast<float>(to_map_space(view, {0, 1, 0}).z);
    const DepthInterval any = intervals(mesh, view, Receivers::any, best_isa(), 1)(32, 32);
    EXPECT_EQ(any, (DepthInterval{sheet, sheet}));
    const DepthInterval still = intervals(mesh, view, Receivers::static_only, best_isa(), 1)(32, 32);
    EXPECT_EQ(still.entry, sheet);
    EXPECT_EQ(still.exit, std::nextafterf(top, 0.0f));
}

TEST(Intervals, ASheetInsideASolidDoesNotMatter) {
    Mesh solid, both;
    solids::add(solid, box({-2, 0, -2}, {2, 2, 2}));
    solids::add(both, box({-2, 0, -2}, {2, 2, 2}));
    solids::add(both, solids::shifted(plane(2, 2), {0, 1, 0}));
    const LightView view = view_of(solid, {0, -1, 0}, 64);
    EXPECT_EQ(intervals(both, view, Receivers::any, best_isa(), 1),
              intervals(solid, view, Receivers::any, best_isa(), 1));
}

TEST(Intervals, FlippedAndCutSolidsLeakNoLight) {
    // A receiver behind the first surface must be in shadow: the stored depth may not lie behind it.
    Mesh flipped_box;
    solids::add(flipped_box, solids::flipped(box({-1, 0, -1}, {1, 2, 1})));
    const LightView view = view_of(flipped_box, {0, -1, 0}, 32);
    const DepthInterval i = intervals(flipped_box, view, Receivers::any, best_isa(), 1)(16, 16);
    EXPECT_EQ(i.entry, i.exit);
    EXPECT_EQ(i.entry, static_cast<float>(to_map_space(view, {0, 2, 0}).z));

    // A light inside a box, cut open by the near plane: its far wall is met as a back face.
    Mesh around;
    solids::add(around, box({-1, -1, -1}, {1, 1, 1}));
    solids::add(around, box({-1, -4, -1}, {1, -3, 1}));
    const LightView inside = perspective_light_view({0, 0, 0}, {0, -1, 0}, 60, 0.1, 10, 32);
    const DepthInterval cut = intervals(around, inside, Receivers::any, best_isa(), 1)(16, 16);
    EXPECT_EQ(cut.entry, cut.exit);
    EXPECT_NEAR(cut.entry, static_cast<float>(to_map_space(inside, {0, -1, 0}).z), 1e-6f);
}

TEST(Intervals, DoNotDependOnOrderThreadsOrIsa) {
    const Mesh mesh = solids::random_solids(33, 80, true, true);
    const LightView view = view_of(mesh, {0.5, -1, 0.1}, 333);
    const std::uint64_t expected = hash_of(intervals(mesh, view, Receivers::any, Isa::ref, 1));
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 2, 3, 7}) {
            ASSERT_EQ(hash_of(intervals(mesh, view, Receivers::any, isa, threads)), expected)
                << isa_name(isa) << ", " << threads << " threads";
        }
    }
    // Triangles in another order, corners turned round.
    Mesh shuffled = mesh;
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Triangle& t = mesh.triangles[order[i]];
        shuffled.triangles[i] = {{t.v[i % 3], t.v[(i + 1) % 3], t.v[(i + 2) % 3]}};
        shuffled.component[i] = mesh.component[order[i]];
        shuffled.face[i] = mesh.face[order[i]];
        shuffled.object[i] = mesh.object[order[i]];
    }
    EXPECT_EQ(hash_of(intervals(shuffled, view, Receivers::any, best_isa(), 2)), expected);
}

TEST(Intervals, DoNotDependOnTheTile) {
    const Mesh mesh = solids::random_solids(34, 60, true, false);
    const LightView view = view_of(mesh, {0.5, -1, 0.1}, 256);
    const Image<DepthInterval> whole = intervals(mesh, view, Receivers::any, best_isa(), 1);
    TriangleSetup setup;
    setup_triangles(mesh, view, {}, Exec{}, setup);
    std::vector<std::uint32_t> list;
    for (const RecordBlock& b : setup.blocks) {
        for (std::size_t i = b.begin; i < b.begin + b.count; ++i)
            list.push_back(static_cast<std::uint32_t>(i));
    }
    // Tiles of other sizes at odd places.
    std::mt19937 rng(1);
    for (int round = 0; round < 60; ++round) {
        const int width = round % 2 == 0 ? 16 : 32, height = 1 + static_cast<int>(rng() % 32);
        const TileRect tile{static_cast<int>(rng() % 224), static_cast<int>(rng() % 224), width, height};
        DepthInterval out[layer_tile_texels];
        IntervalTiler().run(setup, list, tile, Receivers::any,
                            supported_isas()[rng() % supported_isas().size()], out);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                ASSERT_EQ(out[y * width + x], whole(tile.x0 + x, tile.y0 + y));
        }
    }
}

TEST(Region, IsTheSamePartOfTheWholeMap) {
    const Mesh mesh = solids::random_solids(36, 60, true, false);
    const LightView view = view_of(mesh, {-0.4, -1, 0.3}, 400);
    const Image<DepthInterval> whole = intervals(mesh, view, Receivers::any, best_isa(), 2);
    const Image<float> whole_depth = depth_map(mesh, view, Exec{});
    for (const Region& region : {Region{0, 0, 400, 400}, Region{37, 201, 150, 99}, Region{399, 0, 1, 400}}) {
        const Image<DepthInterval> part = interval_map(mesh, view, {Receivers::any, true, region}, Exec{});
        RasterScratch scratch;
        Image<float> part_depth(region.width, region.height);
        SetupParams params;
        params.region = region;
        depth_map(mesh, view, params, Exec{}, scratch, part_depth.view());
        for (int y = 0; y < region.height; ++y) {
            for (int x = 0; x < region.width; ++x) {
                ASSERT_EQ(part(x, y), whole(region.x0 + x, region.y0 + y));
                ASSERT_EQ(part_depth(x, y), whole_depth(region.x0 + x, region.y0 + y));
            }
        }
    }
}

TEST(Region, OfTheLargestViewCostsOnlyItself) {
    // 2^20 x 2^20 texels: a dense map would take 8 TiB. The region's work follows the region.
    const Mesh mesh = solids::random_solids(37, 60, true, true);
    const LightView view = view_of(mesh, {-0.4, -1, 0.3}, 1 << 20);
    const std::vector<TriangleRecord> records = records_of(mesh, view);
    std::mt19937 rng(2);
    int covered = 0;
    for (int round = 0; round < 12; ++round) {
        const Region region{static_cast<int>(400000 + rng() % 250000),
                            static_cast<int>(400000 + rng() % 250000), 96, 70};
        RasterScratch scratch;
        Image<DepthInterval> map(region.width, region.height);
        interval_map(mesh, view, {Receivers::any, true, region}, Exec{best_isa(), 2}, scratch, map.view());
        ASSERT_EQ(scratch.bins.tiles(), 4u);
        ASSERT_LE(scratch.bins.items.size(), 4 * records.size());
        const Layers layers = layers_of(mesh, view, region, Exec{});
        for (int y = 0; y < region.height; ++y) {
            for (int x = 0; x < region.width; x += 7) {
                const auto expected = oracle::hits_at(records, region.x0 + x, region.y0 + y);
                ASSERT_EQ(map(x, y), oracle::interval(expected, false));
                ASSERT_EQ(layers.at(region.x0 + x, region.y0 + y).size(), expected.size());
                covered += !expected.empty();
            }
        }
    }
    EXPECT_GT(covered, 1000);
}

TEST(DepthMap, IsTheFirstLayer) {
    const Mesh mesh = solids::random_solids(35, 60, true, true);
    const LightView view = view_of(mesh, {-0.4, -1, 0.3}, 230);
    const Layers layers = layers_of(mesh, view, {0, 0, 230, 230}, Exec{});
    for (const Isa isa : supported_isas()) {
        const Image<float> depth = depth_map(mesh, view, Exec{isa, 2});
        for (int y = 0; y < 230; ++y) {
            for (int x = 0; x < 230; ++x) {
                const auto list = layers.at(x, y);
                ASSERT_EQ(depth(x, y), list.empty() ? 1.0f : list.front().depth) << isa_name(isa);
            }
        }
    }
}

TEST(Intervals, OfATurnedBoxFollowItsPlanes) {
    // Analytic: a ray straight down through a box turned about two axes, by slabs.
    Mesh mesh;
    const Affine turn = solids::rotation({0.3, 1, 0.2}, 0.37);
    solids::add(mesh, solids::moved(box(Vec3d{2, 1, 3}), turn));
    const LightView view = view_of(mesh, {0, -1, 0}, 256);
    const Mat4 to_world = inverse(view.to_map);
    const Image<DepthInterval> map = intervals(mesh, view, Receivers::any, best_isa(), 1);
    int inside = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const Vec4d p4 = to_world * Vec4d{x + 0.5, y + 0.5, 0, 1},
                        q4 = to_world * Vec4d{x + 0.5, y + 0.5, 1, 1};
            const Vec3d p{p4.x, p4.y, p4.z}, d = Vec3d{q4.x, q4.y, q4.z} - p;
            double enter = 0, leave = 1;
            for (int axis = 0; axis < 3; ++axis) {
                const Vec3d n{turn.m[0][axis], turn.m[1][axis], turn.m[2][axis]};
                const double half[3] = {1, 0.5, 1.5};
                const double at = dot(n, p), along = dot(n, d);
                const double t0 = (-half[axis] - at) / along, t1 = (half[axis] - at) / along;
                enter = std::max(enter, std::min(t0, t1));
                leave = std::min(leave, std::max(t0, t1));
            }
            if (leave - enter < 0.02) continue;
            ++inside;
            ASSERT_NEAR(map(x, y).entry, enter, 2e-5);
            ASSERT_NEAR(map(x, y).exit, leave, 2e-5);
        }
    }
    EXPECT_GT(inside, 8000);
}

}  // namespace
}  // namespace obscura
