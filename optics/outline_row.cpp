// Edges are cut wherever one of them ends; in the slabs between, those that cross fall into groups which are
// cut once more where they do, and winding numbers follow by counting from left to right. Very many edges are
// cut into columns of texels first: few share a texel, and ends elsewhere need not cut them.

#include "optics/outline_row.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace obscura {
namespace {

/// The part of an edge within a slab: x at its top and at its bottom.
struct Strand {
    double top = 0, bottom = 0;
    int winding = 0;
};

using Strands = std::span<const Strand>;

/// Heights, as shares of a slab, at which two of its strands cross; strands sorted by top, then bottom.
std::vector<double> crossings(Strands strands) {
    std::vector<double> shares;
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

/// Strands that do not cross, from left to right, over `height`; `winding` is that on their left.
void add_in_order(Strands strands, int winding, double height, RowAccumulator& row) {
    for (const Strand& s : strands) {
        const int before = winding;
        winding += s.winding;
        if ((before > 0) != (winding > 0)) row.add(s.top, s.bottom, height, winding > 0 ? 1 : -1);
    }
}

/// Strands over the shares [from, to] of a slab `height` texels high, within which none cross.
void add_between(Strands strands, int winding, double from, double to, double height, RowAccumulator& row) {
    std::vector<Strand> part;
    part.reserve(strands.size());
    for (const Strand& s : strands) {
        part.push_back({s.top + (s.bottom - s.top) * from, s.top + (s.bottom - s.top) * to, s.winding});
    }
    std::sort(part.begin(), part.end(),
              [](const Strand& a, const Strand& b) { return a.top + a.bottom < b.top + b.bottom; });
    add_in_order(part, winding, height * (to - from), row);
}

/// Strands that cross one another.
void add_group(Strands strands, int winding, double height, RowAccumulator& row, CoverageWork& work) {
    const std::vector<double> shares = crossings(strands);
    work.crossings += static_cast<std::int64_t>(shares.size());
    work.strands += static_cast<std::int64_t>((shares.size() + strands.size()) * strands.size());
    double from = 0;
    for (const double share : shares) {
        if (share > from) add_between(strands, winding, from, share, height, row);
        from = std::max(from, share);
    }
    add_between(strands, winding, from, 1, height, row);
}

/// A slab of a cluster, `height` texels high, within which no edge begins or ends; strands sorted by top,
/// then bottom. Groups end where all that is left at the top is left at the bottom.
void add_slab(Strands strands, int winding, double height, RowAccumulator& row, CoverageWork& work) {
    ++work.slabs;
    work.strands += static_cast<std::int64_t>(strands.size());
    std::vector<double> least_right(strands.size());  // of the bottoms from here on
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = strands.size(); i-- > 0;)
        least_right[i] = least = std::min(least, strands[i].bottom);
    double most = -std::numeric_limits<double>::infinity();
    std::size_t first = 0;
    int group_winding = 0;
    for (std::size_t i = 0; i < strands.size(); ++i) {
        most = std::max(most, strands[i].bottom);
        group_winding += strands[i].winding;
        if (i + 1 < strands.size() && most > least_right[i + 1]) continue;
        const Strands group = strands.subspan(first, i + 1 - first);
        if (group.size() == 1) {
            add_in_order(group, winding, height, row);
        } else {
            add_group(group, winding, height, row, work);
        }
        winding += group_winding;
        group_winding = 0;
        first = i + 1;
    }
}

/// The winding number left of everything changes by `change` below y.
struct LeftChange {
    double y = 0;
    int change = 0;
};

/// Edges, of which only what lies in [top, top + 1] counts, cut where any of them ends; `winding` is that on
/// their left at the top. Returns the winding number behind them.
int add_slabs(std::vector<OutlineEdge>& edges, std::vector<LeftChange>& changes, double top, int winding,
              RowAccumulator& row, CoverageWork& work) {
    std::vector<double> cuts{top, top + 1};
    const auto cut = [&](double y) {
        if (y > top && y < top + 1) cuts.push_back(y);
    };
    for (const OutlineEdge& e : edges) {
        cut(e.y0);
        cut(e.y1);
    }
    for (const LeftChange& c : changes)
        cut(c.y);
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    std::sort(edges.begin(), edges.end(),
              [](const OutlineEdge& a, const OutlineEdge& b) { return a.y0 < b.y0; });
    std::sort(changes.begin(), changes.end(),
              [](const LeftChange& a, const LeftChange& b) { return a.y < b.y; });

    std::vector<const OutlineEdge*> here;
    std::vector<Strand> strands;
    std::size_t next = 0, next_change = 0;
    int behind = winding;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double from = cuts[i], to = cuts[i + 1];
        for (; next_change < changes.size() && changes[next_change].y <= from; ++next_change)
            winding += changes[next_change].change;
        std::erase_if(here, [&](const OutlineEdge* e) { return e->y1 < to; });
        for (; next < edges.size() && edges[next].y0 <= from; ++next) {
            const OutlineEdge& e = edges[next];
            if (e.winding != 0 && e.y1 >= to) here.push_back(&e);
        }
        strands.clear();
        behind = winding;
        for (const OutlineEdge* e : here) {
            strands.push_back({e->at(from), e->at(to), e->winding});
            behind += e->winding;
        }
        std::sort(strands.begin(), strands.end(), [](const Strand& a, const Strand& b) {
            return a.top != b.top ? a.top < b.top : a.bottom < b.bottom;
        });
        add_slab(strands, winding, to - from, row, work);
    }
    return behind;
}

/// What of the edges of a row lies in a column of texels, and how the winding number changes on its left
/// side.
struct Column {
    std::vector<OutlineEdge> pieces;
    std::vector<LeftChange> changes;
};

/// Cuts the part of an edge within a row at the borders of columns `first` and on. What lies left of the
/// first or right of the last is left out.
void cut_at_columns(const OutlineEdge& e, double top, int first, std::vector<Column>& columns) {
    const bool level = e.winding == 0;
    const double ya = std::max(e.y0, top), yb = std::min(e.y1, top + 1);
    const double xa = level ? e.x0 : e.at(ya), xb = level ? e.x1 : e.at(yb);
    const double left = std::min(xa, xb), right = std::max(xa, xb);
    const auto y_at = [&](double x) {
        return std::clamp(xa == xb ? ya : ya + (yb - ya) * ((x - xa) / (xb - xa)), ya, yb);
    };
    const int most = static_cast<int>(columns.size());
    const auto index = [&](double x) {
        return static_cast<int>(std::clamp(std::floor(x) - first, -1.0, static_cast<double>(most)));
    };
    const int low = std::max(index(left), 0), high = std::min(index(right), most - 1);
    for (int c = low; c <= high; ++c) {
        const double border = first + c, next = border + 1;
        Column& column = columns[static_cast<std::size_t>(c)];
        // Left of a border is what is less; a level side goes down, if it went at all, as it is written.
        if ((xa < border) != (xb < border)) {
            const int winding = level ? -1 : e.winding;
            column.changes.push_back({y_at(border), xa < border ? -winding : winding});
        }
        if (level) continue;
        const double from = std::clamp(xa, border, next), to = std::clamp(xb, border, next);
        const double y0 = from == xa ? ya : y_at(from), y1 = to == xb ? yb : y_at(to);
        if (y0 < y1) column.pieces.push_back({from, y0, to, y1, e.winding});
    }
}

/// What is open at the left side of a column, where the sum takes it to be as the winding number `before`
/// says. `winding` is the true one at the top.
void add_left_side(std::vector<LeftChange> changes, double top, int before, int winding,
                   RowAccumulator& row) {
    std::sort(changes.begin(), changes.end(),
              [](const LeftChange& a, const LeftChange& b) { return a.y < b.y; });
    changes.push_back({top + 1, 0});
    double from = top;
    for (const LeftChange& c : changes) {
        if ((before > 0) != (winding > 0)) row.add(-1, -1, c.y - from, winding > 0 ? 1 : -1);
        winding += c.change;
        from = c.y;
    }
}

/// The same as add_slabs(), for many edges: of a row with thousands, few share a texel, and ends elsewhere
/// need not cut them.
int add_columns(const std::vector<OutlineEdge>& edges, double top, int winding, RowAccumulator& row,
                CoverageWork& work) {
    double left = row.width(), right = 0;
    std::vector<std::pair<double, int>> at_top;
    int behind = winding;
    for (const OutlineEdge& e : edges) {
        left = std::min({left, e.x0, e.x1});
        right = std::max({right, e.x0, e.x1});
        if (e.winding == 0 || e.y0 > top || e.y1 <= top) continue;
        at_top.emplace_back(e.at(top), e.winding);
        behind += e.winding;
    }
    const int width = row.width(), before = winding;
    const auto border = [&](double x, int low) {
        return static_cast<int>(std::clamp(x, static_cast<double>(low), static_cast<double>(width)));
    };
    const int first = border(std::floor(left), 0),
              last = border(std::ceil(right), std::min(first + 1, width));
    std::sort(at_top.begin(), at_top.end());
    std::vector<Column> columns(static_cast<std::size_t>(last - first));
    for (const OutlineEdge& e : edges)
        cut_at_columns(e, top, first, columns);
    std::size_t next = 0;
    for (int x = first; x < last; ++x) {
        for (; next < at_top.size() && at_top[next].first < x; ++next)
            winding += at_top[next].second;
        Column& column = columns[static_cast<std::size_t>(x - first)];
        // Later columns begin with what the one before has left open.
        if (x == first) add_left_side(column.changes, top, before, winding, row);
        add_slabs(column.pieces, column.changes, top, winding, row, work);
    }
    return behind;
}

}  // namespace

int add_edges(std::vector<OutlineEdge>& edges, double top, int winding, RowAccumulator& row,
              CoverageWork& work) {
    constexpr std::size_t many = 512;
    if (edges.size() > many) return add_columns(edges, top, winding, row, work);
    std::vector<LeftChange> none;
    return add_slabs(edges, none, top, winding, row, work);
}

}  // namespace obscura
