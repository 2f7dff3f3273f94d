#pragma once
// Rays to one sun from anywhere, above the ground or between its samples: for pictures, which see more than
// samples.

#include <cstdint>

#include "raster/heights/height_field.h"
#include "raster/heights/height_pyramid.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/sun_view.h"

namespace obscura {

/// Columns and rows of the grid, which may lie between samples, and metres.
struct HeightPoint {
    double x = 0, y = 0, height_m = 0;
};

/// A place on the ground: a cell, by its north-western sample, and how far into it, 0 to 1 each.
struct GroundPlace {
    int cell_x = 0, cell_y = 0;
    double right = 0, down = 0;
};

/// What rays did, for counts.
struct HeightRayCounts {
    std::int64_t rays = 0;
    std::int64_t cells = 0;   ///< looked at
    std::int64_t blocks = 0;  ///< passed over, each at one look
};

/// Height of the triangles there.
double ground_height_m(const HeightField& field, const GroundPlace& place);

/// Borrows both. Ground counts as above a ray when it is by more than doubles can err (doubt_m(), some 1e-9
/// m); rays from samples are decided exactly, like those of height_march.h.
class HeightRays {
  public:
    HeightRays(const HeightField& field, const HeightPyramid& pyramid, const HeightSun& sun);

    /// Whether ground hides the sun from a place on it. At most `last_lines` lines beyond the line that the
    /// place lies on, or that is next to it on the sun's side: at a sample march_shadows(field, sun, {0,
    /// last_lines}), bit for bit.
    bool ground_hidden(const GroundPlace& place, int last_lines, HeightRayCounts* counts = nullptr) const;

    /// Whether ground hides it from a point that lies above the ground, or beside the grid, whose border is a
    /// wall; as far as the grid goes.
    bool hidden(const HeightPoint& point, HeightRayCounts* counts = nullptr) const;

    double doubt_m() const { return doubt_m_; }

  private:
    /// A point as this sun sees it.
    struct Start {
        double line, row, height_m;
    };
    /// Cells (line, row) to (line + 1, row + 1) of the view.
    struct Cell {
        int line, row;
    };
    enum class Answer { lit, hidden, tie };

    Start seen_from_sun(double x, double y, double height_m) const;
    Cell in_grid(Cell cell) const;
    Answer march(const Start& start, double from, int end_line, HeightRayCounts& counts) const;
    double surface_m(Cell cell, double p, double q) const;
    double highest_in(const Start& start, Cell cell, double from, double to) const;
    double leave_block(const Start& start, int level, Cell& cell) const;

    const HeightField& field_;
    const HeightPyramid& pyramid_;
    HeightSun sun_;
    SunView view_;
    double slope_, rise_m_, greatest_m_, doubt_m_;
};

}  // namespace obscura
