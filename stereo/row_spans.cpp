// Rows of disparity as joined spans; see row_spans.h.

#include "stereo/row_spans.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

/// A point of the polyline, in the row and in the eye's picture.
struct SpanPoint {
    double column, disparity, original, x;
};

bool known(const SpanRow& row, int x) {
    return std::isfinite(row.disparity[x]) && std::isfinite(row.original[x]);
}

bool same_object(const SpanRow& row, int a, int b) {
    return known(row, a) && known(row, b) && (row.object == nullptr || row.object[a] == row.object[b]);
}

double step(const SpanRow& row, int x) {
    return static_cast<double>(row.original[x + 1]) - static_cast<double>(row.original[x]);
}

/// The first pixel whose centre is at or after x >= 0.
int column_from(double x) {
    const int below = static_cast<int>(x);
    return below + (below < x ? 1 : 0);
}

/// Pixel centres from a on, exclusive of b; the nearest stays.
void draw_segment(SpanPoint a, SpanPoint b, std::span<RowHit> hits) {
    // Seen from behind: the surface folds over. It is drawn all the same; its front is nearer.
    if (b.x < a.x) std::swap(a, b);
    const auto width = static_cast<int>(hits.size());
    if (!(b.x > 0 && a.x < width)) return;
    const int end = column_from(std::min(b.x, static_cast<double>(width)));
    for (int x = column_from(std::max(a.x, 0.0)); x < end; ++x) {
        const double t = (x - a.x) / (b.x - a.x);
        const auto original = static_cast<float>(a.original + t * (b.original - a.original));
        RowHit& hit = hits[static_cast<std::size_t>(x)];
        if (!(original > hit.original)) continue;
        hit.original = original;
        hit.disparity = static_cast<float>(a.disparity + t * (b.disparity - a.disparity));
        hit.column = static_cast<float>(a.column + t * (b.column - a.column));
    }
}

/// The surface of pixels first to last, joined all the way.
void draw_run(const SpanRow& row, int first, int last, double shift, std::span<RowHit> hits) {
    // A point `past` an end lies on the surface's slope there, but shows the end's own pixel.
    const auto point = [&](int x, int inner, double past) {
        const auto value = [&](const float* of) {
            const auto here = static_cast<double>(of[x]);
            return here + std::abs(past) * (here - static_cast<double>(of[inner]));
        };
        const double disparity = value(row.disparity);
        return SpanPoint{static_cast<double>(x), disparity, value(row.original),
                         x + past + shift * disparity - row.margin};
    };
    SpanPoint from = point(first, std::min(first + 1, last), -0.5);
    for (int x = first; x <= last; ++x) {
        const SpanPoint to = point(x, x, 0);
        draw_segment(from, to, hits);
        from = to;
    }
    draw_segment(from, point(last, std::max(first, last - 1), 0.5), hits);
}

}  // namespace

bool joined(const SpanRow& row, int x, double join_px) {
    if (!same_object(row, x, x + 1)) return false;
    const double here = step(row, x);
    if (std::abs(here) <= join_px) return true;

    // A crease lies between the slopes on its sides; an occlusion is steeper than both.
    double low = std::numeric_limits<double>::infinity(), high = -low;
    if (x > 0 && same_object(row, x - 1, x)) {
        low = std::min(low, step(row, x - 1));
        high = std::max(high, step(row, x - 1));
    }
    if (x + 2 < row.width && same_object(row, x + 1, x + 2)) {
        low = std::min(low, step(row, x + 1));
        high = std::max(high, step(row, x + 1));
    }
    return here >= low - join_px && here <= high + join_px;
}

void draw_spans(const SpanRow& row, double shift, double join_px, std::span<RowHit> hits) {
    for (int first = 0; first < row.width;) {
        if (!known(row, first)) {
            ++first;
            continue;
        }
        int last = first;
        while (last + 1 < row.width && joined(row, last, join_px))
            ++last;
        draw_run(row, first, last, shift, hits);
        first = last + 1;
    }
}

}  // namespace obscura
