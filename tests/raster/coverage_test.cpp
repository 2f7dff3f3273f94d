// Coverage and depth of single triangles: every kernel against 128-bit integers.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/isa.h"
#include "raster/coverage.h"
#include "raster/depth_tile.h"
#include "tests/raster/raster_oracle.h"

namespace obscura {
namespace {

constexpr int side = 64;

struct Tile {
    std::vector<float> depth = std::vector<float>(side * side, 1.0f);
    std::vector<std::uint32_t> triangle = std::vector<std::uint32_t>(side * side, no_triangle);
};

Tile rasterize(const std::vector<TriangleRecord>& records, const TileRect& rect, Isa isa) {
    std::vector<std::uint32_t> list(records.size());
    for (std::size_t i = 0; i < list.size(); ++i)
        list[i] = static_cast<std::uint32_t>(i);
    Tile tile;
    OBSCURA_DISPATCH(isa, visibility_tile, records.data(), list.data(), list.size(), rect, tile.depth.data(),
                     tile.triangle.data());
    Tile depth_only;
    OBSCURA_DISPATCH(isa, depth_tile, records.data(), list.data(), list.size(), rect,
                     depth_only.depth.data());
    EXPECT_EQ(depth_only.depth, tile.depth) << isa_name(isa);
    return tile;
}

Tile brute_force(const std::vector<TriangleRecord>& records, const TileRect& rect) {
    Tile tile;
    for (const TriangleRecord& t : records) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const std::int64_t sx = (std::int64_t{rect.x0} + x) * 256 + rect.sample_x;
                const std::int64_t sy = (std::int64_t{rect.y0} + y) * 256 + rect.sample_y;
                if (!oracle::covers(t.x, t.y, sx, sy)) continue;
                const float z =
                    oracle::depth(t, static_cast<double>(sx) / 256.0, static_cast<double>(sy) / 256.0);
                const auto i = static_cast<std::size_t>(y * side + x);
                if (z < tile.depth[i]) tile.depth[i] = z, tile.triangle[i] = t.triangle;
            }
        }
    }
    return tile;
}

/// A record through three fixed-point corners, turned the way setup turns them; empty area is left out.
void add(std::vector<TriangleRecord>& records, std::int64_t x0, std::int64_t y0, std::int64_t x1,
         std::int64_t y1, std::int64_t x2, std::int64_t y2, double a = 0, double b = 0, double c = 0.5) {
    const std::int64_t area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
    if (area == 0) return;
    if (area < 0) std::swap(x1, x2), std::swap(y1, y2);
    const auto i32 = [](std::int64_t v) { return static_cast<std::int32_t>(v); };
    records.push_back({{i32(x0), i32(x1), i32(x2)},
                       {i32(y0), i32(y1), i32(y2)},
                       a,
                       b,
                       c,
                       0.0f,
                       1.0f,
                       static_cast<std::uint32_t>(records.size()),
                       Crossing::entry});
}

void expect_all_equal(const std::vector<TriangleRecord>& records, const TileRect& rect) {
    const Tile expected = brute_force(records, rect);
    for (const Isa isa : supported_isas()) {
        const Tile actual = rasterize(records, rect, isa);
        ASSERT_EQ(actual.triangle, expected.triangle) << isa_name(isa);
        ASSERT_EQ(actual.depth, expected.depth) << isa_name(isa);
    }
}

TEST(Coverage, RandomTrianglesOfEverySizeMatchExactIntegers) {
    std::mt19937 rng(7);
    for (int round = 0; round < 60; ++round) {
        // Sizes from below a texel to many maps; corners often exactly on texel centres or edges.
        const int bits = 5 + round % 20;
        std::uniform_int_distribution<std::int64_t> offset(-(std::int64_t{1} << bits),
                                                           std::int64_t{1} << bits);
        std::uniform_int_distribution<int> grid_choice(0, 3);
        std::uniform_real_distribution<double> slope(-1e-3, 1e-3);
        const TileRect rect{(round % 5) * 1000, (round % 3) * 70000, side, side, 128, 128};
        std::vector<TriangleRecord> records;
        for (int i = 0; i < 40; ++i) {
            const std::int64_t grid = std::int64_t{1} << (grid_choice(rng) * 3);  // 1, 8, 64, 512
            const auto place = [&](std::int64_t centre) {
                return (centre + offset(rng)) / grid * grid + grid / 2;
            };
            const std::int64_t cx = (rect.x0 + side / 2) * 256, cy = (rect.y0 + side / 2) * 256;
            const double a = slope(rng), b = slope(rng);
            add(records, place(cx), place(cy), place(cx), place(cy), place(cx), place(cy), a, b,
                0.5 - a * rect.x0 - b * rect.y0);
        }
        expect_all_equal(records, rect);
    }
}

TEST(Coverage, OtherSamplePositionsMatchToo) {
    std::mt19937 rng(11);
    std::uniform_int_distribution<std::int64_t> place(-20 * 256, 84 * 256);
    for (const auto& [sx, sy] :
         {std::pair{0, 0}, std::pair{255, 255}, std::pair{96, 32}, std::pair{8, 200}}) {
        std::vector<TriangleRecord> records;
        for (int i = 0; i < 50; ++i) {
            add(records, place(rng), place(rng), place(rng), place(rng), place(rng), place(rng), 1e-4, -2e-4,
                0.5);
        }
        expect_all_equal(records, {0, 0, side, side, sx, sy});
    }
}

TEST(Coverage, ImplausiblyLargeTrianglesUseTheWideLanes) {
    // Corners across the whole guard band of a 2^20 map.
    std::mt19937 rng(3);
    std::uniform_int_distribution<std::int64_t> place(-(std::int64_t{1} << 28), std::int64_t{1} << 29);
    const TileRect rect{524288, 524288, side, side, 128, 128};
    const std::int64_t c = (524288 + 32) * 256;
    std::vector<TriangleRecord> records;
    while (records.size() < 200) {
        // One edge passes near the tile's middle, so that the tile is really crossed.
        const std::int64_t x = place(rng), y = place(rng);
        std::uniform_int_distribution<std::int64_t> near(-4000, 4000);
        add(records, x, y, std::min<std::int64_t>(2 * c - x + near(rng), 1 << 29),
            std::min<std::int64_t>(2 * c - y + near(rng), 1 << 29), place(rng), place(rng), 1e-9, -1e-9, 0.5);
    }
    expect_all_equal(records, rect);
}

TEST(Coverage, SharedEdgesBelongToExactlyOneTriangle) {
    // A fan of triangles round a vertex that lies on a texel centre, corners on centres and between them.
    std::mt19937 rng(5);
    for (int round = 0; round < 40; ++round) {
        const std::int64_t cx = 32 * 256 + 128, cy = 32 * 256 + 128;
        const std::int64_t ring[8][2] = {{10, 10}, {32, 4},  {55, 9}, {60, 32},
                                         {54, 56}, {32, 60}, {9, 54}, {4, 32}};
        std::uniform_int_distribution<std::int64_t> jitter(-300, 300);
        std::int64_t px[8], py[8];
        for (int i = 0; i < 8; ++i) {
            const bool exact = (round + i) % 2 == 0;
            px[i] = ring[i][0] * 256 + 128 + (exact ? 0 : jitter(rng));
            py[i] = ring[i][1] * 256 + 128 + (exact ? 0 : jitter(rng));
        }
        std::vector<TriangleRecord> fan;
        for (int i = 0; i < 8; ++i)
            add(fan, cx, cy, px[i], py[i], px[(i + 1) % 8], py[(i + 1) % 8]);
        ASSERT_EQ(fan.size(), 8u);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                int count = 0;
                for (const TriangleRecord& t : fan)
                    count += covers(t, x, y);
                ASSERT_LE(count, 1) << x << "," << y;
                if (std::abs(x - 32) + std::abs(y - 32) < 20) {
                    ASSERT_EQ(count, 1) << x << "," << y;
                }
            }
        }
        expect_all_equal(fan, {0, 0, side, side, 128, 128});
    }
}

TEST(Coverage, OppositeFacingsCoverTheSameSamples) {
    std::mt19937 rng(9);
    std::uniform_int_distribution<std::int64_t> place(0, 64 * 2);
    for (int i = 0; i < 300; ++i) {
        const std::int64_t x[3] = {place(rng) * 128, place(rng) * 128, place(rng) * 128};
        const std::int64_t y[3] = {place(rng) * 128, place(rng) * 128, place(rng) * 128};
        std::vector<TriangleRecord> front, back;
        add(front, x[0], y[0], x[1], y[1], x[2], y[2]);
        add(back, x[0], y[0], x[2], y[2], x[1], y[1]);
        if (front.empty()) continue;
        const TileRect rect{0, 0, side, side, 128, 128};
        ASSERT_EQ(rasterize(front, rect, Isa::ref).triangle, rasterize(back, rect, Isa::ref).triangle);
    }
}

TEST(Depth, IsMonotoneAlongRowsAndColumns) {
    std::mt19937 rng(13);
    std::uniform_real_distribution<double> slope(-1e-4, 1e-4);
    for (int i = 0; i < 200; ++i) {
        std::vector<TriangleRecord> one;
        add(one, -(1 << 20), -(1 << 20), 1 << 22, 0, 0, 1 << 22, slope(rng), slope(rng), 0.5);
        const bool up = one[0].a >= 0;
        for (int x = 1; x < 4000; x += 7) {
            const float p = depth_at(one[0], x - 0.5, 100.5), q = depth_at(one[0], x + 0.5, 100.5);
            ASSERT_TRUE(up ? p <= q : p >= q);
        }
    }
}

}  // namespace
}  // namespace obscura
