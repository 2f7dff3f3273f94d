// Intervals of a block in four vectors of 4 x 4 texels.

#include "hierarchy/block.h"

#include "core/simd.h"
#include "raster/layer_tile.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Column and row, in a 4 x 4 square, of the lanes.
alignas(64) constexpr std::int32_t lane_column[16] = {0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3};
alignas(64) constexpr std::int32_t lane_row[16] = {0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3};
alignas(64) constexpr std::int64_t lane_column_64[16] = {0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3};
alignas(64) constexpr std::int64_t lane_row_64[16] = {0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3};

/// An edge function at the block's first texel centre, and its steps, all over 256 (see raster/tile_walk.h).
struct BlockEdge {
    std::int64_t e = 0, A = 0, B = 0;
};
BlockEdge block_edge(const TriangleRecord& t, int k, std::int32_t x0, std::int32_t y0) {
    const int n = k == 2 ? 0 : k + 1;
    BlockEdge f;
    f.A = static_cast<std::int64_t>(t.y[k]) - t.y[n];
    f.B = static_cast<std::int64_t>(t.x[n]) - t.x[k];
    const std::int64_t px = static_cast<std::int64_t>(x0) * subtexel_one + 128;
    const std::int64_t py = static_cast<std::int64_t>(y0) * subtexel_one + 128;
    const std::int64_t keeps_its_edge = (f.A > 0) | ((f.A == 0) & (f.B > 0));
    f.e = (f.A * (px - t.x[k]) + f.B * (py - t.y[k]) + keeps_its_edge - 1) >> subtexel_bits;
    return f;
}

/// Keys of the crossings of 4 x 4 texels, kind by kind; no_layer where a facet does not cover.
struct Crossings {
    I32 entry[block_facets], open[block_facets], exit[block_facets];
    int entries = 0, opens = 0, exits = 0;
};

/// Texels of the 4 x 4 square at (column, row) of the block that lie inside all edges.
Mask inside(const BlockEdge* edge, int edges, int column, int row) {
    std::uint32_t all = 0xffffu;
    Mask mask = mask_of(all);
    for (int k = 0; k < edges; ++k) {
        const std::int64_t first = edge[k].e + edge[k].A * column + edge[k].B * row;
        const std::int64_t dx = 3 * edge[k].A, dy = 3 * edge[k].B;
        const std::int64_t low = first + (dx < 0 ? dx : 0) + (dy < 0 ? dy : 0);
        const std::int64_t high = first + (dx > 0 ? dx : 0) + (dy > 0 ? dy : 0);
        if (low >= 0) continue;
        if (high < 0) return mask_of(0);
        if (low >= INT32_MIN && high <= INT32_MAX) {
            // Products may wrap, the sums lie between low and high again.
            const I32 e = splat(static_cast<std::int32_t>(first)) +
                          splat(static_cast<std::int32_t>(edge[k].A)) * load(lane_column) +
                          splat(static_cast<std::int32_t>(edge[k].B)) * load(lane_row);
            mask = mask & not_negative(e);
        } else {
            const I64 e =
                splat(first) + splat(edge[k].A) * load(lane_column_64) + splat(edge[k].B) * load(lane_row_64);
            mask = mask & not_negative(e);
        }
    }
    return mask;
}

I32 keys_of(const TriangleRecord& t, const F64& X, const F64& Y) {
    const F64 z = splat(t.a) * X + (splat(t.b) * Y + splat(t.c));
    const F32 depth = max(min(to_f32(z), splat(t.zmax)), splat(t.zmin));
    return (shift_left<2>(bitcast_i32(depth)) | splat(static_cast<std::int32_t>(t.crossing))) ^
           splat(INT32_MIN);
}

F32 depths_of(const I32& keys) {
    // The sign bit is turned back first; depths are below 2^30, so the arithmetic shift leaves two clear
    // bits.
    const I32 turned = keys ^ splat(INT32_MIN);
    return bitcast_f32(shift_right<2>(turned) & splat(0x3fffffff));
}

struct Intervals {
    F32 entry, exit;
};

template <class Meet>
void for_each_key(const Crossings& c, Meet&& meet) {
    for (int i = 0; i < c.entries; ++i)
        meet(c.entry[i]);
    for (int i = 0; i < c.opens; ++i)
        meet(c.open[i]);
    for (int i = 0; i < c.exits; ++i)
        meet(c.exit[i]);
}

/// From the first surface up to the next deeper one.
Intervals up_to_next(const Crossings& c) {
    I32 first = splat(no_layer), next = splat(no_layer);
    for_each_key(c, [&](const I32& key) { first = min(first, key); });
    // The last key that has the first one's depth.
    const I32 same = first | splat(3);
    for_each_key(c, [&](const I32& key) { next = min(next, select(less(same, key), key, splat(no_layer))); });
    const F32 one = splat(1.0f);
    const F32 before = bitcast_f32(bitcast_i32(depths_of(next)) - splat(1));
    return {select(equal(first, splat(no_layer)), one, depths_of(first)),
            select(equal(next, splat(no_layer)), one, before)};
}

/// The counter.
Intervals counted(const Crossings& c) {
    I32 first = splat(no_layer);
    for_each_key(c, [&](const I32& key) { first = min(first, key); });

    // The first exit after which the counter is back at zero; keys put entries before exits at equal depth.
    I32 last = splat(no_layer);
    for (int j = 0; j < c.exits; ++j) {
        I32 inside = splat(0);
        const I32 one = splat(1), none_ = splat(0);
        for (int i = 0; i < c.entries; ++i)
            inside = inside + select(less_equal(c.entry[i], c.exit[j]), one, none_);
        for (int i = 0; i < c.exits; ++i)
            inside = inside - select(less_equal(c.exit[i], c.exit[j]), one, none_);
        last = min(last, select(less_equal(inside, none_), c.exit[j], splat(no_layer)));
    }

    const Mask nothing = equal(first, splat(no_layer));
    const Mask solid = equal(first & splat(3), splat(0)) & ~equal(last, splat(no_layer));
    const F32 one = splat(1.0f);
    Intervals r;
    r.entry = select(nothing, one, depths_of(first));
    r.exit = select(nothing, one, select(solid, depths_of(last), r.entry));
    return r;
}

}  // namespace

void block_intervals(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                     std::int32_t x0, std::int32_t y0, bool static_receivers, float* entry,
                     float* exit) noexcept {
    Crossings crossings[4];
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleRecord& t = records[list[i]];
        BlockEdge edge[4];
        const int edges = t.paired ? 4 : 3;
        edge[0] = block_edge(t, 0, x0, y0);
        edge[1] = block_edge(t, 1, x0, y0);
        edge[2] = t.paired ? block_edge((&t)[1], 0, x0, y0) : block_edge(t, 2, x0, y0);
        if (t.paired) edge[3] = block_edge((&t)[1], 1, x0, y0);
        for (int q = 0; q < 4; ++q) {
            const int column = 4 * (q % 2), row = 4 * (q / 2);
            const Mask covered = inside(edge, edges, column, row);
            if (none(covered)) continue;
            const F64 X = to_f64(load(lane_column) + splat(x0 + column)) + splat(0.5);
            const F64 Y = to_f64(load(lane_row) + splat(y0 + row)) + splat(0.5);
            const I32 keys = select(covered, keys_of(t, X, Y), splat(no_layer));
            Crossings& c = crossings[q];
            if (t.crossing == Crossing::entry) {
                c.entry[c.entries++] = keys;
            } else if (t.crossing == Crossing::exit) {
                c.exit[c.exits++] = keys;
            } else {
                c.open[c.opens++] = keys;
            }
        }
    }
    for (int q = 0; q < 4; ++q) {
        const Intervals r = static_receivers ? up_to_next(crossings[q]) : counted(crossings[q]);
        store(entry + 16 * q, r.entry);
        store(exit + 16 * q, r.exit);
    }
}

}  // namespace obscura::OBSCURA_ISA
