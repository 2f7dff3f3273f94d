// The far field of an aperture's outline: exact for the polygon, not for a mask of it.
//
// S.-W. Lee, R. Mittra: Fourier transform of a polygonal shape function and its application in
// electromagnetics, IEEE Transactions on Antennas and Propagation 31(1), 1983; also cited by L. Scandolo
// (thesis, 2019, section 3.2.2). By the divergence theorem, with q = (u, v), edges d between vertices with
// their middle at m, and loops that turn from x to y around what is open,
//
//     F(q) = i / (2 pi |q|^2)  *  sum over edges of (u d_y - v d_x) sinc(q d) e^(-2 pi i q m).
//
// Near q = 0 this divides numbers that cancel by one that vanishes. Around each loop the sum of d is 0, so
// that sinc(q d) e^(-2 pi i q m) - 1 may stand for sinc(q d) e^(-2 pi i q m); it is of the size of q, taken
// relative to the loop's own centre, and is computed without loss (1 - cos and 1 - sinc by their series).
// What remains is as well conditioned as the loop's area by its corners.
//
// Where an edge spans a quarter turn or more, sinc(q d) e^(-2 pi i q m) is the difference of its corners'
// phasors over -2 pi i q d; those are products of a column's and a row's table. Only the pixels along the
// line q d = 0, the streak an edge draws, need a sine of their own.

#include "optics/far_field_polygon.h"

#include <algorithm>
#include <cmath>

#include "core/buffer.h"
#include "core/parallel.h"
#include "optics/far_field_methods.h"
#include "optics/field/field_rows.h"
#include "optics/field/separable_terms.h"

namespace obscura {
namespace {

constexpr int tile = 16;

/// Vertices relative to their loops' centres, and the centres; points as intervals without width.
struct Corners {
    std::vector<std::int32_t> begin{0};
    std::vector<double> x, y;
    IntervalTerms vertex_x, vertex_y, centre_x, centre_y;
};

void add_point(double at, IntervalTerms& terms) {
    terms.add(at, at, 1.0f);
    terms.close_term();
}

Corners corners_of(const Outline& outline, double middle_x, double middle_y) {
    Corners corners;
    for (const std::vector<Vec2d>& loop : outline.loops) {
        if (loop.size() < 3) continue;
        const auto [left, right] = std::minmax_element(
            loop.begin(), loop.end(), [](const Vec2d& a, const Vec2d& b) { return a.x < b.x; });
        const auto [top, bottom] = std::minmax_element(
            loop.begin(), loop.end(), [](const Vec2d& a, const Vec2d& b) { return a.y < b.y; });
        const double cx = (left->x + right->x) * 0.5, cy = (top->y + bottom->y) * 0.5;
        add_point(cx - middle_x, corners.centre_x);
        add_point(cy - middle_y, corners.centre_y);
        for (const Vec2d& p : loop) {
            corners.x.push_back(p.x - cx);
            corners.y.push_back(p.y - cy);
            add_point(p.x - cx, corners.vertex_x);
            add_point(p.y - cy, corners.vertex_y);
        }
        corners.begin.push_back(static_cast<std::int32_t>(corners.x.size()));
    }
    return corners;
}

/// Phasors of points at all frequencies of a ramp, in panels of sixteen.
struct Phases {
    std::size_t panel = 0;  ///< floats of one
    Buffer<float> re, im;
};

Phases phases_of(const IntervalTerms& points, const FrequencyRamp& ramp, const Exec& exec) {
    const auto panels = static_cast<std::size_t>((ramp.count + tile - 1) / tile);
    Phases phases;
    phases.panel = static_cast<std::size_t>(points.count()) * tile;
    phases.re.reset(panels * phases.panel);
    phases.im.reset(panels * phases.panel);
    parallel_for(panels, exec, [&](std::size_t p) {
        OBSCURA_DISPATCH(exec.isa, point_panel, ramp, static_cast<int>(p) * tile, points.view(),
                         phases.re.data() + p * phases.panel, phases.im.data() + p * phases.panel);
    });
    return phases;
}

}  // namespace

void far_field_polygon(const Outline& outline, int width, int height, const FrequencyGrid& grid,
                       const FieldTarget& target, const Exec& exec) {
    CHECK(target.stride >= grid.width);
    if (!outline.disjoint)
        throw InputError("far field", "the polygon transform needs loops that do not cross");
    const Corners corners = corners_of(outline, width * 0.5, height * 0.5);
    const FrequencyRamp u{grid.first_u, grid.step_u, grid.width}, v{grid.first_v, grid.step_v, grid.height};
    const Phases vertex_u = phases_of(corners.vertex_x, u, exec),
                 vertex_v = phases_of(corners.vertex_y, v, exec),
                 centre_u = phases_of(corners.centre_x, u, exec),
                 centre_v = phases_of(corners.centre_y, v, exec);
    const std::size_t columns = static_cast<std::size_t>((grid.width + tile - 1) / tile);
    parallel_for(static_cast<std::size_t>((grid.height + tile - 1) / tile), exec, [&](std::size_t rows) {
        std::vector<float> re(columns * tile), im(columns * tile);
        const int first = static_cast<int>(rows) * tile;
        for (int y = first; y < std::min(first + tile, grid.height); ++y) {
            const std::size_t at_v = rows * vertex_v.panel + static_cast<std::size_t>(y - first),
                              at_cv = rows * centre_v.panel + static_cast<std::size_t>(y - first);
            for (std::size_t c = 0; c < columns; ++c) {
                const PolygonLoops loops{corners.begin.data(),
                                         corners.x.data(),
                                         corners.y.data(),
                                         static_cast<int>(corners.begin.size()) - 1,
                                         vertex_u.re.data() + c * vertex_u.panel,
                                         vertex_u.im.data() + c * vertex_u.panel,
                                         vertex_v.re.data() + at_v,
                                         vertex_v.im.data() + at_v,
                                         centre_u.re.data() + c * centre_u.panel,
                                         centre_u.im.data() + c * centre_u.panel,
                                         centre_v.re.data() + at_cv,
                                         centre_v.im.data() + at_cv};
                OBSCURA_DISPATCH(exec.isa, polygon_row, loops, u, static_cast<int>(c) * tile,
                                 v.first + y * v.step, re.data() + c * tile, im.data() + c * tile);
            }
            put_row(target, y, grid.width, re.data(), im.data());
        }
    });
}

double far_field_polygon_cost_ns(const Outline& outline, const FrequencyGrid& grid) {
    // Every edge at every pixel; and more, sixteen at a time, along the line where it spans half a turn.
    constexpr double per_pixel = 3, per_edge = 0.35, per_streak = 4;
    double edges = 0, streaks = 0;
    for (const auto& loop : outline.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2d a = loop[i], b = loop[i + 1 < loop.size() ? i + 1 : 0];
            const double turns =
                std::max(std::fabs(a.x - b.x) * grid.step_u, std::fabs(a.y - b.y) * grid.step_v);
            streaks += std::min<double>(grid.width, 16 + 0.5 / std::max(turns, 1e-9)) * grid.height;
            ++edges;
        }
    }
    return (per_pixel + per_edge * edges) * grid.width * grid.height + per_streak * streaks;
}

}  // namespace obscura
