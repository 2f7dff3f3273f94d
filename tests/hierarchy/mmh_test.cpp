// Merged trees: lossless whatever is merged, smaller the more is searched, the same bytes for any threads.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/error.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/combine.h"
#include "hierarchy/fixed_depth.h"
#include "hierarchy/mmh/mmh.h"
#include "hierarchy/tree_units.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/lossless.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {
namespace {

EncodeParams merged_params(int search_limit = 1000) {
    EncodeParams params;
    params.code = ShadowCode::mmh;
    params.merge.search_limit = search_limit;
    return params;
}

// --- numbers -----------------------------------------------------------------------------------------------

bool lies_inside(std::uint32_t v, DepthInterval i, TreeLayout layout) {
    const float depth = depth_of_fixed(layout, v);
    return i.entry <= depth && depth <= i.exit;
}

TEST(NumberRange, HoldsAllNumbersOfAnIntervalAndNoOthers) {
    std::mt19937 rng(3);
    const auto some_depth = [&] {
        const float unit = std::generate_canonical<float, 24>(rng);
        return rng() % 8 == 0 ? 1.0f : std::ldexp(unit, -static_cast<int>(rng() % 14));
    };
    int empty = 0;
    for (int round = 0; round < 20000; ++round) {
        const float a = some_depth(), b = rng() % 3 == 0 ? a : some_depth();
        const DepthInterval interval{std::min(a, b), std::max(a, b)};
        for (const TreeLayout layout : {TreeLayout::fractions, TreeLayout::float_bits}) {
            const NumberRange range = range_of(interval, layout);
            if (range.empty()) {
                ASSERT_EQ(layout, TreeLayout::fractions);
                ASSERT_LT(interval.entry, 0x1p-9f) << "where depths stand closer than fractions";
                ++empty;
                continue;
            }
            ASSERT_TRUE(lies_inside(range.least, interval, layout));
            ASSERT_TRUE(lies_inside(range.greatest, interval, layout));
            if (range.least > 0) {
                ASSERT_FALSE(lies_inside(range.least - 1, interval, layout));
            }
            if (range.greatest < ~0u && depth_of_fixed(layout, range.greatest) < 1.0f) {
                ASSERT_FALSE(lies_inside(range.greatest + 1, interval, layout));
            }
            const std::uint32_t stored = stored_number(range, layout);
            ASSERT_TRUE(range.least <= stored && stored <= range.greatest);
        }
    }
    EXPECT_GT(empty, 100);
}

TEST(NumberRange, KnowsTheEnds) {
    EXPECT_EQ(depth_of_fraction(0), 0.0f);
    EXPECT_EQ(depth_of_fraction(~0u), 1.0f);
    EXPECT_EQ(range_of({0, 0}, TreeLayout::fractions), (NumberRange{0, 0}));
    EXPECT_EQ(range_of({1, 1}, TreeLayout::fractions), (NumberRange{~0u - 127, ~0u}));
    EXPECT_EQ(range_of({0, 1}, TreeLayout::fractions), (NumberRange{0, ~0u}));
    EXPECT_EQ(range_of({0.5f, 0.5f}, TreeLayout::fractions),
              (NumberRange{0x80000000u - 64, 0x80000000u + 128}));
    EXPECT_EQ(range_of({-0.0f, -0.0f}, TreeLayout::float_bits), (NumberRange{0, 0}));
}

TEST(NumberRange, FractionsRoundToTheNearestFloatAndNeverTwice) {
    std::mt19937 rng(4);
    for (int round = 0; round < 100000; ++round) {
        const auto v = static_cast<std::uint32_t>(rng() >> (rng() % 32));
        // Double holds v / 2^32 exactly; its conversion rounds once.
        ASSERT_EQ(depth_of_fraction(v), static_cast<float>(static_cast<double>(v) / 4294967296.0)) << v;
    }
}

// --- whole trees -------------------------------------------------------------------------------------------

TEST(MergedTree, IsLosslessOnEverySample) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        for (const int limit : {1, 100, 0}) {
            const EncodeParams params = merged_params(limit);
            expect_lossless(random_interval_map(seed, 64), params, "random");
            expect_lossless(solid_interval_map(seed, 256, seed % 2 == 0), params, "solids");
        }
    }
    for (const int side : {1, 2, 64}) {
        expect_lossless(Image<DepthInterval>(side, side), merged_params(), "background");
        expect_lossless(distinct_interval_map(side), merged_params(), "distinct");
        if (side > 4) expect_lossless(lopsided_interval_map(side), merged_params(), "lopsided");
    }
}

TEST(MergedTree, IsLosslessOnSolidsOfEveryKindAndInPerspective) {
    int merged = 0;
    for_each_solid_map([&](const Image<DepthInterval>& map, const std::string& name) {
        expect_lossless(map, merged_params(0), name);
        const MultiresTree tree = build_bottom_up(map.view());
        merged += encode_tree(tree, {}, merged_params()).bytes < encode_tree(tree, {}).bytes;
    });
    EXPECT_GT(merged, 80) << "something was merged nearly everywhere";
}

TEST(MergedTree, UnfoldsToTheTreeItWasMadeOf) {
    for (const TreeSample& sample : tree_samples()) {
        if (sample.tree.intervals.empty() && !sample.tree.nodes.empty()) continue;  // top-down: keeps none
        for (const TreeLayout layout : {TreeLayout::fractions, TreeLayout::float_bits}) {
            EncodeParams params = merged_params();
            params.layout = layout;
            expect_same_topology(encode_tree(sample.tree, {}, params), sample.tree);
        }
    }
}

TEST(MergedTree, IsSmallerTheMoreIsSearched) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(3, 512, false).view());
    const std::uint64_t whole = encode_tree(tree, {}).bytes;
    std::uint64_t before = whole + 1;
    MergeStats least, most;
    for (const int limit : {1, 10, 100, 1000, 0}) {
        const EncodeParams params = merged_params(limit);
        MergeStats stats;
        const std::uint64_t bytes = encode_mmh(tree, {}, params, &stats).bytes;
        // Greedy: nothing promises this, but a search that sees more and finds less would be a fault here.
        EXPECT_LE(bytes, before) << limit;
        before = bytes;
        (limit == 1 ? least : most) = stats;
    }
    EXPECT_LT(static_cast<double>(before), 0.9 * static_cast<double>(whole));
    EXPECT_GT(most.merged, least.merged);
    EXPECT_GT(most.interval_mismatch, most.full_rejected) << "the early test rejects most";
}

TEST(MergedTree, CountsAsThePaperDoesOrSurvivorsOnly) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(5, 512, false).view());
    EncodeParams all = merged_params(20), survivors = all;
    all.merge.count_survivors = false;
    EXPECT_LT(encode_tree(tree, {}, survivors).bytes, encode_tree(tree, {}, all).bytes);
}

TEST(MergedTree, HasTheSameBytesForAnyThreads) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const MultiresTree tree = build_bottom_up(solid_interval_map(seed, 512, seed == 2).view());
        EncodeParams params = merged_params();
        params.exec.threads = 1;
        MergeStats first_stats;
        const ShadowTree first = encode_mmh(tree, {}, params, &first_stats);
        for (const int threads : {2, 3, 7}) {
            params.exec.threads = threads;
            MergeStats stats;
            const ShadowTree again = encode_mmh(tree, {}, params, &stats);
            ASSERT_EQ(again.bytes, first.bytes);
            EXPECT_EQ(std::memcmp(again.code.units, first.code.units, first.bytes), 0) << threads;
            EXPECT_EQ(stats, first_stats);
        }
    }
}

// --- the rule ----------------------------------------------------------------------------------------------

/// Two texels that differ from a square of 4 x 4: below it stands a full node with one leaf child each.
/// A: the node's interval is [.40, .60], its child's [.70, .71]. B: [.45, .70] and [.775, .785].
Image<DepthInterval> two_subtrees_with_a_shared_inner_node() {
    Image<DepthInterval> map(16, 16, DepthInterval{0.0f, 0.2f});
    const auto put = [&](int x0, int y0, DepthInterval inner, DepthInterval child) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 4; ++x)
                map(x0 + x, y0 + y) = inner;
        }
        map(x0 + 1, y0) = child;
    };
    put(0, 0, {0.40f, 0.60f}, {0.70f, 0.71f});
    put(8, 8, {0.45f, 0.70f}, {0.775f, 0.785f});
    return map;
}

/// The published rule, on that pair: children are compared relative to the middle of their parent, which is
/// moved afterwards to the middle of what both parents' intervals have in common.
TEST(MergeRule, ThePublishedOneLosesTheChildrenOfACentredNode) {
    const DepthInterval inner_a{0.40f, 0.60f}, child_a{0.70f, 0.71f}, inner_b{0.45f, 0.70f},
        child_b{0.775f, 0.785f};
    const auto middle = [](DepthInterval i) { return 0.5f * (i.entry + i.exit); };
    const auto common = [](DepthInterval a, DepthInterval b) {
        return DepthInterval{std::max(a.entry, b.entry), std::min(a.exit, b.exit)};
    };
    const auto relative = [](DepthInterval i, float to) { return DepthInterval{i.entry - to, i.exit - to}; };
    // It merges them: the inner intervals meet, and so do the children's relative ones.
    const DepthInterval inner = common(inner_a, inner_b);
    const DepthInterval child =
        common(relative(child_a, middle(inner_a)), relative(child_b, middle(inner_b)));
    ASSERT_LE(inner.entry, inner.exit);
    ASSERT_LE(child.entry, child.exit);
    // And decodes both children to one depth, which is neither's.
    const float decoded = middle(inner) + middle(child);
    EXPECT_FALSE(contains(child_a, decoded));
    EXPECT_FALSE(contains(child_b, decoded));
}

TEST(MergeRule, OursDoesNotMergeThemAndStaysLossless) {
    const Image<DepthInterval> map = two_subtrees_with_a_shared_inner_node();
    expect_lossless(map, merged_params(0), "two subtrees");
    const MultiresTree tree = build_bottom_up(map.view());
    const SubtreeSet set = subtrees_of(tree);
    const Merged merged = merge_subtrees(set, {}, Exec{});
    // Of the subtrees that hold a full node each, two are of one topology, and neither stands for the
    // other.
    int of_height_three = 0;
    for (std::size_t s = 0; s < set.subtrees.size(); ++s) {
        if (set.subtrees[s].height != 3 || set.subtrees[s].values < 2) continue;
        ++of_height_three;
        EXPECT_EQ(merged.stands_for[s], no_subtree);
    }
    EXPECT_EQ(of_height_three, 2);
    EXPECT_GT(merged.stats.full_rejected + merged.stats.interval_mismatch, 0u);
}

TEST(MergeRule, SharesWhereTheDifferencesAgree) {
    // The same pair, with B's child where A's can be: one subtree is enough, and the two inner nodes have
    // values of their own.
    Image<DepthInterval> map = two_subtrees_with_a_shared_inner_node();
    map(9, 8) = {0.705f, 0.715f};
    expect_lossless(map, merged_params(0), "two subtrees");
    const MultiresTree tree = build_bottom_up(map.view());
    const SubtreeSet set = subtrees_of(tree);
    const Merged merged = merge_subtrees(set, {}, Exec{});
    int shared = 0;
    for (std::size_t s = 0; s < set.subtrees.size(); ++s)
        shared += set.subtrees[s].height == 3 && merged.stands_for[s] != no_subtree;
    EXPECT_EQ(shared, 1);
}

TEST(MergeRule, SharesAcrossLevels) {
    // One texel in a square of 2 x 2, and a square of 4 x 4 in one of 8 x 8: the same topology at two
    // heights.
    Image<DepthInterval> map(32, 32, DepthInterval{0.25f, 0.5f});
    map(0, 0) = {0.7f, 0.8f};
    for (int y = 16; y < 20; ++y) {
        for (int x = 16; x < 20; ++x)
            map(x, y) = {0.75f, 0.9f};
    }
    expect_lossless(map, merged_params(), "across levels");
    const MultiresTree tree = build_bottom_up(map.view());
    const SubtreeSet set = subtrees_of(tree);
    const Merged merged = merge_subtrees(set, {}, Exec{});
    int across = 0;
    for (std::size_t s = 0; s < set.subtrees.size(); ++s) {
        const std::uint32_t other = merged.stands_for[s];
        across += other != no_subtree && set.subtrees[s].level != set.subtrees[other].level;
    }
    EXPECT_GE(across, 1);
    EXPECT_LT(encode_tree(tree, {}, merged_params()).bytes, encode_tree(tree, {}).bytes);
}

TEST(MergeRule, HoldsDepthsWithoutWidth) {
    // Sheets: every interval is one float. Fractions hold those from 2^-9 on; nearer ones ask for float bits.
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
        expect_lossless(*map, merged_params(0), "sheets");
        const ShadowTree merged = encode_tree(build_bottom_up(map->view()), {}, merged_params());
        EXPECT_EQ(merged.code.layout, map == &far ? TreeLayout::fractions : TreeLayout::float_bits);
    }
}

// --- offsets -----------------------------------------------------------------------------------------------

TEST(MergedTree, GivesUpWhatOffsetsCannotReach) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(3, 512, false).view());
    const std::uint64_t free = encode_tree(tree, {}, merged_params()).bytes;
    std::uint64_t before = free;
    for (const int bits : {12, 9, 6, min_offset_bits}) {
        EncodeParams params = merged_params();
        params.offset_bits = bits;
        const ShadowTree narrow = encode_tree(tree, {}, params);
        ASSERT_EQ(mmh_fault_of(narrow), nullptr) << bits;
        EXPECT_GE(narrow.bytes, before) << bits;
        before = narrow.bytes;
        expect_same_topology(narrow, tree);
        if (bits < 12) {
            EXPECT_GT(
                *std::max_element(std::begin(narrow.code.offset_scale), std::end(narrow.code.offset_scale)),
                1u);
        }
    }
    EXPECT_GT(before, free);
    EncodeParams params = merged_params();
    params.max_units = 100;
    EXPECT_THROW(encode_tree(tree, {}, params), LimitError);
}

}  // namespace
}  // namespace obscura
