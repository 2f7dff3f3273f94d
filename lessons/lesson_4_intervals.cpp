// Lesson 4. Intervals: which depths may a shadow map store?
//
// You learn: a counter goes up at entries and down at exits; the interval of a texel begins where the counter
// leaves zero and ends where it is back. Any depth inside gives the same shadows outside solids, so the map
// stores the middle and needs no bias, and a hierarchy may choose what compresses best. L. Scandolo,
// P. Bauszat, E. Eisemann, "Compressed Multiresolution Hierarchies for High-Quality Precomputed Shadows",
// Eurographics 2016, section 3.
//
// Calls: raster/layers.h layers_of, raster/intervals.h interval_of, raster/interval_map.h interval_map,
//        core/types.h stored_depth.

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/cut.h"
#include "lessons/drawing/figure.h"
#include "lessons/ladder.h"
#include "raster/interval_map.h"
#include "raster/layers.h"

namespace obscura {
namespace {

constexpr Box ray_view{180, 160, 1380, 260};

// Bar from entry to exit; an interval of no width still shows.
void draw_interval(Figure& f, Vec2d entry, Vec2d exit, double width, Rgb8 color) {
    const double height = std::max(exit.y - entry.y, 6.0);
    f.fill({entry.x - 0.5 * width, entry.y - 0.5 * (height - (exit.y - entry.y)), width, height}, color);
}

// Step 1: one ray. The counter steps to the right at entries, back at exits; sheets leave it alone.
void draw_counter(Figure& f, const CutScene& scene, const CutRay& ray,
                  std::span<const LayerCrossing> crossings) {
    constexpr double step_px = 24;
    const double X = ray.x + 0.5;
    const auto at = [&](float depth, int counter) {
        return in_cut(scene, ray_view, X, static_cast<double>(depth)) + Vec2d{step_px * counter, 0};
    };
    f.text(at(0, 0) - Vec2d{0, 18}, ray.name, {9.5, ink::dark, Align::centre, true});
    f.line(at(0, 0) - Vec2d{0, 12}, at(1, 0) + Vec2d{0, 12}, {ink::orange, 1.5});
    std::vector<Vec2d> staircase{at(0, 0)};
    int counter = 0;
    for (const LayerCrossing& c : crossings) {
        staircase.push_back(at(c.depth, counter));
        counter += c.crossing == Crossing::entry ? 1 : c.crossing == Crossing::exit ? -1 : 0;
        staircase.push_back(at(c.depth, counter));
    }
    staircase.push_back(at(1, counter));
    f.polyline(staircase, {ink::dark, 2.5});

    const DepthInterval interval = interval_of(crossings, Receivers::any);
    const Vec2d left{-14, 0};
    const double width = interval.entry == interval.exit ? 24 : 12;
    draw_interval(f, at(interval.entry, 0) + left, at(interval.exit, 0) + left, width, ink::blue);
    f.disc(at(stored_depth(interval), 0) + left, 5, ink::yellow);
    f.text(at(1, 0) + Vec2d{0, 30}, fmt::format("[{:.3f}, {:.3f}]", interval.entry, interval.exit),
           {8.5, ink::blue, Align::centre, true});
}

// Step 2: the interval of every texel of the row.
void draw_row(Figure& f, const CutScene& scene, const Box& box, Receivers receivers, const Exec& exec) {
    const Image<DepthInterval> map = interval_map(scene.mesh, scene.view, {receivers, false}, exec);
    draw_cut(f, scene, box, 0.55, exec);
    for (int x = 0; x < map.width; ++x) {
        const DepthInterval& interval = map(x, scene.row);
        const auto at = [&](float depth) { return in_cut(scene, box, x + 0.5, static_cast<double>(depth)); };
        const bool background = interval.entry == 1.0f;
        if (!background) draw_interval(f, at(interval.entry), at(interval.exit), 4, ink::blue);
        f.fill({at(0).x - 3, at(stored_depth(interval)).y - 1.5, 6, 3}, ink::yellow);
    }
}

// The whole map at once must say what interval_of() says ray by ray.
void check_agreement(const CutScene& scene, const Layers& layers, const Exec& exec) {
    const Image<DepthInterval> map = interval_map(scene.mesh, scene.view, {Receivers::any, false}, exec);
    for (int x = 0; x < map.width; ++x)
        CHECK(map(x, scene.row) == interval_of(layers.at(x, scene.row), Receivers::any));
}

}  // namespace

Image<Rgb8> lesson_4_intervals(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(4, "Intervals", "From the counter along a ray to the depths that a shadow map may store.");
    const CutScene scene = cut_scene();
    const Layers layers = layers_of(scene.mesh, scene.view, {0, scene.row, scene.view.width, 1}, exec);
    check_agreement(scene, layers, exec);

    draw_cut(f, scene, ray_view, 1, exec);
    for (const CutRay& ray : cut_rays(scene))
        draw_counter(f, scene, ray, layers.at(ray.x, scene.row));
    f.text({40, 174}, "The counter", lettering::head);
    f.paragraph(
        {40, 200},
        "entry: one step\nto the right\nexit: one back\n \nblue: first time\nabove zero,\nuntil zero again");

    const Box any{180, 496, 1380, 186}, fixed{180, 718, 1380, 186};
    draw_row(f, scene, any, Receivers::any, exec);
    f.text({40, 510}, "any receiver", lettering::head);
    f.paragraph({40, 536},
                "a sheet's depth\nis exact: [z, z].\nSomething may\ncome to stand\nright behind it");
    draw_row(f, scene, fixed, Receivers::static_only, exec);
    f.text({40, 732}, "static", lettering::head);
    f.paragraph({40, 758}, "only these\nsurfaces ask:\nfrom the first\nto the next, all\ndepths will do");
    f.legend({180, 936},
             {{Mark::line, ink::dark, "counter"},
              {Mark::square, ink::blue, "interval [entry, exit]"},
              {Mark::square, ink::yellow, "stored depth: its middle or near its entry, 1 where nothing is"},
              {Mark::line, ink::green, "open sheet"},
              {Mark::line, ink::orange, "ray"}});
    f.source_line(4,
                  "raster/layers.h layers_of · raster/intervals.h interval_of · raster/interval_map.h "
                  "interval_map · core/types.h stored_depth");
    return f.picture;
}

}  // namespace obscura
