// Directed acyclic graphs: lossless, the tree's own nodes, small numbers that are what readers make of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "core/error.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/dag/chunks.h"
#include "hierarchy/dag/classes.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/dag/dag_step.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/lossless.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {
namespace {

EncodeParams dag_params(int treelet_levels = 4, int chunk_log2 = 5, bool packed = false) {
    EncodeParams params;
    params.code = ShadowCode::dag;
    params.dag.treelet_levels = treelet_levels;
    params.dag.chunk_log2 = chunk_log2;
    params.dag.packed = packed;
    return params;
}

// --- values ------------------------------------------------------------------------------------------------

/// The number that a reader makes for range i.
std::uint32_t number_in(const ValueChunk& chunk, std::size_t i) {
    if ((chunk.has_factor[i / 32] >> i % 32 & 1u) == 0) return chunk.representative;
    std::size_t before = 0;
    for (std::size_t k = 0; k < i; ++k)
        before += chunk.has_factor[k / 32] >> k % 32 & 1u;
    return chunk.base + chunk.step * chunk.factors[before];
}

void expect_inside(const std::vector<NumberRange>& ranges, const ValueChunk& chunk) {
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        ASSERT_LE(ranges[i].least, number_in(chunk, i));
        ASSERT_LE(number_in(chunk, i), ranges[i].greatest);
    }
    for (const std::uint32_t factor : chunk.factors) {
        ASSERT_EQ(factor >> (8 * chunk.factor_bytes - 1) >> 1, 0u);
    }
}

TEST(ValueChunk, HoldsEveryRangeAndTheMostByOneNumber) {
    std::mt19937 rng(6);
    for (int round = 0; round < 8000; ++round) {
        const bool bits = round % 2 == 1;
        const std::uint32_t greatest = bits ? 0x3f800000u : ~0u;
        std::vector<NumberRange> ranges(1 + rng() % 128);
        const int coarse = static_cast<int>(rng() % 28), wide = static_cast<int>(rng() % 30);
        for (NumberRange& r : ranges) {
            const auto least = static_cast<std::uint32_t>(rng() >> rng() % 3) % greatest >> coarse << coarse;
            const auto width = round % 5 == 0 ? 0 : static_cast<std::uint32_t>(rng()) >> wide;
            r = {least, least + std::min(width, greatest - least)};
        }
        const ValueChunk chunk = chunk_of(ranges, bits ? TreeLayout::float_bits : TreeLayout::fractions);
        expect_inside(ranges, chunk);
        std::size_t most = 0;
        for (const NumberRange& at : ranges) {
            std::size_t here = 0;
            for (const NumberRange& r : ranges)
                here += r.least <= at.least && at.least <= r.greatest;
            most = std::max(most, here);
        }
        ASSERT_EQ(ranges.size() - chunk.factors.size(), most);
    }
}

TEST(ValueChunk, TakesTheBytesThatItNeeds) {
    const auto bytes_of = [](const std::vector<NumberRange>& ranges) {
        const ValueChunk chunk = chunk_of(ranges, TreeLayout::fractions);
        expect_inside(ranges, chunk);
        return chunk.factors.empty() ? 0 : chunk.factor_bytes;
    };
    EXPECT_EQ(bytes_of({{5, 9}, {7, 12}, {9, 9}}), 0u) << "one number for all";
    // Steps of 2^24 serve ranges that are as wide.
    EXPECT_EQ(bytes_of({{0, 0}, {1u << 24, 2u << 24}, {200u << 24, 201u << 24}}), 1u);
    // Multiples of three: steps of a power of two need two bytes, equal steps one.
    std::vector<NumberRange> threes{{7, 7}, {7, 7}};
    for (std::uint32_t i = 1; i < 256; ++i) {
        if (threes.size() < 100 || i == 255) threes.push_back({1000 + 3 * i, 1000 + 3 * i});
    }
    threes.push_back({1000, 1000});
    EXPECT_EQ(bytes_of(threes), 1u);
    EXPECT_EQ(bytes_of({{1, 1}, {2, 2}, {2 + 255, 2 + 255}}), 1u);
    EXPECT_EQ(bytes_of({{1, 1}, {2, 2}, {3, 3}, {3 + 256, 3 + 256}}), 2u);
    EXPECT_EQ(bytes_of({{1, 1}, {2, 2}, {3, 3}, {3 + 65536, 3 + 65536}}), 3u);
    EXPECT_EQ(bytes_of({{0, 0}, {1, 1}, {2, 2}, {~0u, ~0u}}), 4u);
}

/// The number that a reader makes for range i.
std::uint32_t number_in(const ClassedChunk& chunk, std::size_t i) {
    const ValueClass& c = chunk.classes[chunk.class_of[i]];
    return c.base + (chunk.factors[i] << c.shift);
}

TEST(ClassedChunk, HoldsEveryRangeInFewerBytesThanOneClassNeeds) {
    std::mt19937 rng(9);
    std::size_t of_classes[5] = {};
    for (int round = 0; round < 3000; ++round) {
        const bool bits = round % 2 == 1;
        const TreeLayout layout = bits ? TreeLayout::float_bits : TreeLayout::fractions;
        const std::uint32_t greatest = bits ? 0x3f800000u : ~0u;
        const int chunk_log2 = min_chunk_log2 + static_cast<int>(rng() % 4);
        std::vector<NumberRange> ranges(1 + rng() % (1u << chunk_log2));
        // Some places, and steps around them.
        const std::uint32_t places[3] = {static_cast<std::uint32_t>(rng()), static_cast<std::uint32_t>(rng()),
                                         0};
        const int spread = static_cast<int>(rng() % 32), wide = static_cast<int>(rng() % 32);
        for (NumberRange& r : ranges) {
            const auto least = (places[rng() % 3] + (static_cast<std::uint32_t>(rng()) >> spread)) % greatest;
            const auto width = round % 5 == 0 ? 0 : static_cast<std::uint32_t>(rng()) >> wide;
            r = {least, least + std::min(width, greatest - least)};
        }
        const ClassedChunk chunk = classed_chunk_of(ranges, layout, chunk_log2);
        ASSERT_GE(chunk.classes.size(), 1u);
        ASSERT_LE(chunk.classes.size(), most_classes);
        ++of_classes[chunk.classes.size()];
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            ASSERT_LE(ranges[i].least, number_in(chunk, i));
            ASSERT_LE(number_in(chunk, i), ranges[i].greatest);
            const std::uint32_t width = chunk.classes[chunk.class_of[i]].width;
            ASSERT_LE(width, 32u);
            ASSERT_EQ(width == 32 ? 0 : chunk.factors[i] >> width, 0u);
        }
        // All as they are: one class of 32 bits.
        ASSERT_LE(chunk.bytes(chunk_log2), packed_head_bytes + packed_class_bytes + 4 * ranges.size());
    }
    for (const std::size_t classes : {1u, 2u, 3u, 4u})
        EXPECT_GT(of_classes[classes], 20u) << classes;
}

TEST(ClassedChunk, FindsRoofsStreetsAndWalls) {
    std::vector<NumberRange> ranges;
    for (std::uint32_t i = 0; i < 16; ++i) {
        ranges.push_back({1000 + i, 1000 + i});                        // four bits
        ranges.push_back({0x40000000u + i % 4, 0x40000000u + i % 4});  // two
        ranges.push_back({0x80000000u, 0x90000000u});                  // none
        ranges.push_back({0xf0000000u - i, 0xf0000000u});              // none
    }
    const ClassedChunk chunk = classed_chunk_of(ranges, TreeLayout::fractions, 6);
    ASSERT_EQ(chunk.classes.size(), 4u);
    EXPECT_EQ(chunk.bytes(6), 4 + 4 * 5 + 2 * 8 + (16 * 4 + 16 * 2) / 8u);
    const std::vector<NumberRange> alike(64, NumberRange{5, 9});
    EXPECT_EQ(classed_chunk_of(alike, TreeLayout::fractions, 6).bytes(6), 9u);
}

// --- whole trees -------------------------------------------------------------------------------------------

TEST(Dag, IsLosslessOnEverySample) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        for (int levels = min_treelet_levels; levels <= max_treelet_levels; ++levels) {
            for (const bool packed : {false, true}) {
                const EncodeParams params = dag_params(levels, min_chunk_log2 + levels % 4, packed);
                expect_lossless(random_interval_map(seed, 64), params, "random");
                expect_lossless(solid_interval_map(seed, 256, seed % 2 == 0), params, "solids");
            }
        }
    }
    for (const int side : {1, 2, 64}) {
        for (const bool packed : {false, true}) {
            const EncodeParams params = dag_params(4, 6, packed);
            expect_lossless(Image<DepthInterval>(side, side), params, "background");
            expect_lossless(distinct_interval_map(side), params, "distinct");
            if (side > 4) expect_lossless(lopsided_interval_map(side), params, "lopsided");
        }
    }
}

TEST(Dag, IsLosslessOnSolidsOfEveryKindAndInPerspective) {
    int smaller = 0, packed_smaller = 0;
    for_each_solid_map([&](const Image<DepthInterval>& map, const std::string& name) {
        const MultiresTree tree = build_bottom_up(map.view());
        std::uint64_t bytes[2] = {};
        for (const bool packed : {false, true}) {
            const EncodeParams params = dag_params(4, packed ? 6 : 5, packed);
            expect_lossless(map, params, name);
            bytes[packed ? 1 : 0] = encode_tree(tree, {}, params).bytes;
        }
        smaller += bytes[0] < encode_tree(tree, {}).bytes;
        packed_smaller += bytes[1] < bytes[0];
    });
    EXPECT_GT(smaller, 80);
    EXPECT_GT(packed_smaller, 90);
}

TEST(Dag, IsLosslessOnDepthsWithoutWidth) {
    std::mt19937 rng(8);
    Image<DepthInterval> far(64, 64), near = far;
    for (std::size_t i = 0; i < far.pixels.size(); ++i) {
        const float z = 0x1p-9f + std::generate_canonical<float, 24>(rng) * 0.99f;
        far.pixels[i] = {z, z};
        const float n =
            std::ldexp(0.5f + 0.5f * std::generate_canonical<float, 24>(rng), -static_cast<int>(rng() % 30));
        near.pixels[i] = {n, n};
    }
    near(0, 0) = {0, 0};
    near(1, 0) = {1, 1};
    near(2, 0) = {0x1p-149f, 0x1p-149f};
    for (const Image<DepthInterval>* map : {&far, &near}) {
        expect_lossless(*map, dag_params(), "sheets");
        expect_lossless(*map, dag_params(4, 6, true), "sheets");
        const ShadowTree dag = encode_tree(build_bottom_up(map->view()), {}, dag_params());
        EXPECT_EQ(dag.code.layout, map == &far ? TreeLayout::fractions : TreeLayout::float_bits);
    }
}

TEST(Dag, UnfoldsToTheTreeItWasMadeOf) {
    for (const TreeSample& sample : tree_samples()) {
        if (sample.tree.intervals.empty() && !sample.tree.nodes.empty()) continue;  // top-down: keeps none
        for (const CodeCase& c : code_cases) {
            if (c.code != ShadowCode::dag) continue;
            const ShadowTree encoded = encode_tree(sample.tree, {}, params_of(c));
            expect_same_topology(encoded, sample.tree);
            const MultiresCounts counts = count_nodes(sample.tree);
            EXPECT_EQ(encoded.counts, sample.tree.root.kinds == 0 ? (MultiresCounts{0, 0, 1}) : counts);
        }
    }
}

TEST(Dag, HasTheSameBytesForAnyThreads) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const MultiresTree tree = build_bottom_up(solid_interval_map(seed, 512, seed == 2).view());
        EncodeParams params = dag_params(4, 5, seed != 2);
        params.exec.threads = 1;
        const ShadowTree first = encode_tree(tree, {}, params);
        for (const int threads : {2, 3, 7}) {
            params.exec.threads = threads;
            const ShadowTree again = encode_tree(tree, {}, params);
            ASSERT_EQ(again.bytes, first.bytes);
            EXPECT_EQ(std::memcmp(again.code.units, first.code.units, first.bytes), 0) << threads;
        }
    }
}

/// Sixteen times the same picture, at sixteen depths.
TEST(Dag, SharesWhatIsAlikeWhateverTheDepths) {
    const Image<DepthInterval> one = random_interval_map(3, 32);
    Image<DepthInterval> all(128, 128);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            const DepthInterval i = one(x % 32, y % 32);
            const auto to = static_cast<float>(y / 32 * 4 + x / 32) / 64.0f;
            all(x, y) = {i.entry / 2 + to, i.exit / 2 + to};
        }
    }
    expect_lossless(all, dag_params(), "sixteen");
    const DagStats of_one = dag_stats(encode_tree(build_bottom_up(one.view()), {}, dag_params())),
                   of_all = dag_stats(encode_tree(build_bottom_up(all.view()), {}, dag_params()));
    EXPECT_EQ(of_all.treelets, of_one.treelets);
    EXPECT_LE(of_all.inner_nodes, of_one.inner_nodes + 8);
    EXPECT_GE(of_all.values, 15 * of_one.values);
}

TEST(Dag, CountsWhatItConsistsOf) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(2, 512, false).view());
    const MultiresCounts counts = count_nodes(tree);
    for (int levels = min_treelet_levels; levels <= max_treelet_levels; ++levels) {
        const ShadowTree encoded = encode_tree(tree, {}, dag_params(levels));
        const DagStats stats = dag_stats(encoded);
        EXPECT_EQ(stats.values, counts.full + counts.leaf);
        EXPECT_EQ(stats.structure_bytes() + stats.value_bytes(), encoded.bytes);
        EXPECT_EQ(stats.treelet_bytes, stats.treelets * 4 * treelet_words(levels));
        EXPECT_LE(stats.factors, stats.factor_bytes);
        EXPECT_LT(stats.factors, stats.values);
        if (levels == 1) {
            EXPECT_EQ(stats.treelets, 1u) << "a node with a value and nothing below it";
        }
    }
}

/// Places and counts that need one byte, two and three.
TEST(Dag, PacksPlacesAndCountsOfEveryLength) {
    const Image<DepthInterval> map = random_interval_map(7, 1024);
    const MultiresTree tree = build_bottom_up(map.view());
    const ShadowTree plain = encode_tree(tree, {}, dag_params(3, 5)),
                     packed = encode_tree(tree, {}, dag_params(3, 5, true));
    const DagStats stats = dag_stats(packed);
    ASSERT_GT(stats.inner_bytes, 1u << 16);
    ASSERT_GT(stats.values, 1u << 16);
    EXPECT_EQ(stats.inner_nodes, dag_stats(plain).inner_nodes);
    EXPECT_LT(stats.inner_bytes, dag_stats(plain).inner_bytes);
    expect_same_topology(packed, tree);
    expect_lossless(map, dag_params(3, 5, true), "all lengths");
}

// --- limits ------------------------------------------------------------------------------------------------

TEST(Dag, WidensWhatItsNodesCount) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(3, 256, false).view());
    EncodeParams params = dag_params();
    const ShadowTree narrow = encode_tree(tree, {}, params);
    const std::uint64_t below_root = dag_stats(narrow).values - 1;
    params.dag.most_counted = below_root;
    EXPECT_EQ(encode_tree(tree, {}, params).bytes, narrow.bytes) << "as many as fit";
    params.dag.most_counted = below_root - 1;
    const ShadowTree wide = encode_tree(tree, {}, params);
    EXPECT_EQ(wide.bytes, narrow.bytes + 4 * dag_stats(narrow).inner_nodes);
    EXPECT_TRUE(DagForm::of(DagCode::header(wide.code).form).wide);
    expect_same_topology(wide, tree);
    ASSERT_EQ(dag_fault_of(wide), nullptr);
    for (std::uint32_t y = 0; y < 256; ++y) {
        for (std::uint32_t x = 0; x < 256; ++x)
            ASSERT_EQ(tree_value(wide.code, x, y), tree_value(narrow.code, x, y));
    }
}

TEST(Dag, RefusesWhatLookupsCannotName) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(3, 256, false).view());
    EncodeParams params = dag_params();
    const std::uint64_t bytes = encode_tree(tree, {}, params).bytes;
    params.max_units = (bytes + 3) / 4;
    EXPECT_EQ(encode_tree(tree, {}, params).bytes, bytes);
    params.max_units = (bytes - 1) / 4;
    EXPECT_THROW(encode_tree(tree, {}, params), LimitError);
}

}  // namespace
}  // namespace obscura
