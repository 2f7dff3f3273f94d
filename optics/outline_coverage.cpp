// Exact coverage by a sweep from row to row. Per row, the edges are cut wherever one of them ends or two
// cross; in the slabs between, they keep their order in x, so winding numbers follow by counting, and what
// lies between an edge that opens and one that closes is a row of trapezoids. An edge adds, to the
// differences between neighbouring texels, the area on its right; a prefix sum makes coverage of them (the
// accumulation buffer of font rasterizers, R. Levien: Inside the fastest font renderer in the world, 2016).

#include "optics/outline_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace obscura {
namespace {

/// A side of a loop, top to bottom. Going right across it, the winding number grows by `winding`.
struct Edge {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int winding = 0;

    double at(double y) const {
        if (y <= y0) return x0;
        if (y >= y1) return x1;
        return x0 + (x1 - x0) * ((y - y0) / (y1 - y0));
    }
};

/// The part of an edge within a slab: x at its top and at its bottom.
struct Strand {
    double top = 0, bottom = 0;
    int winding = 0;
};

std::vector<Edge> edges_of(const Outline& outline, int height) {
    std::vector<Edge> edges;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[i + 1 < loop.size() ? i + 1 : 0];
            if (a.y == b.y || std::max(a.y, b.y) <= 0 || std::min(a.y, b.y) >= height) continue;
            edges.push_back(a.y < b.y ? Edge{a.x, a.y, b.x, b.y, -1} : Edge{b.x, b.y, a.x, a.y, 1});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.y0 < b.y0; });
    return edges;
}

/// Collects one row of texels: differences[i] is how much more of texel i is open than of texel i - 1.
class RowAccumulator {
  public:
    explicit RowAccumulator(int width)
        : width_(width), differences_(static_cast<std::size_t>(width) + 2, 0.0) {}

    /// Opens (sign 1) or closes (sign -1) what lies right of a straight line from x = a down to x = b over
    /// `height` texels.
    void add(double a, double b, double height, double sign) {
        const double left = std::min(a, b), right = std::max(a, b);
        if (left >= width_ || !(height > 0)) return;
        if (right <= 0) {
            differences_[0] += sign * height;
            return;
        }
        const double per_x = right > left ? height / (right - left) : 0;
        if (left < 0) {
            differences_[0] += sign * per_x * -left;
            height -= per_x * -left;
        }
        double from = std::max(left, 0.0);
        auto texel = static_cast<int>(from);
        for (; texel < width_; ++texel) {
            const bool last = right <= texel + 1;
            const double to = last ? right : texel + 1;
            const double piece = last ? height : per_x * (to - from);
            put(texel, 0.5 * (from + to) - texel, sign * piece);
            height -= piece;
            from = to;
            if (last) return;
        }
    }

    void finish(float* row) {
        double sum = 0;
        for (int x = 0; x < width_; ++x) {
            sum += differences_[static_cast<std::size_t>(x)];
            row[x] = sum < 1e-9 ? 0.0f : static_cast<float>(std::min(sum, 1.0));
        }
        std::fill(differences_.begin(), differences_.end(), 0.0);
    }

  private:
    /// Area `amount` opens in whole texels from texel + 1 on; in `texel`, the share right of `where` of it.
    void put(int texel, double where, double amount) {
        const auto i = static_cast<std::size_t>(texel);
        differences_[i] += amount * (1 - where);
        differences_[i + 1] += amount * where;
    }

    int width_;
    std::vector<double> differences_;
};

/// Heights, as shares of a slab, at which two of its strands cross; strands sorted by top, then bottom.
std::vector<double> crossings(const std::vector<Strand>& strands) {
    std::vector<double> shares;
    const auto crosses = [](const Strand& a, const Strand& b) { return a.bottom > b.bottom; };
    if (std::adjacent_find(strands.begin(), strands.end(), crosses) == strands.end()) return shares;
    for (std::size_t i = 0; i < strands.size(); ++i) {
        for (std::size_t j = i + 1; j < strands.size(); ++j) {
            const double above = strands[j].top - strands[i].top;
            const double below = strands[i].bottom - strands[j].bottom;
            if (below > 0 && above > 0) shares.push_back(above / (above + below));
        }
    }
    std::sort(shares.begin(), shares.end());
    return shares;
}

/// Strands that do not cross, over the shares [from, to] of a slab `height` texels high.
void add_ordered(std::vector<Strand> strands, double from, double to, double height, RowAccumulator& row) {
    for (Strand& s : strands)
        s = {s.top + (s.bottom - s.top) * from, s.top + (s.bottom - s.top) * to, s.winding};
    std::sort(strands.begin(), strands.end(),
              [](const Strand& a, const Strand& b) { return a.top + a.bottom < b.top + b.bottom; });
    int winding = 0;
    for (const Strand& s : strands) {
        const int before = winding;
        winding += s.winding;
        if ((before > 0) != (winding > 0))
            row.add(s.top, s.bottom, height * (to - from), winding > 0 ? 1 : -1);
    }
}

/// The part [top, bottom] of a row, within which no edge begins or ends.
void add_slab(const std::vector<Edge>& active, double top, double bottom, RowAccumulator& row) {
    std::vector<Strand> strands;
    for (const Edge& e : active) {
        if (e.y0 <= top && e.y1 >= bottom) strands.push_back({e.at(top), e.at(bottom), e.winding});
    }
    std::sort(strands.begin(), strands.end(), [](const Strand& a, const Strand& b) {
        return a.top != b.top ? a.top < b.top : a.bottom < b.bottom;
    });
    double from = 0;
    for (const double share : crossings(strands)) {
        if (share > from) add_ordered(strands, from, share, bottom - top, row);
        from = std::max(from, share);
    }
    add_ordered(std::move(strands), from, 1, bottom - top, row);
}

/// Winding numbers counted: loops may cross and overlap.
void add_row(const std::vector<Edge>& active, double top, RowAccumulator& row) {
    std::vector<double> cuts{top, top + 1};
    for (const Edge& e : active) {
        for (const double y : {e.y0, e.y1}) {
            if (y > top && y < top + 1) cuts.push_back(y);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (cuts[i] < cuts[i + 1]) add_slab(active, cuts[i], cuts[i + 1], row);
    }
}

/// Winding numbers are 0 or 1 everywhere: every edge counts, whatever the others do.
void add_row_disjoint(const std::vector<Edge>& active, double top, RowAccumulator& row) {
    for (const Edge& e : active) {
        const double from = std::max(e.y0, top), to = std::min(e.y1, top + 1);
        row.add(e.at(from), e.at(to), to - from, e.winding);
    }
}

/// What rounding made of a mirror image becomes one again.
void restore_mirrors(Image<float>& mask) {
    const int w = mask.width, h = mask.height;
    constexpr float rounding = 0x1p-22f;
    bool left_right = true, top_bottom = true;
    for (int y = 0; y < h && (left_right || top_bottom); ++y) {
        const float *row = mask.row(y), *opposite = mask.row(h - 1 - y);
        for (int x = 0; x < w; ++x) {
            left_right = left_right && std::fabs(row[x] - row[w - 1 - x]) <= rounding;
            top_bottom = top_bottom && std::fabs(row[x] - opposite[x]) <= rounding;
        }
    }
    for (int y = 0; y < h && left_right; ++y) {
        for (int x = 0; x < w / 2; ++x)
            mask(w - 1 - x, y) = mask(x, y);
    }
    for (int y = 0; y < h / 2 && top_bottom; ++y)
        std::copy(mask.row(y), mask.row(y) + w, mask.row(h - 1 - y));
}

}  // namespace

Image<float> coverage_of(const Outline& outline, int width, int height) {
    CHECK(width > 0 && height > 0);
    const std::vector<Edge> edges = edges_of(outline, height);
    Image<float> mask(width, height);
    RowAccumulator row(width);
    std::vector<Edge> active;
    std::size_t next = 0;
    for (int y = 0; y < height; ++y) {
        std::erase_if(active, [&](const Edge& e) { return e.y1 <= y; });
        for (; next < edges.size() && edges[next].y0 < y + 1; ++next)
            active.push_back(edges[next]);
        if (outline.disjoint) {
            add_row_disjoint(active, y, row);
        } else {
            add_row(active, y, row);
        }
        row.finish(mask.row(y));
    }
    restore_mirrors(mask);
    return mask;
}

}  // namespace obscura
