#pragma once
// A drawing surface for annotated figures. Positions in pixels, y down, (0, 0) the upper left corner of the
// upper left pixel. Everything is anti-aliased by coverage and painted over what is there; coverage blends
// sRGB codes, as drawing programs do, so that thin dark lines and light ones look equally strong. Only
// + - * / and sqrt reach a pixel: the same figure everywhere.

#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/pixel.h"
#include "core/vec.h"

namespace obscura {

/// Colours that stay apart for colour-blind readers (M. Okabe, K. Ito, "Color Universal Design", 2008), and
/// greys.
namespace ink {
constexpr Rgb8 paper{253, 252, 249}, panel{242, 241, 236}, grid{208, 207, 201}, grey{128, 128, 126},
    soft{84, 86, 92}, dark{30, 32, 38};
constexpr Rgb8 orange{230, 159, 0}, sky{86, 180, 233}, green{0, 158, 115}, yellow{240, 228, 66},
    blue{0, 114, 178}, red{213, 94, 0}, purple{204, 121, 167};
}  // namespace ink

/// share 0: a, 1: b.
Rgb8 mix(Rgb8 a, Rgb8 b, double share);
/// Dark blue over green to yellow for t in [0, 1], lightness rising all the way (after "viridis" by S. van
/// der Walt and N. Smith, 2015).
Rgb8 heat(double t);
/// Dark or paper, whichever reads better on `background`.
Rgb8 readable_on(Rgb8 background);

struct Box {
    double x = 0, y = 0, w = 0, h = 0;
    Vec2d centre() const { return {x + 0.5 * w, y + 0.5 * h}; }
};

/// Square cells of a map, enlarged.
struct Cells {
    Vec2d origin;
    double side = 10;
    int columns = 0, rows = 0;
    /// Of a position in texels.
    Vec2d at(double x, double y) const { return {origin.x + x * side, origin.y + y * side}; }
    Vec2d centre(int x, int y) const { return at(x + 0.5, y + 0.5); }
    Box cell(int x, int y) const { return {origin.x + x * side, origin.y + y * side, side, side}; }
    Box box() const { return {origin.x, origin.y, columns * side, rows * side}; }
    /// Calls fn(x, y) for every cell, row by row.
    template <class Fn>
    void each(Fn&& fn) const {
        for (int i = 0; i < columns * rows; ++i)
            fn(i % columns, i / columns);
    }
};

/// A rectangle with coordinates of its own, y up.
struct Plot {
    Box box;
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
    Vec2d at(double x, double y) const {
        return {box.x + box.w * (x - x0) / (x1 - x0), box.y + box.h * (y1 - y) / (y1 - y0)};
    }
};

struct Pen {
    Rgb8 color = ink::dark;
    double width_px = 1.5;
    double dash_px = 0;  ///< > 0: dashes of this length and gaps as long
};

enum class Align { left, centre, right };

struct Lettering {
    double cap_px = 9.5;  ///< height of capitals
    Rgb8 color = ink::dark;
    Align align = Align::left;
    bool bold = false;
    bool halo = false;  ///< a rim of paper keeps the text apart from what it crosses
};

/// Sizes that all lessons use.
namespace lettering {
constexpr Lettering head{11.5, ink::dark, Align::left, true, false};
constexpr Lettering body{};
constexpr Lettering right{9.5, ink::dark, Align::right, false, false};
constexpr Lettering bold{9.5, ink::dark, Align::left, true, false};
constexpr Lettering tick{9, ink::soft, Align::centre, false, false};
constexpr Lettering small{7.5, ink::dark, Align::centre, false, true};
}  // namespace lettering

enum class Mark { square, frame, dot, ring, up, down, line, dashes };
struct LegendEntry {
    Mark mark = Mark::square;
    Rgb8 color;
    std::string text;
};

class Figure {
  public:
    Figure(int width, int height);

    void fill(const Box& box, Rgb8 color, double alpha = 1);
    void frame(const Box& box, const Pen& pen = {});
    void grid(const Cells& cells, const Pen& pen);
    /// Texel numbers above and left of the cells, every `step`.
    void ticks(const Cells& cells, int step);
    /// `fine` with its upper left corner at (x, y), every shrink x shrink of its pixels averaged to one.
    void image(int x, int y, const Image<Rgb8>& fine, int shrink);
    /// Left and lower axis, with what they measure at their ends.
    void axes(const Plot& plot, std::string_view x_name, std::string_view y_name);
    /// Any simple polygon of at least three corners.
    void polygon(const std::vector<Vec2d>& corners, Rgb8 color, double alpha = 1);
    void line(Vec2d from, Vec2d to, const Pen& pen = {});
    void polyline(const std::vector<Vec2d>& points, const Pen& pen);
    /// A line with a filled head at `to`.
    void arrow(Vec2d from, Vec2d to, const Pen& pen, double head_px = 10);
    void disc(Vec2d centre, double radius, Rgb8 color);
    void ring(Vec2d centre, double radius, const Pen& pen);
    /// Triangle of this half height: way -1 points up, +1 down.
    void marker(Vec2d centre, double half_px, int way, Rgb8 color);

    /// `at`: on the baseline, at the left end, middle or right end.
    void text(Vec2d at, std::string_view utf8, const Lettering& style = {});
    /// Lines from `at` downwards, split at '\n'. Returns the baseline after the last.
    double paragraph(Vec2d at, std::string_view utf8, const Lettering& style = {}, double leading = 1.9);
    /// Centred in the box, both ways.
    void label(const Box& box, std::string_view utf8, Lettering style = {});
    /// Marks with their meaning, one after the other; `at` is the first baseline. Returns the right end.
    double legend(Vec2d at, const std::vector<LegendEntry>& entries);
    static double text_width(std::string_view utf8, double cap_px);

    /// Title, one sentence below it and a rule: the head of every lesson's picture. The body begins at y =
    /// 120.
    void heading(int lesson, std::string_view title, std::string_view sentence);
    /// The last line of a picture: which functions it calls, and its command.
    void source_line(int lesson, std::string_view functions);

    Image<Rgb8> picture;

  private:
    void blend(int x, int y, Rgb8 color, double alpha);
    void strokes(const std::vector<std::vector<Vec2d>>& lines, double width_px, Rgb8 color);
};

}  // namespace obscura
