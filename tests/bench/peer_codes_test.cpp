// Codes of others, as they stand beside ours in the bench: they find depths of every texel's interval, and
// are as small as their papers' rules allow.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <random>

#include "bench/peer_codes/interval_bands.h"
#include "bench/peer_codes/scanlines.h"
#include "bench/peer_codes/voxel_dag.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/hierarchy/lossless.h"

namespace obscura {
namespace {

TEST(Scanlines, FindDepthsOfEveryInterval) {
    std::uint64_t constant_bytes = 0, linear_bytes = 0;
    for_each_solid_map([&](const Image<DepthInterval>& map, const std::string& name) {
        ScanlineMap constant(ScanFit::constant), linear(ScanFit::linear);
        for (int y = 0; y < map.height; ++y) {
            const std::span row(map.row(y), static_cast<std::size_t>(map.width));
            constant.add_row(row);
            linear.add_row(row);
        }
        int outside = 0;
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                for (const ScanlineMap* code : {&constant, &linear}) {
                    const float z = code->depth(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
                    outside += map(x, y).entry <= z && z <= map(x, y).exit ? 0 : 1;
                }
            }
        }
        EXPECT_EQ(outside, 0) << name;
        constant_bytes += constant.bytes() / 2;  // in segments
        linear_bytes += linear.bytes() / 3;
    });
    EXPECT_LT(linear_bytes, constant_bytes) << "lines serve more texels";
}

/// Whether one line of real numbers goes through all intervals: every two texels bound its slope.
bool has_line(std::span<const DepthInterval> row, ScanFit fit) {
    double least = fit == ScanFit::linear ? -1e9 : 0, most = -least;
    for (std::size_t p = 0; p < row.size(); ++p) {
        for (std::size_t q = p + 1; q < row.size(); ++q) {
            const auto d = static_cast<double>(q - p);
            least = std::max(least, (double{row[q].entry} - row[p].exit) / d);
            most = std::min(most, (double{row[q].exit} - row[p].entry) / d);
        }
    }
    return least <= most;
}

TEST(Scanlines, AreTheFewestSegments) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> depth(0.2f, 0.8f), width(0.01f, 0.3f);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<DepthInterval> row(30);
        const float tilt = 0.02f * static_cast<float>(trial % 5);
        for (std::size_t i = 0; i < row.size(); ++i) {
            const float entry = 0.3f * depth(random) + tilt * static_cast<float>(i % 11);
            row[i] = {entry, entry + width(random)};
        }
        for (const ScanFit fit : {ScanFit::constant, ScanFit::linear}) {
            std::vector<std::size_t> fewest(row.size() + 1, 0);
            for (std::size_t end = 1; end <= row.size(); ++end) {
                fewest[end] = end;
                for (std::size_t begin = 0; begin < end; ++begin) {
                    if (has_line(std::span(row).subspan(begin, end - begin), fit))
                        fewest[end] = std::min(fewest[end], fewest[begin] + 1);
                }
            }
            std::vector<ScanSegment> segments;
            fit_row(row, fit, segments);
            EXPECT_EQ(segments.size(), fewest.back()) << trial;
        }
    }
}

/// Cubes of a dense grid that are not all of one kind, counted once each, from 4 voxels a side up.
std::vector<std::size_t> distinct_cubes(const VoxelDag& dag, int levels) {
    const std::uint32_t side = 1u << levels;
    std::vector<int> grid(std::size_t{1} << (3 * levels));
    const auto at = [](std::uint32_t x, std::uint32_t y, std::uint32_t z, int log2_side) {
        return (std::size_t{z} << (2 * log2_side)) + (std::size_t{y} << log2_side) + x;
    };
    for (std::uint32_t z = 0; z < side; ++z)
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x)
                grid[at(x, y, z, levels)] = dag.lit(x, y, z) ? 1 : 0;
    std::vector<std::size_t> counts;
    for (int level = 1; level <= levels; ++level) {
        const int upper = levels - level;
        std::vector<int> above(std::size_t{1} << (3 * upper));
        std::map<std::array<int, 8>, int> numbers;
        for (std::uint32_t z = 0; z < 1u << upper; ++z) {
            for (std::uint32_t y = 0; y < 1u << upper; ++y) {
                for (std::uint32_t x = 0; x < 1u << upper; ++x) {
                    std::array<int, 8> octants{};
                    for (std::uint32_t i = 0; i < 8; ++i)
                        octants[i] =
                            grid[at(2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2), upper + 1)];
                    const bool alike = std::all_of(octants.begin(), octants.end(),
                                                   [&](int id) { return id == octants[0] && id < 2; });
                    above[at(x, y, z, upper)] =
                        alike ? octants[0]
                              : numbers.try_emplace(octants, static_cast<int>(numbers.size()) + 2)
                                    .first->second;
                }
            }
        }
        if (level >= leaf_level) counts.push_back(numbers.size());
        grid = std::move(above);
    }
    return counts;
}

VoxelDag voxel_dag(const Image<DepthInterval>& map, int rows) {
    VoxelDag dag(std::countr_zero(static_cast<unsigned>(map.width)));
    for (int y = 0; y < map.height; y += rows)
        dag.add_band(map.view().crop(0, y, map.width, rows));
    dag.finish();
    return dag;
}

TEST(VoxelDag, IsExactWhereverVoxelsAreFineEnough) {
    int maps = 0;
    for_each_solid_map([&](const Image<DepthInterval>& map, const std::string& name) {
        if (++maps % 7 != 1) return;  // 2 million voxels each
        const int levels = 7;
        const VoxelDag dag = voxel_dag(map, map.height);
        std::uint64_t rounded = 0, wrong = 0;
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                const VoxelRange range = voxel_range(map(x, y), levels);
                rounded += range.empty() ? 1 : 0;
                const std::int32_t last = std::max(range.first, range.last);
                for (std::int32_t z = 0; z < map.width; ++z) {
                    const bool lit = dag.lit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                             static_cast<std::uint32_t>(z));
                    wrong += (z < range.first && !lit) || (z >= last && lit) ? 1 : 0;
                }
            }
        }
        EXPECT_EQ(wrong, 0u) << name;
        EXPECT_EQ(dag.rounded_texels(), rounded) << name;
    });
    EXPECT_GT(maps, 7);
}

TEST(VoxelDag, HasEveryCubeOnceWhateverTheBands) {
    int maps = 0;
    for_each_solid_map([&](const Image<DepthInterval>& map, const std::string& name) {
        if (++maps % 13 != 1) return;
        const VoxelDag dag = voxel_dag(map, map.height);
        const std::vector<std::size_t> counts = dag.counts();
        EXPECT_EQ(counts, distinct_cubes(dag, 7)) << name;
        for (const int rows : {1, 8, 32}) {
            const VoxelDag banded = voxel_dag(map, rows);
            EXPECT_EQ(banded.counts(), counts) << name;
            EXPECT_EQ(banded.bytes(), dag.bytes()) << name;
        }
    });
}

TEST(VoxelDag, RangesAreBoundariesInsideIntervals) {
    const auto range = [](float entry, float exit) { return voxel_range({entry, exit}, 3); };
    EXPECT_EQ(range(0.25f, 0.5f).first, 2);
    EXPECT_EQ(range(0.25f, 0.5f).last, 4);
    EXPECT_EQ(range(0.26f, 0.49f).first, 3);
    EXPECT_EQ(range(0.26f, 0.49f).last, 3);
    EXPECT_TRUE(range(0.26f, 0.3f).empty());
    EXPECT_EQ(range(1, 1).first, 8);
    EXPECT_EQ(range(0, 0).last, 0);
}

// A wall across a map: the shadow behind it is the same for all depths, and its cubes are the same all along.
TEST(VoxelDag, AWallCostsItsLevelsAlone) {
    for (const int side : {64, 256}) {
        Image<DepthInterval> map(side, side, DepthInterval{0.75f, 0.75f});
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side / 2 + 1; ++x)
                map(x, y) = {0.25f, 0.25f};
        std::size_t cubes = 0;
        const VoxelDag dag = voxel_dag(map, 16);
        for (const std::size_t count : dag.counts())
            cubes += count;
        EXPECT_LE(cubes, 4u * static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(side))));
        EXPECT_EQ(dag.rounded_texels(), 0u);
    }
}

TEST(IntervalBands, AreTheMapInPieces) {
    const Mesh mesh = solids::random_solids(3, 40, false, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), {0.3, -1, 0.2}, 128);
    const Image<DepthInterval> whole = interval_map(mesh, view, {}, {});
    int next = 0;
    for_each_band(mesh, view, 48, {}, [&](int y, ImageView<const DepthInterval> band) {
        EXPECT_EQ(y, next);
        next = y + band.height;
        for (int row = 0; row < band.height; ++row)
            EXPECT_TRUE(std::equal(band.row(row), band.row(row) + band.width, whole.row(y + row)));
    });
    EXPECT_EQ(next, 128);
}

}  // namespace
}  // namespace obscura
