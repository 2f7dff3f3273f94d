// Lesson 9. Quads: an aperture as few rectangles, from its texels up.
//
// You learn: four texels hand one value on to the level above and write down what they have beyond it, by
// four rules; each level holds what the next coarser one cannot say; so quads stand along the edge only and
// their number grows with the perimeter, not with the area. L. Scandolo, "Compression and rendering with
// image-based representations", thesis, 2019, section 3.4.2, figure 3.2, table 3.1.
//
// Calls: optics/aperture_shapes.h make_aperture, optics/field/quads.h quads_of, mask_of.

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/aperture_panels.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/pattern_panels.h"

namespace obscura {
namespace {

constexpr Rgb8 handed_on{196, 200, 206};

// Step 1: the rules, one mask of 2 x 2 texels each.
struct Rule {
    const char *name, *quads;
    std::array<float, 4> open;
};
constexpr Rule rules[] = {{"four open", "the parent: nothing to write here", {1, 1, 1, 1}},
                          {"one open", "a square", {0, 1, 0, 0}},
                          {"two on a diagonal", "two squares", {1, 0, 0, 1}},
                          {"two side by side", "one rectangle", {0, 0, 1, 1}},
                          {"three open", "the parent less a square", {1, 1, 1, 0}}};

void draw_rule(Figure& f, const Rule& rule, Vec2d at) {
    constexpr int side = 32;
    Image<float> mask(2, 2);
    std::copy(rule.open.begin(), rule.open.end(), mask.pixels.begin());
    f.text(at, rule.name, lettering::bold);
    draw_mask(f, {at.x, at.y + 14}, side, mask.view(), ink::soft);
    f.arrow({at.x + 71, at.y + 46}, {at.x + 96, at.y + 46}, {ink::soft, 2});
    const QuadList quads = quads_of(mask.view());
    for (std::size_t k = 0; k < quads.size(); ++k) {
        const Cells cells{{at.x + 104 + 86.0 * static_cast<double>(k), at.y + 14}, side, 2, 2};
        f.fill(cells.box(), ink::panel);
        draw_quads(f, cells.origin, side, quads_where(quads, [k](std::size_t i) { return i == k; }));
        f.frame(cells.box(), {ink::soft, 1});
        if (k > 0)
            f.text(cells.at(0, 1) + Vec2d{-11, 6}, quads.weight[k] > 0 ? "+" : "−",
                   {12, ink::dark, Align::centre, true});
    }
    f.text({at.x, at.y + 100}, rule.quads);
}

// Step 2: what a level hands on (the sum of all larger quads), and what it writes.
void draw_level(Figure& f, const QuadList& quads, int side, Vec2d origin) {
    constexpr int texel = 4;
    const QuadList larger = quads_where(quads, [&](std::size_t k) { return level_side(quads, k) > side; });
    const QuadList own = quads_where(quads, [&](std::size_t k) { return level_side(quads, k) == side; });
    draw_mask(f, origin, texel, mask_of(larger).view(), handed_on);
    draw_quads(f, origin, texel, own);
    f.text(origin - Vec2d{0, 10}, fmt::format("{} × {}", side, side), lettering::bold);
    f.text(origin + Vec2d{quads.columns * texel * 1.0, -10},
           fmt::format("{} quads, {} negative", own.size(), count_negative(own)), lettering::right);
}

// Step 3: quads against texels, for larger and larger masks.
void draw_growth(Figure& f, const Plot& plot, Vec2d table) {
    decade_axes(f, plot, false, "mask of N × N texels", "");
    f.polyline({plot.at(0, decades_of(16384)), plot.at(3, decades_of(1048576))}, {ink::red, 2, 6});
    f.text(plot.at(1.4, decades_of(65536)) + Vec2d{-30, -22}, "texels", {9, ink::red, Align::left, true});
    f.text(plot.at(1.4, decades_of(700)) + Vec2d{0, 24}, "quads", {9, ink::dark, Align::left, true});
    constexpr ApertureKind kinds[] = {ApertureKind::whirl, ApertureKind::iris, ApertureKind::circle,
                                      ApertureKind::box};
    const char* names[] = {"whirl", "heptagon", "circle", "box"};
    constexpr Rgb8 colors[] = {ink::purple, ink::blue, ink::green, ink::orange};
    f.text(table, "N", lettering::bold);
    for (int row = 0; row < 4; ++row) {
        std::vector<Vec2d> line;
        const double y = table.y + 34 + 30 * row;
        f.text({table.x, y}, names[row], {9.5, colors[row], Align::left, true});
        for (int i = 0; i < 4; ++i) {
            const int size = 128 << i;
            const std::size_t count = quads_of(binary_mask(kinds[row], size).view()).size();
            line.push_back(plot.at(i, decades_of(static_cast<double>(count))));
            f.disc(line.back(), 3.5, colors[row]);
            f.text({table.x + 144 + 62 * i, y}, fmt::format("{}", count), lettering::right);
            if (row > 0) continue;
            f.text({table.x + 144 + 62 * i, table.y}, fmt::format("{}", size),
                   {9.5, ink::dark, Align::right, true});
            f.text(plot.at(i, plot.y0) + Vec2d{0, 18}, fmt::format("{}", size), lettering::tick);
        }
        f.polyline(line, {colors[row], 2});
    }
}

// Step 4: the sizes of one mask's quads.
void draw_sizes(Figure& f, const QuadList& quads, const Box& box) {
    double y = box.y;
    for (int side = 1; side <= quads.columns; side *= 2) {
        const QuadList own = quads_where(quads, [&](std::size_t k) { return level_side(quads, k) == side; });
        if (own.size() == 0) continue;
        const double share = static_cast<double>(own.size()) / static_cast<double>(quads.size());
        const double bar = 2 * share * (box.w - 184);
        f.text({box.x + 72, y + 12}, fmt::format("{} × {}", side, side), lettering::right);
        f.fill({box.x + 84, y, bar, 15}, positive_quad);
        f.text({box.x + 92 + bar, y + 12}, fmt::format("{} · {:.1f} %", own.size(), 100 * share), {9});
        y += 24;
    }
}

}  // namespace

Image<Rgb8> lesson_9_quads(const Exec&) {
    Figure f(lesson_width, lesson_height);
    f.heading(9, "Quads of an aperture",
              "Four texels hand one value on and write down the rest: an aperture as few signed rectangles.");
    for (int i = 0; i < 5; ++i)
        draw_rule(f, rules[i], {40 + 316.0 * i, 142});
    const Image<float> mask = binary_mask(ApertureKind::iris, 64);
    const QuadList quads = quads_of(mask.view());
    CHECK(mask_of(quads).pixels == mask.pixels);
    f.text({40, 294}, fmt::format("A heptagon of 64 × 64 texels, from its texels up: {} quads", quads.size()),
           lettering::head);
    for (int i = 0; i < 5; ++i)
        draw_level(f, quads, 1 << i, {40 + 316.0 * i, 338});
    f.legend({40, 628}, {{Mark::square, positive_quad, "quads of weight +1"},
                         {Mark::square, negative_quad, "quads of weight −1"},
                         {Mark::square, handed_on, "handed on: the sum of all larger quads"}});
    f.text({40, 684}, "Number of quads (log scale)", lettering::head);
    draw_growth(f, {{84, 716, 260, 190}, 0, 3, 2, 6.2}, {400, 740});
    f.text({800, 684}, "Sizes of quads: heptagon, N = 1024", lettering::head);
    draw_sizes(f, quads_of(binary_mask(ApertureKind::iris, 1024).view()), {800, 712, 370, 240});
    f.paragraph({1200, 684}, "What it is good for", lettering::head);
    f.paragraph(
        {1200, 714},
        "The Fourier transform of a rectangle is\nknown in closed form, whatever its size;\n"
        "lesson 10 adds them up.\n \nTwice the resolution costs twice the\nquads, for four times "
        "the texels: half of\nall quads are as small as a texel and lie\nalong the edge. A box needs few or "
        "many,\nas its edges fall among the squares.");
    f.source_line(9, "optics/field/quads.h quads_of mask_of · optics/aperture_shapes.h make_aperture");
    return f.picture;
}

}  // namespace obscura
