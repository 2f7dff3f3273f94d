#include "lessons/facet_panels.h"

#include <cmath>

namespace obscura {
namespace {

void collect(const FacetTree& tree, const FacetNode& node, FacetSquare at, std::vector<FacetSquare>& out) {
    std::uint64_t child = node.first_child;
    for (int i = 0; i < 4; ++i) {
        const int half = at.side / 2;
        FacetSquare square{at.x + (i % 2) * half, at.y + (i / 2) * half, half, nullptr, false};
        const std::uint32_t kind = node.child(i);
        if (kind != 0) square.node = &tree.nodes[child++];
        square.line = (kind & facet_line) != 0;
        if (square.node != nullptr && square.node->kinds != 0) {
            collect(tree, *square.node, square, out);
        } else {
            out.push_back(square);
        }
    }
}

}  // namespace

std::vector<FacetSquare> squares_of(const FacetTree& tree) {
    std::vector<FacetSquare> squares;
    collect(tree, tree.root, {0, 0, 1 << tree.levels, &tree.root, false}, squares);
    return squares;
}

std::vector<Vec2d> crossing(const FacetEdge& e, const FacetSquare& s) {
    std::vector<Vec2d> points;
    const auto at = [&](double x, double y) { return double{e.c} + e.a * (x - 0.5) + e.b * (y - 0.5); };
    const double x[5] = {0, 1, 1, 0, 0}, y[5] = {0, 0, 1, 1, 0};
    for (int i = 0; i < 4; ++i) {
        const Vec2d p{s.x + s.side * x[i], s.y + s.side * y[i]},
            q{s.x + s.side * x[i + 1], s.y + s.side * y[i + 1]};
        const double dp = at(p.x, p.y), dq = at(q.x, q.y);
        if ((dp < 0) != (dq < 0)) points.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    return points;
}

const FacetSquare* largest_ramp(const FacetTree& tree, const std::vector<FacetSquare>& squares) {
    const auto ramped = [](const FacetValue& v) {
        return v.plane != no_plane && v.bits >> 5 != facet_no_ramp && (v.bits & 31u) < facet_no_cap;
    };
    const FacetSquare* shown = nullptr;
    for (const FacetSquare& s : squares) {
        if (!s.line || s.node->value[0].plane == no_plane || s.node->value[1].plane == no_plane) continue;
        if (!ramped(s.node->value[0]) && !ramped(s.node->value[1])) continue;
        if (crossing(tree.edges[s.node->edge], s).size() == 2 && (shown == nullptr || s.side > shown->side))
            shown = &s;
    }
    return shown;
}

int middle_row(const FacetEdge& edge, const FacetSquare& square) {
    int row = square.y;
    double best = 1e300;
    for (int y = square.y; y < square.y + square.side; ++y) {
        const double d = std::fabs(facet_distance(edge, square.x + square.side / 2, y));
        if (d >= best) continue;
        best = d;
        row = y;
    }
    return row;
}

}  // namespace obscura
