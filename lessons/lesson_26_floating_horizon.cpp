// Lesson 26. The horizon that never moves.
//
// You learn: along the rays of one sun, ground hides ground. Raise every line of samples by what a ray rises
// on its way to it, and rays lie level: a sample is dark exactly where something nearer the sun stands
// higher. The highest so far is one function, the floating horizon. It never moves, it only grows, and each
// line of samples asks it once and is added to it once, instead of walking along a ray each.
//
// Calls: raster/heights/height_sun.h height_sun, sun_view.h sun_view, profile.h line_profile, strip_profile,
//        upper_envelope, height_sweep.h sweep_shadows, height_rays.h HeightRays.

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ground_panels.h"
#include "lessons/ladder.h"
#include "raster/heights/height_rays.h"
#include "raster/heights/height_sweep.h"
#include "raster/heights/profile.h"
#include "raster/heights/sun_view.h"

namespace obscura {
namespace {

constexpr int side = 110, shown_row = 42;
constexpr int whole[] = {0};

// Steps 1 and 2: one row of the ground under a sun in the east, as it is and raised.
void draw_row(Figure& f, const HeightField& ground) {
    const HeightSun sun = height_sun(ground, 90, 16);
    const ShadowBits dark = sweep_shadows(ground, sun, whole)[0];
    const double rise = rise_m(sun);
    const auto height = [&](int x) { return metres_of(ground.height_q16(x, shown_row)); };
    const Plot bare{{70, 180, 690, 230}, 0, side - 1.0, 0, 1000},
        raised{{860, 180, 690, 230}, 0, side - 1.0, 0, 1600};
    f.text({40, 150}, "1  A row of samples, and rays to a sun in the east, 16 degrees high", lettering::head);
    f.text({830, 150}, "2  Raised by a ray's rise for each line from the sun", lettering::head);
    f.axes(bare, "samples", "metres");
    f.axes(raised, "samples", "g = height + line x rise");
    std::vector<Vec2d> ground_line, raised_line, horizon;
    double highest = -1e9;
    for (int x = side - 1; x >= 0; --x) {
        const int line = side - 1 - x;  // counted from the sun
        const double g = height(x) + line * rise;
        CHECK(dark(x, shown_row) == (highest > g), "a row along the rays is its own horizon");
        highest = std::max(highest, g);
        ground_line.push_back(bare.at(x, height(x)));
        raised_line.push_back(raised.at(x, g));
        horizon.push_back(raised.at(x, highest));
    }
    for (int x = 2; x < side - 1; x += 9) {
        // To what hides the sun, or to the border.
        int end = x + 1;
        while (end < side - 1 && height(end) <= height(x) + (end - x) * rise)
            ++end;
        const Pen pen{dark(x, shown_row) ? ink::red : ink::orange, 1.1, dark(x, shown_row) ? 4.0 : 0.0};
        const double top = std::min(height(x) + (end - x) * rise, bare.y1);
        f.line(bare.at(x, height(x)), bare.at(x + (top - height(x)) / rise, top), pen);
        f.line(raised.at(x, height(x) + (side - 1 - x) * rise),
               raised.at(end, height(x) + (side - 1 - x) * rise), pen);
    }
    f.polyline(ground_line, {ink::soft, 1.4});
    f.polyline(raised_line, {ink::soft, 1.4});
    f.polyline(horizon, {ink::blue, 2.4});
    for (int x = 0; x < side; ++x) {
        const Rgb8 color = dark(x, shown_row) ? ink::red : ink::orange;
        f.disc(bare.at(x, height(x)), 2.6, color);
        f.disc(raised.at(x, height(x) + (side - 1 - x) * rise), 2.6, color);
    }
    f.paragraph({40, 462},
                "A ray from each sample, until something stands above it: that is\nthe definition, and the "
                "oracle of the tests.");
    f.paragraph({830, 462},
                "Rays lie level now. The blue line is the highest so far, from the right;\na sample is dark "
                "where it lies below it.");
}

/// The sweep once more, by its own stages, stopped where it is to be looked at.
struct Stages {
    Profile before, strip, after;  ///< at the line that is looked at
    std::vector<double> now;       ///< its samples' g
    double first_u = 0;            ///< of its first
    std::int64_t pieces = 0;       ///< of all profiles
};
Stages stages_of(const SunView& view, double rise, int stop) {
    Stages s;
    std::vector<double> before, now(static_cast<std::size_t>(view.rows));
    Profile profile, strip, merged;
    for (int line = 0; line < view.lines; ++line) {
        before = now;
        for (int row = 0; row < view.rows; ++row)
            now[static_cast<std::size_t>(row)] = metres_of(view.height_q16(line, row)) + rise * line;
        const double first_u = static_cast<double>(view.slope_q20 * line);
        if (line == stop) s.before = profile;
        if (line == 0) {
            line_profile(now, 0, profile);
        } else {
            strip_profile(before, now,
                          {static_cast<double>(view.slope_q20), first_u, view.crossed_diagonals, 1e-9},
                          strip);
            upper_envelope(profile, strip, first_u, 1e-9, merged);
            std::swap(profile, merged);
        }
        s.pieces += static_cast<std::int64_t>(profile.lines.size());
        if (line != stop) continue;
        s.strip = strip;
        s.after = profile;
        s.now = now;
        s.first_u = first_u;
    }
    return s;
}

// Steps 3 and 4: all rows at once under an oblique sun, and the map.
void draw_sweep(Figure& f, const HeightField& ground) {
    constexpr int stop = 62;
    constexpr double azimuth = 112, elevation = 14;
    const HeightSun sun = height_sun(ground, azimuth, elevation);
    const SunView view = sun_view(ground, sun);
    const Stages s = stages_of(view, rise_m(sun), stop);
    const double first = s.first_u / static_cast<double>(cell_q20);
    const Plot plot{{70, 570, 880, 250}, first, first + side - 1, 480, 1300};
    f.text({40, 540},
           fmt::format("3  All rows at once: line {} of an oblique sun meets the horizon of those before it",
                       stop),
           lettering::head);
    f.axes(plot, "u = row + line x slope", "g");
    draw_profile(f, plot, s.before, {ink::blue, 2.4});
    draw_profile(f, plot, s.strip, {ink::green, 1.6});
    const ShadowBits dark = sweep_shadows(ground, sun, whole)[0];
    int hidden = 0;
    for (int row = 0; row < side; ++row) {
        const GridPlace at = place_of(ground, sun, stop, row);
        const bool is_dark = dark(at.x, at.y);
        hidden += is_dark;
        f.disc(plot.at(first + row, s.now[static_cast<std::size_t>(row)]), 3,
               is_dark ? ink::red : ink::orange);
    }
    f.legend({70, 870}, {{Mark::line, ink::blue, "the horizon so far"},
                         {Mark::line, ink::green, "the strip that this line adds"},
                         {Mark::dot, ink::orange, "lit"},
                         {Mark::dot, ink::red, "dark"}});
    f.paragraph(
        {40, 905},
        fmt::format(
            "{} of {} samples lie below. The higher of blue and green is the horizon of the next line.",
            hidden, side));

    const Box map{1020, 570, 330, 330};
    f.text({1000, 540}, "4  The map, bit for bit", lettering::head);
    draw_picture(f, {map.x, map.y},
                 ground_picture(ground,
                                [&](int x, int y, Rgb8 bare) {
                                    return dark(x, y) ? mix(bare, {28, 34, 60}, 0.72) : bare;
                                }),
                 3);
    draw_sun_arrow(f, map, azimuth);
    for (int row = 0; row + 1 < side; ++row) {
        const GridPlace at = place_of(ground, sun, stop, row), next = place_of(ground, sun, stop, row + 1);
        f.line(Vec2d{map.x + 3 * (at.x + 0.5), map.y + 3 * (at.y + 0.5)},
               Vec2d{map.x + 3 * (next.x + 0.5), map.y + 3 * (next.y + 0.5)}, {ink::green, 1.5});
    }
    const double looks = looks_of_rays(ground, sun, dark);
    const double samples = side * side;
    f.paragraph({1375, 590},
                fmt::format("{:.1f} pieces of horizon\nto each sample, met\nonce; a ray looks at\n{:.1f} "
                            "cells, or blocks\nof cells below it,\nand more where\nground is larger.\n\nThe "
                            "sweep's bits are\nthe rays' bits, all\n{} of them.",
                            static_cast<double>(s.pieces) / samples, looks, side * side));
}

}  // namespace

Image<Rgb8> lesson_26_floating_horizon(const Exec&) {
    Figure f(lesson_width, lesson_height);
    f.heading(26, "The horizon that never moves",
              "Seen along the sun's rays the ground stands still: one profile, which only grows, shades a "
              "whole map.");
    const HeightField ground = lesson_ground(side);
    draw_row(f, ground);
    draw_sweep(f, ground);
    f.source_line(26,
                  "raster/heights/profile.h strip_profile, upper_envelope · height_sweep.h sweep_shadows · "
                  "height_rays.h");
    return f.picture;
}

}  // namespace obscura
