// Lesson 27. Near and far; a day in bits.
//
// You learn: a shadow's caster is near or far, and only what far ones shade needs to be stored: the rest a
// short ray finds. Where a near shadow lies, the far bit is of no account, and takes whichever value is
// cheap. From one sun to the next little changes, so a map is coded by the one before it. How far "far" is
// decides between bits and steps of rays.
//
// Calls: hierarchy/terrain/far_day.h make_far_day, far_maps, raster/heights/height_sweep.h sweep_shadows,
//        height_near.h near_shadows, height_rays.h HeightRays.

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "hierarchy/terrain/far_day.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ground_panels.h"
#include "lessons/ladder.h"
#include "raster/heights/height_rays.h"
#include "raster/heights/height_sweep.h"

namespace obscura {
namespace {

constexpr int side = 192, suns = 48, shown = 8, threshold = 12;

double bits_of(const FarDay& day) {
    return 8.0 * static_cast<double>(day.bytes.size()) / (static_cast<double>(side) * side * suns);
}

// Steps 1 and 2: one sun's shadows in two parts, and what a coder has to say of it after the sun before.
void draw_maps(Figure& f, const HeightField& ground, const std::vector<FarSun>& day, const Exec& exec) {
    const FarSun& sun = day[shown];
    const ShadowParts now = shadow_parts(ground, sun.direction, threshold),
                      before = shadow_parts(ground, day[shown - 1].direction, threshold);
    const Box left{40, 170, 384, 384}, right{470, 170, 384, 384};
    f.text({40, 150},
           fmt::format("1  Near and far of a sun {:.0f} degrees high, D = {} lines", sun.elevation_deg,
                       threshold),
           lettering::head);
    int count[3] = {};
    draw_picture(f, {left.x, left.y},
                 ground_picture(ground,
                                [&](int x, int y, Rgb8 bare) {
                                    if (!now.whole(x, y)) return bare;
                                    const int kind = now.open(x, y) ? 2 : now.far_bits(x, y) ? 0 : 1;
                                    ++count[kind];
                                    constexpr Rgb8 colors[] = {ink::blue, ink::orange, ink::green};
                                    return mix(bare, colors[kind], 0.75);
                                }),
                 2);
    draw_sun_arrow(f, left, sun.azimuth_deg);
    f.text({470, 150}, "2  What the coder has to say after the sun before", lettering::head);
    int changed = 0, mixed = 0;
    draw_picture(f, {right.x, right.y},
                 ground_picture(ground,
                                [&](int x, int y, Rgb8 bare) {
                                    const bool bit = now.far_bits(x, y), was = before.far_bits(x, y);
                                    const bool counts = !now.open(x, y);
                                    changed += counts && bit != was;
                                    if (counts && bit != was) return ink::red;
                                    return now.open(x, y) ? mix(bare, ink::green, 0.45)
                                           : bit          ? mix(bare, ink::blue, 0.6)
                                                          : bare;
                                }),
                 2);
    for (int by = 0; by < side / 8; ++by) {
        for (int bx = 0; bx < side / 8; ++bx) {
            int ones = 0, zeros = 0;
            for (int i = 0; i < 64; ++i) {
                const int x = 8 * bx + i % 8, y = 8 * by + i / 8;
                if (!now.open(x, y)) ++(now.far_bits(x, y) ? ones : zeros);
            }
            if (ones == 0 || zeros == 0) continue;
            ++mixed;
            f.frame({right.x + 16 * bx, right.y + 16.0 * by, 16, 16}, {ink::dark, 0.9});
        }
    }
    f.legend({40, 582}, {{Mark::square, ink::blue, "far: stored"},
                         {Mark::square, ink::orange, "near: by rays"},
                         {Mark::square, ink::green, "open"}});
    f.paragraph({40, 608}, fmt::format("{} far, {} near, {} whose far bit is of no account.", count[0],
                                       count[1], count[2]));
    f.paragraph({470, 582}, fmt::format("{} of {} blocks of 8 x 8 are mixed (framed), {} samples of {}\nhave "
                                        "another bit than before (red); all others have kept theirs.",
                                        mixed, side * side / 64, changed, side * side));
    // What was stored, with rays, is the whole shadow.
    const FarDay coded = make_far_day(ground, day, {threshold, 64, 16}, exec);
    const std::vector<ShadowBits> maps = far_maps(coded, 0, exec);
    CHECK(with_near_shadows(ground, sun, maps[shown], threshold) == now.whole, "lossless");
}

// Step 3: bits against steps, over D.
void draw_trade(Figure& f, const HeightField& ground, const std::vector<FarSun>& day, const Exec& exec) {
    f.text({920, 150}, "3  How far is far: bits stored, and cells that a ray looks at", lettering::head);
    const Plot plot{{990, 180, 540, 330}, 0, 7, -4, 2};
    decade_axes(f, plot, false, "", "");
    const HeightPyramid pyramid = height_pyramid(ground);
    std::vector<Vec2d> bits, cells;
    for (int power = 0; power <= 7; ++power) {
        const int d = 1 << power;
        const double stored = bits_of(make_far_day(ground, day, {d, 64, 16}, exec));
        HeightRayCounts counts;
        for (int i = 0; i < suns; i += 4) {
            const FarSun& sun = day[static_cast<std::size_t>(i)];
            const int far_only[] = {d};
            const ShadowBits map = sweep_shadows(ground, sun.direction, far_only)[0];
            const HeightRays rays(ground, pyramid, sun.direction);
            for (int y = 0; y + 1 < side; y += 3) {
                for (int x = 0; x + 1 < side; x += 3)
                    if (!map(x, y)) rays.ground_hidden({x, y, 0, 0}, d, &counts);
            }
        }
        const double looked = static_cast<double>(counts.cells) / static_cast<double>(counts.rays);
        bits.push_back(plot.at(power, decades_of(stored)));
        cells.push_back(plot.at(power, decades_of(looked)));
        f.text(plot.at(power, plot.y0) + Vec2d{0, 18}, fmt::format("{}", d), lettering::tick);
    }
    f.polyline(bits, {ink::blue, 2});
    f.polyline(cells, {ink::orange, 2});
    for (std::size_t i = 0; i < bits.size(); ++i) {
        f.disc(bits[i], 3.5, ink::blue);
        f.disc(cells[i], 3.5, ink::orange);
    }
    f.text({1530, 548}, "D, lines", {9, ink::soft, Align::right});
    f.legend({990, 572}, {{Mark::line, ink::blue, "bits a sample and map"},
                          {Mark::line, ink::orange, "cells a near ray"}});
    f.paragraph({920, 608},
                "At D = 1 all is stored and no ray goes further than a cell; the larger D, the less\nis "
                "stored, and the further rays may have to go.");
}

// Step 4: bits of each map over the day, alone and by the ones before.
void draw_day(Figure& f, const HeightField& ground, const std::vector<FarSun>& day, const Exec& exec) {
    f.text({40, 680},
           fmt::format("4  Bits a sample of the far maps of {} suns, D = {}, by how many decode together",
                       suns, threshold),
           lettering::head);
    const Plot plot{{110, 706, 700, 190}, 0, suns, 0, 0.12};
    f.axes(plot, "suns, from sunrise to sunset", "bits");
    const std::pair<int, Rgb8> units[] = {{1, ink::dark}, {4, ink::sky}, {16, ink::red}};
    double all[3] = {};
    for (int n = 0; n < 3; ++n) {
        const FarDay coded = make_far_day(ground, day, {threshold, 64, units[n].first}, exec);
        all[n] = bits_of(coded);
        std::vector<Vec2d> line;
        for (int group = 0; group < coded.groups(); ++group) {
            const FarDay::Suns part = coded.suns_of(group);
            std::uint64_t bytes = 0;
            const auto tiles = static_cast<std::size_t>(coded.tiles());
            for (std::size_t tile = 0; tile < tiles; ++tile)
                bytes += coded.units[static_cast<std::size_t>(group) * tiles + tile].bytes;
            const double bits =
                8.0 * static_cast<double>(bytes) / (static_cast<double>(side) * side * part.count);
            for (const int at : {part.first, part.first + part.count})
                line.push_back(plot.at(at, std::min(bits, plot.y1)));
        }
        f.polyline(line, {units[n].second, n == 0 ? 1.4 : 2.2});
    }
    f.legend({110, 935}, {{Mark::line, ink::dark, "1: each by itself"},
                          {Mark::line, ink::sky, "4"},
                          {Mark::line, ink::red, "16"}});
    f.paragraph({880, 712},
                fmt::format("As they are, maps take a bit a sample. Each by itself, this day takes {:.4f}; "
                            "in units of 4, {:.4f};\n"
                            "of 16, {:.4f}: a sample's bit is likely to be the one that it, or its "
                            "neighbours, had before, and\n"
                            "the coder learns how likely. A unit decodes alone, tile by tile, so a picture "
                            "of one hour reads\n"
                            "what it needs. Shadows are long and change most when the sun is low.\n\n"
                            "Nothing is lost: far bits and rays give every sample's shadow exactly.",
                            all[0], all[1], all[2]));
}

}  // namespace

Image<Rgb8> lesson_27_day_in_bits(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(27, "Near and far; a day in bits",
              "Far shadows are stored, near ones are found by short rays, and a map is coded by the one "
              "before it.");
    const HeightField ground = lesson_ground(side);
    const std::vector<FarSun> day = day_of_suns(ground, suns);
    draw_maps(f, ground, day, exec);
    draw_trade(f, ground, day, exec);
    draw_day(f, ground, day, exec);
    f.source_line(27,
                  "hierarchy/terrain/far_day.h make_far_day, far_maps · raster/heights/height_sweep.h · "
                  "height_near.h · height_rays.h");
    return f.picture;
}

}  // namespace obscura
