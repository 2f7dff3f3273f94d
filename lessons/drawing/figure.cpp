#include "lessons/drawing/figure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/font.h"

namespace obscura {
namespace {

/// Rounds by truncation: what is converted is never negative.
std::uint8_t mix_code(std::uint8_t a, std::uint8_t b, double share) {
    return static_cast<std::uint8_t>(std::floor(a + (b - a) * share + 0.5));
}

double distance_squared(Vec2d p, Vec2d a, Vec2d b) {
    const Vec2d d = b - a, q = p - a;
    const double along = d.x * q.x + d.y * q.y, whole = d.x * d.x + d.y * d.y;
    const double t = whole > 0 ? std::clamp(along / whole, 0.0, 1.0) : 0.0;
    const Vec2d off = q - d * t;
    return off.x * off.x + off.y * off.y;
}

double distance(Vec2d a, Vec2d b) {
    return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

/// Pixels [x0, x1) x [y0, y1) of a picture that a shape may touch.
struct PixelBox {
    int x0, y0, x1, y1;
    PixelBox(double left, double top, double right, double bottom, const Image<Rgb8>& picture)
        : x0(std::clamp(static_cast<int>(std::floor(left)), 0, picture.width)),
          y0(std::clamp(static_cast<int>(std::floor(top)), 0, picture.height)),
          x1(std::clamp(static_cast<int>(std::ceil(right)), 0, picture.width)),
          y1(std::clamp(static_cast<int>(std::ceil(bottom)), 0, picture.height)) {}
};

PixelBox pixels_around(const std::vector<std::vector<Vec2d>>& lines, double margin,
                       const Image<Rgb8>& picture) {
    Vec2d low{1e9, 1e9}, high{-1e9, -1e9};
    for (const auto& line : lines) {
        for (const Vec2d p : line) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }
    return {low.x - margin, low.y - margin, high.x + margin, high.y + margin, picture};
}

/// Dashes of a polyline; the pattern runs on around its corners.
std::vector<std::vector<Vec2d>> dashed(const std::vector<Vec2d>& points, double dash) {
    std::vector<std::vector<Vec2d>> dashes;
    bool down = true;
    double left = dash;
    dashes.push_back({points.front()});
    for (std::size_t i = 1; i < points.size(); ++i) {
        Vec2d from = points[i - 1];
        for (double rest = distance(from, points[i]); rest > 0;) {
            const double step = std::min(rest, left);
            from = from + (points[i] - from) * (step / rest);
            rest -= step;
            left -= step;
            if (down) dashes.back().push_back(from);
            if (left > 0) continue;
            down = !down;
            left = dash;
            if (down) dashes.push_back({from});
        }
    }
    return dashes;
}

/// Share of each pixel of row y that the polygon covers: exact across, sixteen scan lines down.
void row_coverage(const std::vector<Vec2d>& corners, int y, int x0, std::vector<double>& coverage) {
    constexpr int scan_lines = 16;
    std::vector<double> crossings;
    for (int s = 0; s < scan_lines; ++s) {
        const double at = y + (s + 0.5) / scan_lines;
        crossings.clear();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec2d a = corners[i], b = corners[(i + 1) % corners.size()];
            if ((a.y <= at) == (b.y <= at)) continue;
            crossings.push_back(a.x + (b.x - a.x) * ((at - a.y) / (b.y - a.y)) - x0);
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            for (std::size_t x = 0; x < coverage.size(); ++x) {
                const auto left = static_cast<double>(x);
                const double inside = std::min(crossings[i + 1], left + 1) - std::max(crossings[i], left);
                coverage[x] += std::max(inside, 0.0) / scan_lines;
            }
        }
    }
}

double pen_for(const Lettering& style) {
    return std::max(style.cap_px * (style.bold ? 0.185 : 0.115), style.bold ? 1.8 : 1.25);
}

}  // namespace

Rgb8 mix(Rgb8 a, Rgb8 b, double share) {
    const double t = std::clamp(share, 0.0, 1.0);
    if (t == 1.0) return b;
    return {mix_code(a.r, b.r, t), mix_code(a.g, b.g, t), mix_code(a.b, b.b, t)};
}

Rgb8 heat(double t) {
    constexpr Rgb8 stops[] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double at = std::clamp(t, 0.0, 1.0) * 4;
    const int i = std::min(static_cast<int>(at), 3);
    return mix(stops[i], stops[i + 1], at - i);
}

Rgb8 readable_on(Rgb8 background) {
    return 0.30 * background.r + 0.59 * background.g + 0.11 * background.b > 120 ? ink::dark : ink::paper;
}

Figure::Figure(int width, int height) : picture(width, height, ink::paper) {}

void Figure::blend(int x, int y, Rgb8 color, double alpha) {
    Rgb8& pixel = picture(x, y);
    pixel = mix(pixel, color, alpha);
}

/// All strokes as one shape: where they meet, nothing is painted twice.
void Figure::strokes(const std::vector<std::vector<Vec2d>>& lines, double width_px, Rgb8 color) {
    if (lines.empty()) return;
    const double reach = 0.5 * width_px + 0.5;
    const PixelBox all = pixels_around(lines, reach, picture);
    Image<float> coverage(std::max(all.x1 - all.x0, 0), std::max(all.y1 - all.y0, 0));
    const auto segment = [&](Vec2d a, Vec2d b) {
        // Pieces keep the boxes of slanting lines small.
        const int pieces = 1 + static_cast<int>(distance(a, b) / 24);
        for (int i = 0; i < pieces; ++i) {
            const Vec2d from = a + (b - a) * (static_cast<double>(i) / pieces),
                        to = a + (b - a) * (static_cast<double>(i + 1) / pieces);
            const PixelBox box = pixels_around({{from, to}}, reach, picture);
            for (int y = box.y0; y < box.y1; ++y) {
                for (int x = box.x0; x < box.x1; ++x) {
                    const double d2 = distance_squared({x + 0.5, y + 0.5}, from, to);
                    if (d2 >= reach * reach) continue;
                    float& c = coverage(x - all.x0, y - all.y0);
                    c = std::max(c, static_cast<float>(std::min(reach - std::sqrt(d2), 1.0)));
                }
            }
        }
    };
    for (const auto& line : lines) {
        if (line.size() == 1) segment(line[0], line[0]);
        for (std::size_t i = 1; i < line.size(); ++i)
            segment(line[i - 1], line[i]);
    }
    for (int y = 0; y < coverage.height; ++y) {
        for (int x = 0; x < coverage.width; ++x) {
            if (coverage(x, y) > 0) blend(all.x0 + x, all.y0 + y, color, coverage(x, y));
        }
    }
}

void Figure::fill(const Box& box, Rgb8 color, double alpha) {
    const PixelBox all(box.x, box.y, box.x + box.w, box.y + box.h, picture);
    for (int y = all.y0; y < all.y1; ++y) {
        const double down = std::min(box.y + box.h, y + 1.0) - std::max(box.y, y + 0.0);
        for (int x = all.x0; x < all.x1; ++x) {
            const double across = std::min(box.x + box.w, x + 1.0) - std::max(box.x, x + 0.0);
            blend(x, y, color, alpha * across * down);
        }
    }
}

void Figure::frame(const Box& b, const Pen& pen) {
    polyline({{b.x, b.y}, {b.x + b.w, b.y}, {b.x + b.w, b.y + b.h}, {b.x, b.y + b.h}, {b.x, b.y}}, pen);
}

void Figure::grid(const Cells& cells, const Pen& pen) {
    const Box b = cells.box();
    const double half = 0.5 * pen.width_px;  // whole pixels stay crisp
    for (int x = 0; x <= cells.columns; ++x)
        fill({std::floor(b.x + x * cells.side - half + 0.5), b.y, pen.width_px, b.h}, pen.color);
    for (int y = 0; y <= cells.rows; ++y)
        fill({b.x, std::floor(b.y + y * cells.side - half + 0.5), b.w, pen.width_px}, pen.color);
}

void Figure::ticks(const Cells& cells, int step) {
    Lettering style = lettering::tick;
    for (int x = 0; x <= cells.columns; x += step)
        text(cells.at(x, 0) - Vec2d{0, 8}, fmt::format("{}", x), style);
    style.align = Align::right;
    for (int y = step; y <= cells.rows; y += step)
        text(cells.at(0, y) + Vec2d{-9, 4}, fmt::format("{}", y), style);
}

void Figure::image(int x, int y, const Image<Rgb8>& fine, int shrink) {
    CHECK(x >= 0 && y >= 0 && x + fine.width / shrink <= picture.width &&
          y + fine.height / shrink <= picture.height);
    const int count = shrink * shrink;
    for (int row = 0; row < fine.height / shrink; ++row) {
        for (int column = 0; column < fine.width / shrink; ++column) {
            int r = count / 2, g = count / 2, b = count / 2;
            for (int i = 0; i < count; ++i) {
                const Rgb8 c = fine(column * shrink + i % shrink, row * shrink + i / shrink);
                r += c.r, g += c.g, b += c.b;
            }
            picture(x + column, y + row) = {static_cast<std::uint8_t>(r / count),
                                            static_cast<std::uint8_t>(g / count),
                                            static_cast<std::uint8_t>(b / count)};
        }
    }
}

void Figure::axes(const Plot& plot, std::string_view x_name, std::string_view y_name) {
    const Box& b = plot.box;
    fill(b, ink::panel);
    arrow({b.x, b.y + b.h}, {b.x + b.w + 14, b.y + b.h}, {ink::dark, 1.5, 0});
    arrow({b.x, b.y + b.h}, {b.x, b.y - 14}, {ink::dark, 1.5, 0});
    text({b.x + b.w + 12, b.y + b.h + 18}, x_name, {9, ink::soft, Align::right, false, false});
    text({b.x + 12, b.y - 8}, y_name, {9, ink::soft, Align::left, false, false});
}

void Figure::polygon(const std::vector<Vec2d>& corners, Rgb8 color, double alpha) {
    CHECK(corners.size() >= 3);
    const PixelBox all = pixels_around({corners}, 0, picture);
    for (int y = all.y0; y < all.y1; ++y) {
        std::vector<double> coverage(static_cast<std::size_t>(std::max(all.x1 - all.x0, 0)), 0.0);
        row_coverage(corners, y, all.x0, coverage);
        for (int x = all.x0; x < all.x1; ++x)
            blend(x, y, color, alpha * coverage[static_cast<std::size_t>(x - all.x0)]);
    }
}

void Figure::line(Vec2d from, Vec2d to, const Pen& pen) {
    polyline({from, to}, pen);
}

void Figure::polyline(const std::vector<Vec2d>& points, const Pen& pen) {
    if (points.empty()) return;
    strokes(pen.dash_px > 0 ? dashed(points, pen.dash_px) : std::vector<std::vector<Vec2d>>{points},
            pen.width_px, pen.color);
}

void Figure::arrow(Vec2d from, Vec2d to, const Pen& pen, double head_px) {
    const double whole = distance(from, to);
    CHECK(whole > 0);
    const Vec2d along = (to - from) * (1 / whole), across{-along.y, along.x};
    const Vec2d neck = to - along * std::min(head_px, whole);
    line(from, neck, pen);
    polygon({to, neck + across * (0.42 * head_px), neck - across * (0.42 * head_px)}, pen.color);
}

void Figure::disc(Vec2d centre, double radius, Rgb8 color) {
    strokes({{centre}}, 2 * radius, color);
}

void Figure::ring(Vec2d centre, double radius, const Pen& pen) {
    // A quarter turn by the tangent of half the angle; the other three by symmetry.
    constexpr int steps = 12;
    std::vector<Vec2d> quarter, whole;
    for (int i = 0; i < steps; ++i) {
        const double t = 0.41421356237309503 * i / steps;
        const double c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
        quarter.push_back({c * radius, s * radius});
    }
    const std::size_t eighth = quarter.size();
    quarter.push_back({radius * 0.70710678118654752, radius * 0.70710678118654752});
    for (std::size_t i = eighth; i-- > 1;)
        quarter.push_back({quarter[i].y, quarter[i].x});
    for (const Vec2d q : quarter)
        whole.push_back(q);
    for (const Vec2d q : quarter)
        whole.push_back({-q.y, q.x});
    for (const Vec2d q : quarter)
        whole.push_back({-q.x, -q.y});
    for (const Vec2d q : quarter)
        whole.push_back({q.y, -q.x});
    whole.push_back(whole.front());
    for (Vec2d& p : whole)
        p = p + centre;
    polyline(whole, pen);
}

void Figure::marker(Vec2d centre, double half_px, int way, Rgb8 color) {
    const double tip = way * half_px;
    polygon({{centre.x, centre.y + tip},
             {centre.x - 1.05 * half_px, centre.y - tip},
             {centre.x + 1.05 * half_px, centre.y - tip}},
            color);
}

double Figure::text_width(std::string_view utf8, double cap_px) {
    return text_strokes(utf8).width * (cap_px / font_cap_height);
}

void Figure::text(Vec2d at, std::string_view utf8, const Lettering& style) {
    TextStrokes text = text_strokes(utf8);
    const double scale = style.cap_px / font_cap_height, width = text.width * scale;
    const double shift = style.align == Align::left ? 0 : (style.align == Align::right ? width : 0.5 * width);
    for (auto& stroke : text.strokes) {
        for (Vec2d& p : stroke)
            p = {at.x - shift + p.x * scale, at.y - p.y * scale};
    }
    if (style.halo) strokes(text.strokes, pen_for(style) + 5, ink::paper);
    strokes(text.strokes, pen_for(style), style.color);
}

double Figure::paragraph(Vec2d at, std::string_view utf8, const Lettering& style, double leading) {
    while (!utf8.empty()) {
        const std::size_t end = std::min(utf8.find('\n'), utf8.size());
        text(at, utf8.substr(0, end), style);
        at.y += style.cap_px * leading;
        utf8.remove_prefix(std::min(end + 1, utf8.size()));
    }
    return at.y;
}

void Figure::label(const Box& box, std::string_view utf8, Lettering style) {
    style.align = Align::centre;
    text({box.centre().x, box.centre().y + 0.5 * style.cap_px}, utf8, style);
}

double Figure::legend(Vec2d at, const std::vector<LegendEntry>& entries) {
    for (const LegendEntry& e : entries) {
        const Vec2d c{at.x + 10, at.y - 0.5 * lettering::body.cap_px};
        switch (e.mark) {
            case Mark::square:
                fill({c.x - 8, c.y - 8, 16, 16}, e.color);
                break;
            case Mark::frame:
                frame({c.x - 8, c.y - 8, 16, 16}, {e.color, 2.5, 0});
                break;
            case Mark::dot:
                disc(c, 6, e.color);
                break;
            case Mark::ring:
                ring(c, 8, {e.color, 2, 0});
                break;
            case Mark::up:
                marker(c, 7, -1, e.color);
                break;
            case Mark::down:
                marker(c, 7, 1, e.color);
                break;
            case Mark::line:
                line({c.x - 10, c.y}, {c.x + 10, c.y}, {e.color, 3, 0});
                break;
            case Mark::dashes:
                line({c.x - 10, c.y}, {c.x + 10, c.y}, {e.color, 2, 4});
                break;
        }
        text({at.x + 28, at.y}, e.text, lettering::body);
        at.x += 28 + text_width(e.text, lettering::body.cap_px) + 28;
    }
    return at.x;
}

void Figure::heading(int lesson, std::string_view title, std::string_view sentence) {
    const auto width = static_cast<double>(picture.width);
    const Box number{40, 30, 52, 52};
    fill(number, ink::dark);
    label(number, fmt::format("{}", lesson), {24, ink::paper, Align::centre, true, false});
    text({112, 54}, title, {22, ink::dark, Align::left, true, false});
    text({112, 82}, sentence, {11.5, ink::soft, Align::left, false, false});
    line({40, 98}, {width - 40, 98}, {ink::dark, 1.5, 0});
}

void Figure::source_line(int lesson, std::string_view functions) {
    const auto width = static_cast<double>(picture.width), y = static_cast<double>(picture.height) - 22;
    line({40, y - 22}, {width - 40, y - 22}, {ink::grid, 1.5, 0});
    text({40, y}, fmt::format("calls  {}", functions), {9, ink::soft, Align::left, false, false});
    text({width - 40, y}, fmt::format("obscura lesson {} -o lesson.png", lesson),
         {9, ink::soft, Align::right, false, false});
}

}  // namespace obscura
