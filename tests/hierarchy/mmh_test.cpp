// Merged trees: lossless whatever is merged, smaller the more is searched, the same bytes for any threads.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/error.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/mmh/fixed_depth.h"
#include "hierarchy/mmh/mmh.h"
#include "hierarchy/tree_units.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {
namespace {

EncodeParams merged_params(int search_limit = 1000) {
    EncodeParams params;
    params.code = ShadowCode::mmh;
    params.merge.search_limit = search_limit;
    return params;
}

/// Every texel's depth lies in its interval, zero tolerance; the top grid finds the same.
void expect_lossless(const Image<DepthInterval>& map, const EncodeParams& params, const std::string& name) {
    const MultiresTree tree = build_bottom_up(map.view());
    ShadowTree merged = encode_tree(tree, {}, params);
    set_top_grid(merged, std::min(3, tree.levels));
    ASSERT_EQ(row_of(merged.code.code).fault_of(merged), nullptr) << name;
    int outside = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
            const float depth = tree_value(merged.code, ux, uy);
            const DepthInterval i = map(x, y);
            outside += i.entry <= depth && depth <= i.exit ? 0 : 1;
            if (merged.code.top != nullptr) {
                ASSERT_EQ(tree_value_from_top(merged.code, ux, uy), depth);
            }
        }
    }
    EXPECT_EQ(outside, 0) << name;
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

}  // namespace
}  // namespace obscura
