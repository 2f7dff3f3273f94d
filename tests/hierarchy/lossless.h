#pragma once
// What every code that chooses values itself must keep to: depths of the texels' intervals, nodes of the
// tree.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/combine.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {

/// Every texel's depth lies in its interval, zero tolerance; the top grid finds the same.
inline void expect_lossless(const Image<DepthInterval>& map, const EncodeParams& params,
                            const std::string& name) {
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

/// Every node has its twin in the tree it was made of, and its value is one of the twin's interval.
inline void expect_same_topology(const ShadowTree& encoded, const MultiresTree& tree) {
    const MultiresTree behind = tree_behind(encoded, tree);
    ASSERT_EQ(behind.nodes.size(), tree.nodes.size());
    ASSERT_EQ(behind.root.kinds, tree.root.kinds);
    ASSERT_TRUE(contains(tree.root_interval, behind.root.value));
    std::vector<char> has_value(tree.nodes.size(), 0);
    const auto mark = [&](const MultiresNode& parent) {
        std::uint64_t at = parent.first_child();
        for (int i = 0; i < 4; ++i) {
            const ChildKind kind = parent.child(i);
            if (kind == ChildKind::none) continue;
            has_value[at++] = kind != ChildKind::empty;
        }
    };
    mark(tree.root);
    for (const MultiresNode& node : tree.nodes)
        if (node.kinds != 0) mark(node);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        ASSERT_EQ(behind.nodes[i].kinds, tree.nodes[i].kinds);
        if (has_value[i] != 0) {
            ASSERT_TRUE(contains(tree.intervals[i], behind.nodes[i].value)) << "node " << i;
        }
    }
}

/// Calls check(map, name) for solids that touch, nest, coincide, cross and are open or turned inside out, in
/// every kind of view, for both kinds of receivers.
template <class Check>
void for_each_solid_map(const Check& check) {
    const Vec3d ways[] = {{0.3, -1, 0.2}, {1, -0.12, 0.4}, {0, -1, 0}};
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        for (const bool open : {false, true}) {
            const Mesh mesh = solids::random_solids(seed + 20, 60, open, seed % 2 == 0);
            const Bounds b = bounds_of(mesh);
            for (const Vec3d& way : ways) {
                const Vec3d to = normalize(way), middle = (b.low + b.high) * 0.5;
                const LightView views[] = {
                    orthographic_light_view(b, to, 128),
                    perspective_light_view(middle - to * 14.0, to, 40, 4, 30, 128),
                };
                for (const LightView& view : views) {
                    for (const Receivers receivers : {Receivers::any, Receivers::static_only}) {
                        IntervalParams params;
                        params.receivers = receivers;
                        check(interval_map(mesh, view, params, Exec{}), "solids " + std::to_string(seed));
                    }
                }
            }
        }
    }
}

}  // namespace obscura
