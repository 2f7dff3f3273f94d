// A day made in parts, in any order, by whom ever, is the day made at once, bit for bit; gaps and strangers
// are told.

#include "hierarchy/terrain/far_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/hash.h"
#include "tests/terrain/drawn_days.h"

namespace obscura {
namespace {

struct Ground {
    HeightField field = drawn::hills(140, 90);
    std::vector<FarSun> suns = drawn::suns_over(field, 37);
    FarDayParams params{4, 64, 8};
    FarDay empty = empty_far_day(field, suns, params);
    FarDay whole = make_far_day(field, suns, params, {});
};

bool same(const FarDay& a, const FarDay& b) {
    return a.units == b.units && std::ranges::equal(a.bytes, b.bytes) && a.suns == b.suns;
}

FarDay part(const Ground& g, int i, int of) {
    return make_missing(g.field, g.empty, groups_of_part(g.empty.groups(), i, of), {}, {});
}

TEST(FarParts, JoinToTheWholeInAnyOrder) {
    const Ground g;
    ASSERT_EQ(g.empty.groups(), 5);
    EXPECT_NE(bulk_hash(nullptr, 0), absent_unit_hash);
    for (const int of : {1, 2, 3, 5, 7}) {
        std::vector<NamedDay> parts;
        std::vector<int> all;
        for (int i = of; i >= 1; --i) {
            parts.push_back({part(g, i, of), "part"});
            for (const int group : groups_of_part(5, i, of))
                all.push_back(group);
        }
        std::sort(all.begin(), all.end());
        EXPECT_EQ(all, (std::vector<int>{0, 1, 2, 3, 4})) << of;
        const FarDay day = joined(g.empty, parts);
        EXPECT_TRUE(same(day, g.whole)) << of << " parts";
        EXPECT_TRUE(missing_groups(day).empty());
        // What two parts have is there once.
        parts.push_back(parts.front());
        EXPECT_TRUE(same(joined(g.empty, parts), g.whole));
    }
}

TEST(FarParts, GapsAreTold) {
    const Ground g;
    const std::vector<NamedDay> parts{{part(g, 1, 5), "a"}, {part(g, 4, 5), "b"}};
    const FarDay day = joined(g.empty, parts);
    EXPECT_EQ(missing_groups(day), (std::vector<int>{1, 2, 4}));
    EXPECT_EQ(suns_text(day, missing_groups(day)), "suns 9 to 24 and 33 to 37");
    EXPECT_THROW(far_tile(day, 1, 0), InputError);
    EXPECT_NO_THROW(far_tile(day, 3, 0));
}

TEST(FarParts, PartsThatDisagreeAreTold) {
    const Ground g;
    std::vector<CodedGroup> other(5);
    other[2] = coded_group(g.whole, 1);
    const std::vector<NamedDay> parts{{g.whole, "a"}, {with_groups(g.empty, other), "b"}};
    try {
        joined(g.empty, parts);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_EQ(e.file, "b");
        EXPECT_EQ(e.message, "has other shadows of suns 17 to 24 than another part");
    }
}

TEST(FarParts, OnlyWhatIsMissingIsMade) {
    const Ground g;
    const int all[] = {0, 1, 2, 3, 4};
    int kept = 0;
    FarDay last;
    const auto keep = [&](const FarDay& so_far) {
        ++kept;
        last = so_far;
    };
    EXPECT_TRUE(same(make_missing(g.field, part(g, 1, 2), all, {}, {}, keep), g.whole));
    EXPECT_EQ(kept, 2);
    EXPECT_TRUE(same(last, g.whole));
    // Altered units are made again.
    std::vector<CodedGroup> groups;
    for (int i = 0; i < 5; ++i)
        groups.push_back(coded_group(g.whole, i));
    FarDay bad = with_groups(g.empty, groups);
    bad.units[static_cast<std::size_t>(3 * bad.tiles() + 1)].hash ^= 1;
    EXPECT_EQ(missing_groups(bad), (std::vector<int>{3}));
    kept = 0;
    EXPECT_TRUE(same(make_missing(g.field, bad, all, {}, {}, keep), g.whole));
    EXPECT_EQ(kept, 1);
    const std::atomic<bool> cancel = true;
    EXPECT_TRUE(make_missing(g.field, bad, all, {}, {nullptr, &cancel}).units.empty());
}

}  // namespace
}  // namespace obscura
