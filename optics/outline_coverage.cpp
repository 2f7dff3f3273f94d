// Exact coverage by a sweep from row to row. A row's edges fall into clusters that nothing joins from side to
// side: each is cut on its own, wherever one of its edges ends; in the slabs between, edges that cross fall
// into groups which are cut once more where they do. Clusters of very many edges are cut into columns of
// texels first. Then all keep their order in x, so winding numbers follow by counting, and what lies between
// an edge that opens and one that closes is a row of trapezoids. Work grows with what lies beside and across
// one another in a texel or so, not with what a row holds. An edge adds, to the differences between
// neighbouring texels, the area on its right; a prefix sum makes coverage of them (the accumulation buffer of
// font rasterizers, R. Levien: Inside the fastest font renderer in the world, 2016).

#include "optics/outline_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "optics/outline_row.h"

namespace obscura {
namespace {

std::vector<OutlineEdge> edges_of(const Outline& outline, int height) {
    const bool disjoint = outline.disjoint;
    std::vector<OutlineEdge> edges;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[i + 1 < loop.size() ? i + 1 : 0];
            if (std::max(a.y, b.y) <= 0 || std::min(a.y, b.y) >= height) continue;
            const int winding = a.y < b.y ? -1 : a.y > b.y ? 1 : 0;
            if (winding == 0 && disjoint) continue;
            edges.push_back(a.y <= b.y ? OutlineEdge{a.x, a.y, b.x, b.y, winding}
                                       : OutlineEdge{b.x, b.y, a.x, a.y, winding});
        }
    }
    std::sort(edges.begin(), edges.end(),
              [](const OutlineEdge& a, const OutlineEdge& b) { return a.y0 < b.y0; });
    return edges;
}

/// An edge within a row, and from where to where it reaches there.
struct RowEdge {
    const OutlineEdge* edge;
    double left = 0, right = 0;
};

/// Edges of a row that are joined. Returns the winding number behind them.
int add_cluster(std::span<const RowEdge> cluster, double top, int winding, RowAccumulator& row,
                CoverageWork& work) {
    std::vector<OutlineEdge> edges;
    edges.reserve(cluster.size());
    for (const RowEdge& e : cluster)
        edges.push_back(*e.edge);
    return add_edges(edges, top, winding, row, work);
}

/// Winding numbers counted: loops may cross and overlap.
void add_row(const std::vector<OutlineEdge>& active, double top, RowAccumulator& row, CoverageWork& work) {
    std::vector<RowEdge> edges;
    edges.reserve(active.size());
    for (const OutlineEdge& e : active) {
        const double a = e.winding == 0 ? e.x0 : e.at(top), b = e.winding == 0 ? e.x1 : e.at(top + 1);
        edges.push_back({&e, std::min(a, b), std::max(a, b)});
    }
    std::sort(edges.begin(), edges.end(), [](const RowEdge& a, const RowEdge& b) { return a.left < b.left; });
    int winding = 0;
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        double reach = edges[first].right;
        for (last = first + 1; last < edges.size() && edges[last].left <= reach; ++last)
            reach = std::max(reach, edges[last].right);
        winding = add_cluster(std::span(edges).subspan(first, last - first), top, winding, row, work);
    }
}

/// Winding numbers are 0 or 1 everywhere: every edge counts, whatever the others do.
void add_row_disjoint(const std::vector<OutlineEdge>& active, double top, RowAccumulator& row) {
    for (const OutlineEdge& e : active) {
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

Image<float> coverage_of(const Outline& outline, int width, int height, CoverageWork* work) {
    CHECK(width > 0 && height > 0);
    CoverageWork done;
    const std::vector<OutlineEdge> edges = edges_of(outline, height);
    Image<float> mask(width, height);
    RowAccumulator row(width);
    std::vector<OutlineEdge> active;
    std::size_t next = 0;
    for (int y = 0; y < height; ++y) {
        std::erase_if(active, [&](const OutlineEdge& e) { return e.y1 <= y; });
        for (; next < edges.size() && edges[next].y0 < y + 1; ++next)
            active.push_back(edges[next]);
        if (outline.disjoint) {
            add_row_disjoint(active, y, row);
        } else {
            add_row(active, y, row, done);
        }
        row.finish(mask.row(y));
    }
    restore_mirrors(mask);
    if (work != nullptr) *work = done;
    return mask;
}

}  // namespace obscura
