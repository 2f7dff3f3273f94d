#pragma once
// The inner loop of every sample kernel: which samples of a tile a triangle, or a pair of them,
// covers, and at what depth.
// Kernel files only. The meaning is raster/coverage.h, sample by sample; this is the same in rows of sixteen.
//
// What the field does (Pineda 1988; Abrash, "Rasterization on Larrabee", 2009) and we do too: test the box,
// drop edges that the whole box lies inside of, step edge functions by addition. What is different:
// exactness. Edge functions are taken at texel centres and divided by 256 once (their steps are multiples of
// 256, so the sign survives), which makes them small enough for 32-bit lanes in nearly every case; 64-bit
// lanes take the rest. Depth is not stepped at all: every sample evaluates the one formula.

#include <cstdint>

#include "core/simd.h"
#include "raster/record.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE std::int32_t least(std::int32_t a, std::int32_t b) {
    return a < b ? a : b;
}
OBSCURA_INLINE std::int32_t most(std::int32_t a, std::int32_t b) {
    return a > b ? a : b;
}

/// Columns [c0, c1] and rows [r0, r1] of the tile whose samples the triangle's box holds.
struct SampleBox {
    std::int32_t c0, c1, r0, r1;
    bool small;  ///< the whole triangle spans less than 256 texels each way
    bool empty() const { return c0 > c1 || r0 > r1; }
};

/// N = 3: a triangle; N = 4: the pair that begins at `t`.
template <int N>
OBSCURA_INLINE SampleBox sample_box(const TriangleRecord* pair, const TileRect& tile) {
    const TriangleRecord& t = pair[0];
    std::int32_t x_low = least(least(t.x[0], t.x[1]), t.x[2]), x_high = most(most(t.x[0], t.x[1]), t.x[2]);
    std::int32_t y_low = least(least(t.y[0], t.y[1]), t.y[2]), y_high = most(most(t.y[0], t.y[1]), t.y[2]);
    if constexpr (N == 4) {
        x_low = least(x_low, pair[1].x[1]);
        x_high = most(x_high, pair[1].x[1]);
        y_low = least(y_low, pair[1].y[1]);
        y_high = most(y_high, pair[1].y[1]);
    }
    const auto first = [](std::int32_t v, std::int32_t sample) {
        return (v - sample + 255) >> subtexel_bits;
    };
    const auto last = [](std::int32_t v, std::int32_t sample) { return (v - sample) >> subtexel_bits; };
    return {most(first(x_low, tile.sample_x) - tile.x0, 0),
            least(last(x_high, tile.sample_x) - tile.x0, tile.width - 1),
            most(first(y_low, tile.sample_y) - tile.y0, 0),
            least(last(y_high, tile.sample_y) - tile.y0, tile.height - 1),
            ((x_high - x_low) | (y_high - y_low)) < 65536};
}

/// One edge over the box: value at its first sample, steps per column and row.
struct BoxEdge {
    std::int64_t e = 0, A = 0, B = 0;
};

/// Edge k of the outline: a triangle's three, or a pair's four (0 and 1 of each half).
template <int N>
OBSCURA_INLINE BoxEdge box_edge(const TriangleRecord* pair, int k, const TileRect& tile, std::int32_t column,
                                std::int32_t row) {
    const TriangleRecord& t = N == 4 && k >= 2 ? pair[1] : pair[0];
    if (N == 4 && k >= 2) k -= 2;
    const int n = k == 2 ? 0 : k + 1;
    BoxEdge f;
    f.A = static_cast<std::int64_t>(t.y[k]) - t.y[n];
    f.B = static_cast<std::int64_t>(t.x[n]) - t.x[k];
    const std::int64_t px = (static_cast<std::int64_t>(tile.x0) + column) * subtexel_one + tile.sample_x;
    const std::int64_t py = (static_cast<std::int64_t>(tile.y0) + row) * subtexel_one + tile.sample_y;
    const std::int64_t keeps_its_edge = (f.A > 0) | ((f.A == 0) & (f.B > 0));
    f.e = (f.A * (px - t.x[k]) + f.B * (py - t.y[k]) + keeps_its_edge - 1) >> subtexel_bits;
    return f;
}

/// Least and greatest value of an edge over columns x rows samples from its first.
struct EdgeRange {
    std::int64_t low, high;
};
OBSCURA_INLINE EdgeRange edge_range(std::int64_t first, const BoxEdge& f, std::int32_t columns,
                                    std::int32_t rows) {
    const std::int64_t dx = f.A * (columns - 1), dy = f.B * (rows - 1);
    return {first + (dx < 0 ? dx : 0) + (dy < 0 ? dy : 0), first + (dx > 0 ? dx : 0) + (dy > 0 ? dy : 0)};
}

/// Depth of one row of sixteen: a X is kept for the column, b Y + c comes with the row.
struct DepthRow {
    F64 aX;
    F32 zmin, zmax;
    OBSCURA_INLINE F32 at(double bYc) const { return max(min(to_f32(aX + splat(bYc)), zmax), zmin); }
};

OBSCURA_INLINE F64 column_positions(const TileRect& tile, std::int32_t column) {
    const I32 texel = lane_index() + splat(tile.x0 + column);
    return to_f64(texel) + splat(static_cast<double>(tile.sample_x) * (1.0 / subtexel_one));
}

/// Rows [r0, r1] of the sixteen columns from `column` on, all samples covered.
template <class Consumer>
OBSCURA_INLINE void walk_covered(const TriangleRecord& t, const TileRect& tile, std::int32_t column,
                                 std::int32_t r0, std::int32_t r1, const DepthRow& depth,
                                 Consumer& consumer) {
    const double sample_y = static_cast<double>(tile.sample_y) * (1.0 / subtexel_one);
    for (std::int32_t r = r0; r <= r1; ++r) {
        const double Y = static_cast<double>(tile.y0 + r) + sample_y;
        consumer.covered(r * tile.width + column, depth.at(t.b * Y + t.c));
    }
}

/// The same where edges cross. V: I32 or I64 lanes; T: their type.
template <class V, class T, int N, class Consumer>
OBSCURA_INLINE void walk_edges(const TriangleRecord& t, const TileRect& tile, const BoxEdge (&edge)[N],
                               std::int32_t skipped_columns, std::int32_t column, std::int32_t r0,
                               std::int32_t r1, const V& lane, const DepthRow& depth, Consumer& consumer) {
    V e[N], step[N];
    for (int k = 0; k < N; ++k) {
        // Wrapping arithmetic on purpose: products may leave the type, the sums lie between low and high
        // again.
        const auto base = static_cast<T>(edge[k].e + edge[k].A * skipped_columns);
        e[k] = splat(base) + splat(static_cast<T>(edge[k].A)) * lane;
        step[k] = splat(static_cast<T>(edge[k].B));
    }
    const double sample_y = static_cast<double>(tile.sample_y) * (1.0 / subtexel_one);
    for (std::int32_t r = r0; r <= r1; ++r) {
        V signs = e[0];
        for (int k = 1; k < N; ++k)
            signs = signs | e[k];
        const Mask inside = not_negative(signs);
        const double Y = static_cast<double>(tile.y0 + r) + sample_y;
        consumer.partial(r * tile.width + column, inside, depth.at(t.b * Y + t.c));
        for (int k = 0; k < N; ++k)
            e[k] = e[k] + step[k];
    }
}

/// 0 .. 15 in 64-bit lanes.
OBSCURA_INLINE I64 lane_index_64() {
    alignas(64) static constexpr std::int64_t index[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                           8, 9, 10, 11, 12, 13, 14, 15};
    return load(index);
}

OBSCURA_INLINE DepthRow depth_row(const TriangleRecord& t, const TileRect& tile, std::int32_t column) {
    return {splat(t.a) * column_positions(tile, column), splat(t.zmin), splat(t.zmax)};
}

/// Boxes of several columns of sixteen, and outlines of any size.
template <int N, class Consumer>
OBSCURA_INLINE void walk_box(const TriangleRecord* pair, const TileRect& tile, const SampleBox& box,
                             Consumer& consumer) {
    const TriangleRecord& t = pair[0];
    const std::int32_t c0 = box.c0 & ~15, columns = (box.c1 | 15) - c0 + 1, rows = box.r1 - box.r0 + 1;

    // An edge with the whole box inside it is forgotten; one with the whole box outside ends the walk.
    BoxEdge edge[N];
    bool wide = false, crossed = false;
    for (int k = 0; k < N; ++k) {
        edge[k] = box_edge<N>(pair, k, tile, c0, box.r0);
        const EdgeRange range = edge_range(edge[k].e, edge[k], columns, rows);
        if (range.high < 0) return;
        if (range.low >= 0) {
            edge[k] = BoxEdge{};
        } else {
            crossed = true;
            wide = wide || range.low < INT32_MIN || range.high > INT32_MAX;
        }
    }
    for (std::int32_t c = c0; c <= box.c1; c += lanes) {
        // The same question again for each column of sixteen.
        bool covered = !crossed;
        if (crossed) {
            bool outside = false;
            covered = true;
            for (const BoxEdge& f : edge) {
                const EdgeRange range = edge_range(f.e + f.A * (c - c0), f, lanes, rows);
                outside = outside || range.high < 0;
                covered = covered && range.low >= 0;
            }
            if (outside) continue;
        }
        const DepthRow depth = depth_row(t, tile, c);
        if (covered) {
            walk_covered(t, tile, c, box.r0, box.r1, depth, consumer);
        } else if (!wide) {
            walk_edges<I32, std::int32_t>(t, tile, edge, c - c0, c, box.r0, box.r1, lane_index(), depth,
                                          consumer);
        } else {
            walk_edges<I64, std::int64_t>(t, tile, edge, c - c0, c, box.r0, box.r1, lane_index_64(), depth,
                                          consumer);
        }
    }
}

template <int N, class Consumer>
OBSCURA_INLINE void walk_outline(const TriangleRecord* pair, const TileRect& tile, Consumer& consumer) {
    const SampleBox box = sample_box<N>(pair, tile);
    if (box.empty() || consumer.hidden(pair[0], box)) return;
    const std::int32_t column = box.c0 & ~15;
    if (!box.small || box.c1 - column >= lanes) {
        walk_box<N>(pair, tile, box, consumer);
        return;
    }
    // Most triangles of a fine mesh: one column of sixteen, and edge functions that fit 32 bits all over the
    // tile (steps below 2^16, at most 2^9 of them). Asking more of them would cost more than testing their
    // rows.
    BoxEdge edge[N];
    for (int k = 0; k < N; ++k)
        edge[k] = box_edge<N>(pair, k, tile, column, box.r0);
    walk_edges<I32, std::int32_t>(pair[0], tile, edge, 0, column, box.r0, box.r1, lane_index(),
                                  depth_row(pair[0], tile, column), consumer);
}

/// Feeds every covered sample of `tile` to the consumer, in rows of sixteen texels:
/// consumer.covered(offset, depth) or consumer.partial(offset, mask, depth); offset = row * width + column.
/// partial() may be called with an empty mask. consumer.hidden(record, box) may reject a triangle before
/// that.
template <class Consumer>
OBSCURA_INLINE void walk_triangle(const TriangleRecord& t, const TileRect& tile, Consumer& consumer) {
    if (t.paired) {
        walk_outline<4>(&t, tile, consumer);
    } else {
        walk_outline<3>(&t, tile, consumer);
    }
}

/// Calls fn(record) for each record of a list, fetching some ahead: lists jump through memory.
template <class Fn>
OBSCURA_INLINE void for_each_listed(const TriangleRecord* records, const std::uint32_t* list,
                                    std::size_t count, Fn&& fn) {
    constexpr std::size_t ahead = 8;
    for (std::size_t i = 0; i < count; ++i) {
        if (i + ahead < count) __builtin_prefetch(&records[list[i + ahead]]);
        fn(records[list[i]]);
    }
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
