// The table of benches, and the texts of a help page that are made of it.

#include "bench/benches.h"

#include <gtest/gtest.h>

#include <set>

namespace obscura {
namespace {

TEST(Benches, HaveDifferentNamesAndCanRun) {
    std::set<std::string> names;
    for (const Bench& bench : all_benches()) {
        EXPECT_TRUE(names.insert(bench.name).second) << bench.name;
        EXPECT_NE(bench.run, nullptr) << bench.name;
        EXPECT_EQ(find_bench(bench.name), &bench);
    }
    EXPECT_GE(names.size(), 4u);
    EXPECT_EQ(find_bench("rast"), nullptr);
}

TEST(Benches, KnowTheirOwnPartsAndNoOthers) {
    const Bench *shadows = find_bench("shadows"), *raster = find_bench("raster");
    ASSERT_TRUE(shadows != nullptr && raster != nullptr);
    EXPECT_TRUE(has_part(*shadows, "sizes"));
    EXPECT_FALSE(has_part(*shadows, "size"));
    EXPECT_FALSE(has_part(*raster, "sizes"));
    EXPECT_TRUE(has_part(*raster, ""));
}

TEST(Benches, TextsNameEveryRow) {
    for (const Bench& bench : all_benches()) {
        EXPECT_NE(benches_text().find(std::string(bench.name) + " (" + bench.what + ")"), std::string::npos);
        EXPECT_NE(subjects_text().find(bench.subjects), std::string::npos) << bench.name;
        EXPECT_EQ(parts_text().find(bench.name) != std::string::npos, !bench.parts.empty()) << bench.name;
        for (const char* kind : bench.data)
            EXPECT_NE(data_text().find(kind), std::string::npos) << bench.name << ' ' << kind;
    }
    // Words that several rows share appear once.
    EXPECT_EQ(subjects_text().find("scenes"), subjects_text().rfind("scenes"));
}

}  // namespace
}  // namespace obscura
