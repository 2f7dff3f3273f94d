#pragma once
// Whether two constructions gave the same tree, and what that tree must be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "hierarchy/multires.h"
#include "raster/interval_map.h"
#include "raster/setup.h"
#include "tests/raster/raster_oracle.h"

namespace obscura {

/// Node by node in the order of the construction, bits of the values included, and the intervals if both have
/// them.
inline ::testing::AssertionResult same_tree(const MultiresTree& a, const MultiresTree& b) {
    if (a.levels != b.levels || a.nodes.size() != b.nodes.size()) {
        return ::testing::AssertionFailure() << a.nodes.size() << " nodes and " << b.nodes.size();
    }
    const auto same = [](const MultiresNode& p, const MultiresNode& q) {
        return std::memcmp(&p.value, &q.value, sizeof p.value) == 0 && p.kinds == q.kinds &&
               (p.kinds == 0 || p.first_child() == q.first_child());
    };
    if (!same(a.root, b.root) || a.root_interval != b.root_interval)
        return ::testing::AssertionFailure() << "root differs";
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        if (!same(a.nodes[i], b.nodes[i])) return ::testing::AssertionFailure() << "node " << i << " differs";
    }
    if (!a.intervals.empty() && !b.intervals.empty() && a.intervals != b.intervals)
        return ::testing::AssertionFailure() << "an interval differs";
    return ::testing::AssertionSuccess();
}

/// Bottom-up over the intervals of the rasterizer.
inline MultiresTree bottom_up_tree(const Mesh& mesh, const LightView& view, Receivers receivers) {
    IntervalParams params;
    params.receivers = receivers;
    return build_bottom_up(interval_map(mesh, view, params, Exec{}).view());
}

/// The records of a view, one by one: no pairs.
inline std::vector<TriangleRecord> records_of(const Mesh& mesh, const LightView& view) {
    TriangleSetup setup;
    SetupParams params;
    params.only_casters = true;
    setup_triangles(mesh, view, params, Exec{}, setup);
    std::vector<TriangleRecord> records;
    for (const RecordBlock& block : setup.blocks) {
        for (std::size_t i = block.begin; i < block.begin + block.count; ++i)
            records.push_back(setup.records[i]);
    }
    return records;
}

/// Intervals of the independent oracle: no tiles, no pairs, 128-bit integers. Slow.
inline Image<DepthInterval> oracle_intervals(const Mesh& mesh, const LightView& view, Receivers receivers) {
    const std::vector<TriangleRecord> records = records_of(mesh, view);
    Image<DepthInterval> map(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x)
            map(x, y) = oracle::interval(oracle::hits_at(records, x, y), receivers == Receivers::static_only);
    }
    return map;
}

/// Squares above the texels whose texels have no common depth, counted from the picture alone.
inline std::uint64_t divided_squares(const Image<DepthInterval>& map) {
    std::uint64_t divided = 0;
    Image<DepthInterval> level = map;
    while (level.width > 1) {
        Image<DepthInterval> up(level.width / 2, level.width / 2);
        for (int y = 0; y < up.height; ++y) {
            for (int x = 0; x < up.width; ++x) {
                DepthInterval all{0, 1};
                for (int k = 0; k < 4; ++k) {
                    const DepthInterval c = level(2 * x + k % 2, 2 * y + k / 2);
                    all = {std::max(all.entry, c.entry), std::min(all.exit, c.exit)};
                }
                up(x, y) = all;
                divided += all.entry > all.exit;
            }
        }
        level = std::move(up);
    }
    return divided;
}

/// Run what takes minutes, too: so for the tests that tests/slow.txt names.
inline bool slow_tests() {
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    return slow != nullptr && std::strcmp(slow, "1") == 0;
}

}  // namespace obscura
