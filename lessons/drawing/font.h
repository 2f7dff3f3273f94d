#pragma once
// A stroke font of our own, drawn with a pen of one width: capitals 12 units high, lower case 8, digits all
// of one width so that columns of numbers line up. Enough for figures: ASCII and a few signs of mathematics.

#include <string_view>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// Height of capitals and digits in font units; the baseline is y = 0, y grows upwards, descenders reach -4.
constexpr double font_cap_height = 12.0;

/// One line of text as pen strokes: polylines in font units from x = 0 on (a single point is a dot).
struct TextStrokes {
    std::vector<std::vector<Vec2d>> strokes;
    double width = 0;  ///< of the ink and the half gaps at both ends
};

/// UTF-8. A character that the font does not draw breaks the precondition: no text loses a letter silently.
TextStrokes text_strokes(std::string_view utf8);

}  // namespace obscura
