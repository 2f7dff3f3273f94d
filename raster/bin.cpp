#include "raster/bin.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "raster/coverage.h"

namespace obscura {
namespace {

/// Work is cut into this many chunks of consecutive blocks, however many threads there are.
constexpr std::size_t max_chunks = 16;

struct TileRange {
    int x0, y0, x1, y1;  ///< inclusive
};

int least(int a, int b) {
    return a < b ? a : b;
}
int most(int a, int b) {
    return a > b ? a : b;
}

/// The edges of a triangle (three) or pair (four).
int outline_edges(const TriangleRecord* t, EdgeFunction (&edge)[4]) {
    edge[0] = edge_function(t[0], 0);
    edge[1] = edge_function(t[0], 1);
    edge[2] = t->paired ? edge_function(t[1], 0) : edge_function(t[0], 2);
    if (!t->paired) return 3;
    edge[3] = edge_function(t[1], 1);
    return 4;
}

/// Calls fn(tile index) for each tile that the triangle or pair at `t` may touch.
template <class Fn>
void for_each_tile(const TriangleRecord* t, const TileBins& bins, int shift, Fn&& fn) {
    const int bits = subtexel_bits + shift;
    // Box of the corners, in tiles from the region's corner. A pair has one corner more: the second half's
    // corner 1.
    const int x_begin = bins.region.x0 * subtexel_one, y_begin = bins.region.y0 * subtexel_one;
    int x_low = least(least(t->x[0], t->x[1]), t->x[2]), x_high = most(most(t->x[0], t->x[1]), t->x[2]);
    int y_low = least(least(t->y[0], t->y[1]), t->y[2]), y_high = most(most(t->y[0], t->y[1]), t->y[2]);
    if (t->paired) {
        x_low = least(x_low, t[1].x[1]);
        x_high = most(x_high, t[1].x[1]);
        y_low = least(y_low, t[1].y[1]);
        y_high = most(y_high, t[1].y[1]);
    }
    const TileRange r = {most((x_low - x_begin) >> bits, 0), most((y_low - y_begin) >> bits, 0),
                         least((x_high - x_begin) >> bits, bins.columns - 1),
                         least((y_high - y_begin) >> bits, bins.rows - 1)};
    // Small boxes: taking a tile too many costs less than asking.
    if ((r.x1 - r.x0) + (r.y1 - r.y0) <= 1) {
        for (int y = r.y0; y <= r.y1; ++y) {
            for (int x = r.x0; x <= r.x1; ++x)
                fn(bins.index(x, y));
        }
        return;
    }
    EdgeFunction edge[4];
    const int edges = outline_edges(t, edge);
    const std::int64_t side = std::int64_t{1} << bits;
    for (int y = r.y0; y <= r.y1; ++y) {
        for (int x = r.x0; x <= r.x1; ++x) {
            // A tile is out when its most inner corner is outside one edge.
            bool outside = false;
            for (int k = 0; k < edges; ++k) {
                const EdgeFunction& f = edge[k];
                outside =
                    outside || f.at(x_begin + (x + (f.A > 0)) * side, y_begin + (y + (f.B > 0)) * side) < 0;
            }
            if (!outside) fn(bins.index(x, y));
        }
    }
}

/// Calls fn(record, index) for the triangles and pairs of chunk c.
template <class Fn>
void for_each_record(const TriangleSetup& setup, std::size_t c, std::size_t chunks, Fn&& fn) {
    const std::size_t blocks = setup.blocks.size();
    for (std::size_t b = blocks * c / chunks; b < blocks * (c + 1) / chunks; ++b) {
        const RecordBlock& block = setup.blocks[b];
        for (std::size_t i = block.begin; i < block.begin + block.count; ++i) {
            // Asked of the record itself: a loop that jumps by what it just read waits for memory at every
            // step.
            if (!setup.records[i].second) fn(&setup.records[i], i);
        }
    }
}

}  // namespace

void bin_records(const TriangleSetup& setup, const Region& region, int tile, const Exec& exec,
                 TileBins& bins) {
    CHECK(std::has_single_bit(static_cast<unsigned>(tile)));
    const int shift = std::countr_zero(static_cast<unsigned>(tile));
    bins.region = region;
    bins.tile = tile;
    bins.columns = (region.width + tile - 1) / tile;
    bins.rows = (region.height + tile - 1) / tile;
    const std::size_t tiles = bins.tiles();
    const std::size_t chunks = std::clamp<std::size_t>(setup.blocks.size(), 1, max_chunks);

    // Count.
    bins.counts.reset(chunks * tiles);
    parallel_for(chunks, exec, [&](std::size_t c) {
        std::uint32_t* counts = bins.counts.data() + c * tiles;
        std::fill_n(counts, tiles, 0u);
        for_each_record(setup, c, chunks, [&](const TriangleRecord* t, std::size_t) {
            for_each_tile(t, bins, shift, [&](std::size_t i) { ++counts[i]; });
        });
    });

    // Prefix sum: tile by tile, chunk by chunk; a count becomes the place of the chunk's first item.
    bins.first.reset(tiles + 1);
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < tiles; ++i) {
        bins.first[i] = static_cast<std::uint32_t>(next);
        for (std::size_t c = 0; c < chunks; ++c) {
            const std::uint32_t n = bins.counts[c * tiles + i];
            bins.counts[c * tiles + i] = static_cast<std::uint32_t>(next);
            next += n;
        }
        if (next > 0xffffffffu)
            throw LimitError("too many triangles for one map: tile lists pass 2^32 entries");
    }
    bins.first[tiles] = static_cast<std::uint32_t>(next);
    bins.items.reset(next);

    // Scatter.
    parallel_for(chunks, exec, [&](std::size_t c) {
        std::uint32_t* place = bins.counts.data() + c * tiles;
        for_each_record(setup, c, chunks, [&](const TriangleRecord* t, std::size_t i) {
            for_each_tile(t, bins, shift,
                          [&](std::size_t k) { bins.items[place[k]++] = static_cast<std::uint32_t>(i); });
        });
    });
}

}  // namespace obscura
