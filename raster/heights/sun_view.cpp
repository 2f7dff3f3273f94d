#include "raster/heights/sun_view.h"

#include "core/error.h"

namespace obscura {

GridPlace place_of(const HeightField& field, const HeightSun& sun, int line, int row) {
    const int w = field.width(), h = field.height();
    const int lines = sun.lines_are_columns ? w : h, rows = sun.lines_are_columns ? h : w;
    const int across = sun.step_line > 0 ? lines - 1 - line : line;
    const int along = sun.step_along > 0 ? row : rows - 1 - row;
    return sun.lines_are_columns ? GridPlace{across, along} : GridPlace{along, across};
}

SunView sun_view(const HeightField& field, const HeightSun& sun) {
    check_height_field(field);
    CHECK(sun.slope_q20 >= 0 && sun.slope_q20 <= cell_q20);
    CHECK(sun.rise_q36 >= 1 && sun.rise_q36 <= std::int64_t{1} << 53);
    const std::ptrdiff_t down = field.width();
    SunView v;
    v.lines = sun.lines_are_columns ? field.width() : field.height();
    v.rows = sun.lines_are_columns ? field.height() : field.width();
    v.step_line = (sun.lines_are_columns ? 1 : down) * -sun.step_line;
    v.step_row = (sun.lines_are_columns ? down : 1) * sun.step_along;
    const GridPlace origin = place_of(field, sun, 0, 0);
    v.first = &field.height_q16(origin.x, origin.y);
    // Lines and rows that both grow with the grid's see a falling diagonal as it is drawn; each mirroring
    // turns it.
    const bool mirrored_lines = sun.step_line > 0, mirrored_rows = sun.step_along < 0;
    v.crossed_diagonals = (field.diagonal == Diagonal::falling) != (mirrored_lines != mirrored_rows);
    v.slope_q20 = sun.slope_q20;
    v.rise_q36 = sun.rise_q36;
    v.greatest_q16 = height_range(field).greatest_q16;
    return v;
}

}  // namespace obscura
