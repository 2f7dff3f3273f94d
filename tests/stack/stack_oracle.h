#pragma once
// What the octree of a stack must be: bottom-up over every texel of every map.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "core/image.h"
#include "hierarchy/certain_tree.h"
#include "hierarchy/combine.h"
#include "hierarchy/multires.h"
#include "hierarchy/stack/stack_shape.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/raster/raster_solids.h"

namespace obscura::oracle {

using Maps = std::vector<Image<DepthInterval>>;

/// Bottom-up with the modes of two, four and eight intervals, whichever children there are: no placeholders
/// but for maps behind the last.
class BottomUpStack {
  public:
    BottomUpStack(const Maps& maps, const StackShape& shape) : maps_(maps), shape_(shape) {
        tree.dimensions = 3;
        tree.levels = shape.levels();
        const Part root = part(tree.levels, 0, 0, 0);
        tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
        tree.root_interval = root.interval;
    }
    MultiresTree tree;

  private:
    struct Part {
        DepthInterval interval;
        std::uint32_t kinds = 0;
        std::uint64_t first_child = 0;
    };

    /// x, y, k: of the node's first texel.
    Part part(int height, int x, int y, int k) {
        if (height == 0) {
            const auto map = static_cast<std::size_t>(k);
            return {map < maps_.size() ? maps_[map](x, y) : DepthInterval{0.0f, 1.0f}, 0, 0};
        }
        const int side = 1 << shape_.side_exponent(height - 1), run = 1 << shape_.slices_exponent(height - 1);
        const bool across = shape_.divides_map(height), along = shape_.divides_slices(height);
        std::vector<Part> child;
        std::vector<int> place;
        for (int i = 0; i < 8; ++i) {
            if ((i & 3) != 0 && !across) continue;
            if ((i & 4) != 0 && !along) continue;
            child.push_back(
                part(height - 1, x + (i & 1) * side, y + (i >> 1 & 1) * side, k + (i >> 2) * run));
            place.push_back(i);
        }
        if (child.size() == 2) return joined<2>(child, place);
        if (child.size() == 4) return joined<4>(child, place);
        return joined<8>(child, place);
    }

    template <int count>
    Part joined(const std::vector<Part>& child, const std::vector<int>& place) {
        DepthInterval intervals[count];
        for (std::size_t i = 0; i < count; ++i)
            intervals[i] = child[i].interval;
        const Combined combined = combine(intervals);
        Part result{combined.interval, 0, tree.nodes.size()};
        for (std::size_t i = 0; i < count; ++i) {
            const bool covered = (combined.covered >> i & 1u) != 0, inner = child[i].kinds != 0;
            if (covered && !inner) continue;
            const ChildKind kind = covered ? ChildKind::empty : (inner ? ChildKind::full : ChildKind::leaf);
            result.kinds |= static_cast<std::uint32_t>(kind) << (2 * place[i]);
            tree.nodes.push_back(
                {covered ? 0.0f : stored_depth(child[i].interval), child[i].kinds, child[i].first_child});
        }
        return result;
    }

    const Maps& maps_;
    StackShape shape_;
};

/// Node by node on the way down, bits of the values included; the order in memory may differ.
inline bool same_below(const MultiresTree& a, const MultiresNode& p, const MultiresTree& b,
                       const MultiresNode& q) {
    if (p.kinds != q.kinds) return false;
    std::uint64_t i = p.first_child(), j = q.first_child();
    for (int c = 0; c < 1 << a.dimensions; ++c) {
        if (p.child(c) == ChildKind::none) continue;
        const MultiresNode &m = a.nodes[i++], &n = b.nodes[j++];
        if (p.child(c) != ChildKind::empty && std::memcmp(&m.value, &n.value, sizeof m.value) != 0)
            return false;
        if (!same_below(a, m, b, n)) return false;
    }
    return true;
}

inline ::testing::AssertionResult same_octree(const MultiresTree& a, const MultiresTree& b) {
    if (a.dimensions != b.dimensions || a.levels != b.levels || a.nodes.size() != b.nodes.size())
        return ::testing::AssertionFailure() << a.nodes.size() << " nodes and " << b.nodes.size();
    const bool root = std::memcmp(&a.root.value, &b.root.value, sizeof a.root.value) == 0 &&
                      a.root_interval == b.root_interval;
    if (!root || !same_below(a, a.root, b, b.root)) return ::testing::AssertionFailure() << "nodes differ";
    return ::testing::AssertionSuccess();
}

/// The certain squares of a map, from its texels.
inline CertainTree certain_tree_of(const Image<DepthInterval>& map) {
    CertainBuilder builder;
    const auto build = [&](const auto& self, int x, int y, int side) -> CertainBuilder::Part {
        if (side == 1) return CertainBuilder::texel(map(x, y));
        const int half = side / 2;
        const CertainBuilder::Part child[4] = {self(self, x, y, half), self(self, x + half, y, half),
                                               self(self, x, y + half, half),
                                               self(self, x + half, y + half, half)};
        return builder.join(child);
    };
    CertainTree tree;
    tree.root = build(build, 0, 0, map.width).square();
    for (int side = 1; side < map.width; side *= 2)
        ++tree.levels;
    tree.groups = builder.nodes;
    return tree;
}

/// Maps whose texels mostly take what the map before has, of few depths, so that bounds coincide and tie;
/// `blocks`: the side of what is equal in a map.
inline Maps drawn_maps(std::uint32_t seed, int side, int count, int blocks, int kept_percent) {
    std::mt19937 rng(seed);
    const auto below = [&](unsigned n) { return static_cast<int>(rng() % n); };
    Maps maps(static_cast<std::size_t>(count), Image<DepthInterval>(side, side));
    for (std::size_t k = 0; k < maps.size(); ++k) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const int bx = x / blocks * blocks, by = y / blocks * blocks;
                if (bx != x || by != y) {
                    maps[k](x, y) = maps[k](bx, by);
                } else if (k > 0 && below(100) < kept_percent) {
                    maps[k](x, y) = maps[k - 1](x, y);
                } else {
                    const int entry = below(13), exit = entry + below(5);
                    maps[k](x, y) = {static_cast<float>(entry) / 16.0f, static_cast<float>(exit) / 16.0f};
                }
            }
        }
    }
    return maps;
}

/// Solids under a light that turns by a little from map to map.
inline std::vector<LightView> turning_views(const Mesh& mesh, int side, int count, double turn) {
    std::vector<LightView> views;
    for (int k = 0; k < count; ++k) {
        const double t = turn * (k - count / 2);
        views.push_back(
            orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3 + t, -1, 0.2 - t / 2}), side));
    }
    return views;
}

inline Maps interval_maps(const Mesh& mesh, const std::vector<LightView>& views, Receivers receivers) {
    Maps maps;
    IntervalParams params;
    params.receivers = receivers;
    for (const LightView& view : views)
        maps.push_back(interval_map(mesh, view, params, Exec{}));
    return maps;
}

}  // namespace obscura::oracle
