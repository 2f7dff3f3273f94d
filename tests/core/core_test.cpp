#include <gtest/gtest.h>

#include <vector>

#include "core/buffer.h"
#include "core/error.h"
#include "core/isa.h"
#include "core/parallel.h"
#include "core/vec.h"

namespace obscura {
namespace {

TEST(Vec, InverseTimesMatrixIsIdentity) {
    const Mat4 a{{{2, 1, 0, 3}, {-1, 4, 2, 0}, {0.5, 0, 3, 1}, {0, 1, 0.25, 2}}};
    const Mat4 identity = inverse(a) * a;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j)
            EXPECT_NEAR(identity.m[i][j], i == j ? 1.0 : 0.0, 1e-14);
    }
}

TEST(Parallel, EveryItemRunsOnceForAnyThreadCount) {
    for (const int threads : {1, 2, 3, 7}) {
        std::vector<int> count(1000, 0);
        parallel_for(count.size(), Exec{Isa::ref, threads}, [&](std::size_t i) { ++count[i]; });
        EXPECT_EQ(count, std::vector<int>(1000, 1)) << threads << " threads";
    }
}

TEST(Parallel, ExceptionOfAnItemReachesTheCaller) {
    EXPECT_THROW(parallel_for(100, Exec{Isa::ref, 2},
                              [](std::size_t i) {
                                  if (i == 50) throw UsageError("item 50");
                              }),
                 UsageError);
}

TEST(Isa, NamesRoundTrip) {
    for (const Isa isa : supported_isas())
        EXPECT_EQ(parse_isa(isa_name(isa)), isa);
    EXPECT_FALSE(parse_isa("avx9"));
}

TEST(Buffer, GivesItsMemoryBackBeforeItAsksForMore) {
    Buffer<float> buffer(16);
    const float* before = buffer.data();
    buffer.reset(8);
    EXPECT_EQ(buffer.data(), before);
    EXPECT_EQ(buffer.size(), 8u);
    EXPECT_THROW(buffer.reset((std::size_t{1} << 62) - 1), std::bad_alloc);
    EXPECT_EQ(buffer.data(), nullptr);
    EXPECT_EQ(buffer.size(), 0u);
}

}  // namespace
}  // namespace obscura
