// Lookups in a serialised tree, sixteen points at a time.

#include "hierarchy/codes/query.h"

#include "hierarchy/codes/tree_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Groups that go down side by side, so that one's memory accesses hide behind the other's.
constexpr int together = 2;

/// Points of one group. Lanes beyond the last point, or outside the map, stand at texel (0, 0) and are not
/// `inside`.
struct Group16 {
    I32 x, y;
    F32 depth;
    std::uint32_t valid, inside;
};

OBSCURA_INLINE Group16 group_at(const MapPoints& p, std::size_t first, std::int32_t size) {
    Group16 g;
    g.valid = 0xffffu;
    if (p.count - first >= 16) {
        g.x = load(p.x + first);
        g.y = load(p.y + first);
        g.depth = load(p.depth + first);
    } else {
        alignas(64) std::int32_t x[16] = {}, y[16] = {};
        alignas(64) float depth[16] = {};
        const int rest = static_cast<int>(p.count - first);
        for (int k = 0; k < rest; ++k) {
            x[k] = p.x[first + static_cast<std::size_t>(k)];
            y[k] = p.y[first + static_cast<std::size_t>(k)];
            depth[k] = p.depth[first + static_cast<std::size_t>(k)];
        }
        g.x = load(x);
        g.y = load(y);
        g.depth = load(depth);
        g.valid = (1u << rest) - 1u;
    }
    // In the map no bit above the size's is set, the sign's included.
    const Mask inside = ~any_bit(g.x | g.y, splat(-size)) & mask_of(g.valid);
    g.inside = bits(inside);
    const I32 zero = splat(std::int32_t{0});
    g.x = select(inside, g.x, zero);
    g.y = select(inside, g.y, zero);
    return g;
}

OBSCURA_INLINE std::uint16_t lit_bits(const Group16& g, const F32& stored) {
    return static_cast<std::uint16_t>((bits(less_equal(g.depth, stored)) | ~g.inside) & g.valid);
}

/// Through the dense top grid if there is one and the descent goes below it; else from the root. Returns the
/// height where the lanes stand.
template <class Code>
OBSCURA_INLINE int enter(const TreeCode& tree, const I32& x, const I32& y, std::uint32_t inside, int level,
                         Descents16<Code>& d) {
    const int grid = tree.levels - tree.top_levels;
    d = descents_from<Code>(Code::root(tree), mask_of(inside));
    if (tree.top == nullptr || level > grid) return tree.levels;
    const I32 entry = shift_right(y, grid) * splat(1 << tree.top_levels) + shift_right(x, grid);
    const auto* entries = reinterpret_cast<const std::uint8_t*>(tree.top);
    const I32 at = Code::counts_values ? entry + entry : entry;
    const I32 node = gather_bytes<8>(entries, at), bias = splat(biased(0));
    d.inner = d.inner & ~equal(node, splat(std::int32_t{-1}));
    d.node = select(d.inner, node ^ bias, d.node);
    d.value = gather_bytes<8>(entries + 4, at) ^ bias;
    if constexpr (Code::counts_values) {
        d.count = gather_bytes<8>(entries + 8, at);
        d.inside = gather_bytes<8>(entries + 12, at);
    }
    return grid;
}

/// Groups of points from `first` on, `n` of them, each lane on its own way.
template <class Code, int n>
OBSCURA_INLINE void descend_groups(const TreeCode& tree, const Group16 (&group)[n], int level,
                                   F32 (&stored)[n]) {
    const std::uint8_t* base = biased_units<Code>(tree);
    Descents16<Code> d[n];
    int height = 0;
    for (int k = 0; k < n; ++k)
        height = enter<Code>(tree, group[k].x, group[k].y, group[k].inside, level, d[k]);
    for (; height > level; --height) {
        Mask inner = d[0].inner;
        for (int k = 1; k < n; ++k)
            inner = inner | d[k].inner;
        if (none(inner)) break;
        for (int k = 0; k < n; ++k)
            descend(Code{}, tree, base, height, child_bit(height, group[k].x, group[k].y), d[k]);
    }
    for (int k = 0; k < n; ++k)
        stored[k] = values_of<Code>(tree, base, d[k], group[k].x, group[k].y, level);
}

template <class Code>
void visibility_of(const TreeCode& tree, const MapPoints& points, int level, std::uint16_t* lit) {
    const std::int32_t size = 1 << tree.levels;
    std::size_t first = 0;
    for (; points.count - first >= 16 * together; first += 16 * together) {
        Group16 group[together];
        F32 stored[together];
        for (std::size_t k = 0; k < together; ++k)
            group[k] = group_at(points, first + 16 * k, size);
        descend_groups<Code>(tree, group, level, stored);
        for (std::size_t k = 0; k < together; ++k)
            lit[first / 16 + k] = lit_bits(group[k], stored[k]);
    }
    for (; first < points.count; first += 16) {
        const Group16 group[1] = {group_at(points, first, size)};
        F32 stored[1];
        descend_groups<Code>(tree, group, level, stored);
        lit[first / 16] = lit_bits(group[0], stored[0]);
    }
}

/// One block of neighbours: together to their lowest common node, each on its own from there.
template <class Code>
OBSCURA_INLINE F32 stored_of_block(const TreeCode& tree, const std::uint8_t* base, const Group16& g,
                                   int level, std::int32_t x0, std::int32_t y0, TreePath& path) {
    const Mask inside = mask_of(g.inside);
    const I32 apart = select(inside, (g.x ^ splat(x0)) | (g.y ^ splat(y0)), splat(std::int32_t{0}));
    const int parted = common_height(united_bits(apart));
    const int height = parted > level ? parted : level;
    Descents16<Code> d;
    if (tree.top != nullptr && height > tree.levels - tree.top_levels) {
        // Far apart: each from its own place in the grid.
        const int at = enter<Code>(tree, g.x, g.y, g.inside, level, d);
        descend_to<Code>(tree, base, at, level, g.x, g.y, d);
        return values_of<Code>(tree, base, d, g.x, g.y, level);
    }
    const TreePlace place = extend_path<Code>(tree, x0, y0, height, path);
    if (height == level || place.node == no_tree_node) {
        if constexpr (!Code::varies) return splat(Code::depth(tree, place));
    }
    d = descents_from<Code>(place, inside);
    descend_to<Code>(tree, base, height, level, g.x, g.y, d);
    return values_of<Code>(tree, base, d, g.x, g.y, level);
}

template <class Code>
void coherent_visibility_of(const TreeCode& tree, const MapPoints& points, int level, std::uint16_t* lit) {
    const std::int32_t size = 1 << tree.levels;
    const std::uint8_t* base = biased_units<Code>(tree);
    TreePath path;
    start_path<Code>(tree, path);
    for (std::size_t first = 0; first < points.count; first += 16) {
        const Group16 g = group_at(points, first, size);
        if (g.inside == 0) {
            lit[first / 16] = static_cast<std::uint16_t>(g.valid);
            continue;
        }
        const auto lane = first + static_cast<std::size_t>(__builtin_ctz(g.inside));
        lit[first / 16] =
            lit_bits(g, stored_of_block<Code>(tree, base, g, level, points.x[lane], points.y[lane], path));
    }
}

}  // namespace

void stored_values(const TreeCode& tree, const std::int32_t* x, const std::int32_t* y, std::size_t count,
                   int level, float* value) noexcept {
    with_code(tree, [&]<class Code>(Code) {
        const MapPoints points{x, y, value, count};  // depths are not looked at
        for (std::size_t first = 0; first < count; first += 16) {
            const Group16 group[1] = {group_at(points, first, 1 << tree.levels)};
            F32 stored[1];
            descend_groups<Code>(tree, group, level, stored);
            if (count - first >= 16) {
                store(value + first, stored[0]);
                continue;
            }
            alignas(64) float rest[16];
            store(rest, stored[0]);
            for (std::size_t k = 0; k < count - first; ++k)
                value[first + k] = rest[k];
        }
    });
}

void visibility(const TreeCode& tree, const MapPoints& points, int level, std::uint16_t* lit) noexcept {
    with_code(tree, [&]<class Code>(Code) { visibility_of<Code>(tree, points, level, lit); });
}

void coherent_visibility(const TreeCode& tree, const MapPoints& points, int level,
                         std::uint16_t* lit) noexcept {
    with_code(tree, [&]<class Code>(Code) { coherent_visibility_of<Code>(tree, points, level, lit); });
}

}  // namespace obscura::OBSCURA_ISA
