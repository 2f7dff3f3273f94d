// The extreme depth of a facet over the texels of a square that it covers: row by row, at the ends of its
// spans.

#include <algorithm>
#include <cstdint>

#include "hierarchy/certificate.h"
#include "raster/coverage.h"

namespace obscura {
namespace {

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
    const std::int64_t q = a / b;
    return q - (a % b != 0 && (a < 0) != (b < 0));
}

/// Columns of one row of texels that an outline covers.
struct RowSpan {
    std::int64_t first, last;
};

/// Narrows the span to where A x + rest >= 0, x = 256 column + 128.
void narrow(RowSpan& span, std::int64_t A, std::int64_t rest) {
    const std::int64_t at_zero = rest + A * 128, step = A * subtexel_one;
    if (step > 0) {
        span.first = std::max(span.first, -floor_div(at_zero, step));
    } else if (step < 0) {
        span.last = std::min(span.last, floor_div(at_zero, -step));
    } else if (at_zero < 0) {
        span.last = span.first - 1;
    }
}

}  // namespace

float extreme_depth(const FacetSet& set, const Facet& f, const Square& square, bool greatest, float best) {
    const TriangleRecord& plane = set.plane(f);
    EdgeFunction edge[4];
    for (int k = 0; k < f.edges; ++k)
        edge[k] = set.edge(f, k);
    const std::int32_t x0 = std::max((f.x_low - 128 + 255) >> subtexel_bits, square.x0);
    const std::int32_t x1 = std::min((f.x_high - 128) >> subtexel_bits, square.x0 + square.side - 1);
    const std::int32_t y0 = std::max((f.y_low - 128 + 255) >> subtexel_bits, square.y0);
    const std::int32_t y1 = std::min((f.y_high - 128) >> subtexel_bits, square.y0 + square.side - 1);
    const auto better = [&](float z) { return greatest ? z > best : z < best; };
    for (std::int32_t y = y0; y <= y1; ++y) {
        // The depth is monotone along the row: its extreme is at one end of the span.
        const DepthRange box = plane_range(plane, x0, x1, y, y);
        if (!better(greatest ? box.high : box.low)) continue;
        RowSpan span{x0, x1};
        for (int k = 0; k < f.edges; ++k)
            narrow(span, edge[k].A, edge[k].B * (std::int64_t{y} * subtexel_one + 128) + edge[k].C);
        if (span.first > span.last) continue;
        const bool right_end = (plane.a >= 0) == greatest;
        const float z =
            depth_at(plane, static_cast<double>(right_end ? span.last : span.first) + 0.5, y + 0.5);
        if (better(z)) best = z;
    }
    return best;
}

}  // namespace obscura
