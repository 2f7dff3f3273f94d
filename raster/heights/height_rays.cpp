// From cell to cell (Amanatides, Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987),
// and over blocks of cells whose greatest height lies below the ray (Tevs, Ihrke, Seidel, "Maximum Mipmaps
// for Fast, Accurate, and Scalable Dynamic Height Field Rendering", I3D 2008). Rays only rise, so one that is
// above a block where it comes to it is above all of it.

#include "raster/heights/height_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "raster/heights/height_march.h"

namespace obscura {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

double ground_height_m(const HeightField& field, const GroundPlace& place) {
    const auto at = [&](int x, int y) {
        return metres_of(field.height_q16(place.cell_x + x, place.cell_y + y));
    };
    const double u = place.right, v = place.down;
    if (field.diagonal == Diagonal::falling) {
        if (u >= v) return at(0, 0) + (at(1, 0) - at(0, 0)) * u + (at(1, 1) - at(1, 0)) * v;
        return at(0, 0) + (at(0, 1) - at(0, 0)) * v + (at(1, 1) - at(0, 1)) * u;
    }
    if (u + v <= 1) return at(0, 0) + (at(1, 0) - at(0, 0)) * u + (at(0, 1) - at(0, 0)) * v;
    return at(1, 1) + (at(0, 1) - at(1, 1)) * (1 - u) + (at(1, 0) - at(1, 1)) * (1 - v);
}

HeightRays::HeightRays(const HeightField& field, const HeightPyramid& pyramid, const HeightSun& sun)
    : field_(field),
      pyramid_(pyramid),
      sun_(sun),
      view_(sun_view(field, sun)),
      slope_(static_cast<double>(view_.slope_q20) / static_cast<double>(cell_q20)),
      rise_m_(std::ldexp(static_cast<double>(view_.rise_q36), -rise_fraction_bits)),
      greatest_m_(metres_of(view_.greatest_q16)) {
    CHECK(field.width() >= 2 && field.height() >= 2);
    // Some thirty roundings of numbers of at most this size; a ray that rises further is above everything.
    doubt_m_ = std::ldexp(4 * largest_height_m + std::min(rise_m_ * view_.lines, 4 * largest_height_m), -45);
}

HeightRays::Start HeightRays::seen_from_sun(double x, double y, double height_m) const {
    const double across = sun_.lines_are_columns ? x : y, along = sun_.lines_are_columns ? y : x;
    return {sun_.step_line > 0 ? view_.lines - 1 - across : across,
            sun_.step_along > 0 ? along : view_.rows - 1 - along, height_m};
}

/// The grid's cell that a cell of the view is, as column and row.
HeightRays::Cell HeightRays::in_grid(Cell cell) const {
    const int across = sun_.step_line > 0 ? view_.lines - 2 - cell.line : cell.line;
    const int along = sun_.step_along > 0 ? cell.row : view_.rows - 2 - cell.row;
    return sun_.lines_are_columns ? Cell{across, along} : Cell{along, across};
}

/// Height at the shares p of the way away from the sun and q of that along a line.
double HeightRays::surface_m(Cell c, double p, double q) const {
    const auto at = [&](int line, int row) {
        return metres_of(view_.height_q16(c.line + line, c.row + row));
    };
    if (view_.crossed_diagonals) {
        // Divided from (line, row) to (line + 1, row + 1).
        if (p >= q) return at(0, 0) + (at(1, 0) - at(0, 0)) * p + (at(1, 1) - at(1, 0)) * q;
        return at(0, 0) + (at(0, 1) - at(0, 0)) * q + (at(1, 1) - at(0, 1)) * p;
    }
    if (p + q <= 1) return at(0, 0) + (at(1, 0) - at(0, 0)) * p + (at(0, 1) - at(0, 0)) * q;
    return at(1, 1) + (at(0, 1) - at(1, 1)) * (1 - p) + (at(1, 0) - at(1, 1)) * (1 - q);
}

/// How far the surface stands above the ray at most over a part of it within one cell, the beginning left
/// out: at the cell's diagonal, or at the part's end.
double HeightRays::highest_in(const Start& s, Cell cell, double from, double to) const {
    const auto above_m = [&](double t) {
        const double p = std::clamp(s.line - t - cell.line, 0.0, 1.0);
        const double q = std::clamp(s.row + slope_ * t - cell.row, 0.0, 1.0);
        return surface_m(cell, p, q) - (s.height_m + rise_m_ * t);
    };
    const double p = s.line - cell.line, q = s.row - cell.row;
    const double diagonal = view_.crossed_diagonals ? (p - q) / (1 + slope_)
                            : slope_ < 1            ? (p + q - 1) / (1 - slope_)
                                                    : never;
    double highest = above_m(to);
    if (diagonal > from && diagonal < to) highest = std::max(highest, above_m(diagonal));
    return highest;
}

/// To the first cell beyond the block that `cell` is in. Returns where on the ray.
double HeightRays::leave_block(const Start& s, int level, Cell& cell) const {
    const int bits = HeightPyramid::step_bits * level, side = 1 << bits;
    const auto low = [&](int at) { return at >> bits << bits; };
    const auto high = [&](int at, int cells) { return std::min(low(at) + side - 1, cells - 1); };
    const int lines = view_.lines - 1, rows = view_.rows - 1;  // of cells
    const int first = sun_.step_line > 0 ? lines - 1 - high(lines - 1 - cell.line, lines) : low(cell.line);
    const int last = sun_.step_along > 0 ? high(cell.row, rows) : rows - 1 - low(rows - 1 - cell.row);
    const double by_line = s.line - first, by_row = slope_ > 0 ? (last + 1 - s.row) / slope_ : never;
    if (by_row < by_line) {
        const int line = static_cast<int>(std::ceil(s.line - by_row)) - 1;
        cell = {std::clamp(line, first, cell.line), last + 1};
        return by_row;
    }
    const int row = static_cast<int>(std::floor(s.row + slope_ * by_line));
    cell = {first - 1, std::clamp(row, cell.row, last)};
    return by_line;
}

HeightRays::Answer HeightRays::march(const Start& s, double from, int end_line,
                                     HeightRayCounts& counts) const {
    ++counts.rays;
    Cell cell{std::min(static_cast<int>(std::ceil(s.line - from)) - 1, view_.lines - 2),
              std::clamp(static_cast<int>(std::floor(s.row + slope_ * from)), 0, view_.rows - 2)};
    double t = from, highest_m = -never;
    int level = pyramid_.top();
    while (cell.line >= end_line && cell.row <= view_.rows - 2) {
        const double ray_m = s.height_m + rise_m_ * t - doubt_m_;
        if (ray_m > greatest_m_) break;
        // The largest block that lies below the ray.
        const Cell place = in_grid(cell);
        for (; level > 0; --level) {
            ++counts.blocks;
            if (metres_of(pyramid_.greatest_q16(level, place.line, place.row)) < ray_m) break;
        }
        if (level > 0) {
            t = leave_block(s, level, cell);
            level = std::min(level + 1, pyramid_.top());
            continue;
        }
        ++counts.cells;
        const double by_line = s.line - cell.line,
                     by_row = slope_ > 0 ? (cell.row + 1 - s.row) / slope_ : never;
        const double to = std::min(by_line, by_row);
        highest_m = std::max(highest_m, highest_in(s, cell, t, to));
        if (highest_m > doubt_m_) return Answer::hidden;
        t = to;
        if (by_row < by_line) {
            ++cell.row;
        } else {
            --cell.line;
        }
        level = std::min(1, pyramid_.top());
    }
    return highest_m >= -doubt_m_ ? Answer::tie : Answer::lit;
}

bool HeightRays::ground_hidden(const GroundPlace& place, int last_lines, HeightRayCounts* counts) const {
    CHECK(place.cell_x >= 0 && place.cell_x < field_.width() - 1 && place.cell_y >= 0 &&
          place.cell_y < field_.height() - 1);
    const Start start =
        seen_from_sun(place.cell_x + place.right, place.cell_y + place.down, ground_height_m(field_, place));
    HeightRayCounts none;
    const int line = static_cast<int>(std::floor(start.line));
    const Answer answer =
        march(start, 0, std::max(0, line - std::min(last_lines, line)), counts ? *counts : none);
    const double row = std::floor(start.row);
    if (answer == Answer::tie && start.line == line && start.row == row)
        return sun_hidden(view_, line, static_cast<int>(row), {.first = 0, .last = last_lines});
    return answer == Answer::hidden;
}

bool HeightRays::hidden(const HeightPoint& point, HeightRayCounts* counts) const {
    const Start start = seen_from_sun(point.x, point.y, point.height_m);
    HeightRayCounts none;
    double from = std::max(0.0, start.line - (view_.lines - 1));
    if (start.row < 0) from = slope_ > 0 ? std::max(from, -start.row / slope_) : never;
    const double line = start.line - from, row = start.row + slope_ * from;
    if (!(line > 0) || row > view_.rows - 1) return false;
    if (from > 0) {
        // It comes in over the border, or against the wall below it. Rounding may leave its row a hair before
        // the first.
        const Cell cell{std::min(static_cast<int>(std::ceil(line)) - 1, view_.lines - 2),
                        std::clamp(static_cast<int>(std::floor(row)), 0, view_.rows - 2)};
        const double border_m =
            surface_m(cell, std::clamp(line - cell.line, 0.0, 1.0), std::clamp(row - cell.row, 0.0, 1.0));
        if (border_m > start.height_m + rise_m_ * from + doubt_m_) return true;
    }
    return march(start, from, 0, counts ? *counts : none) == Answer::hidden;
}

}  // namespace obscura
