// Lesson 15. Jacobi, sweep by sweep.
//
// You learn: a sweep sets every pixel to what its neighbours ask of it; news travels one pixel per sweep, so
// what is smooth and wide stays wrong for as many sweeps as the picture has pixels. A pyramid of half
// resolutions travels faster, but each of its levels is a problem of its own, and its formula for going up a
// level, as printed, has the wrong sign. (Scandolo, Bauszat, Eisemann 2018; F. L. Scandolo, thesis, 2019,
// section 4.3.3.)
//
// Calls: stereo/thesis/cascade.h jacobi_sweeps, halved, upsampled, stereo/solver/solver.h solve.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stereo_edits.h"
#include "lessons/stereo_panels.h"
#include "stereo/thesis/cascade.h"

namespace obscura {
namespace {

constexpr int width = 144, height = 96, row = 57;
constexpr DisparityColours error_colours{-6, 6};
constexpr Rgb8 jacobi_color = ink::blue, corrected_color = ink::green, printed_color = ink::red;

// Step 1: more and more sweeps from D~; what is still wrong.
void draw_sweeps(Figure& f, const DisparitySystem& system, const DisparityMap& truth, const Plot& plot,
                 const Exec& exec) {
    f.axes(plot, "", "error in the dashed row, pixels");
    level_lines(f, plot, {-2, 0, 2, 4, 6, 8});
    axis_numbers(f, plot, {0, 48, 96, 144}, 0);
    constexpr int counts[] = {0, 1, 10, 100, 1000};
    constexpr Rgb8 colors[] = {ink::grey, ink::orange, ink::red, ink::purple, ink::blue};
    std::vector<LegendEntry> legend;
    for (int i = 0; i < 5; ++i) {
        const DisparityMap error = difference(jacobi_sweeps(system, system.start, counts[i], exec), truth);
        const Vec2d at{40 + 308.0 * i, 150};
        f.text(at - Vec2d{0, 12},
               counts[i] == 0 ? "D~" : fmt::format("{} sweep{}", counts[i], counts[i] == 1 ? "" : "s"),
               lettering::bold);
        f.text(at + Vec2d{288, -12}, fmt::format("rms {:.2f} px", size_of(error).rms_px), lettering::right);
        draw_map(f, at, error, error_colours, 2);
        f.line(at + Vec2d{0, 2.0 * row + 1}, at + Vec2d{2.0 * width, 2.0 * row + 1}, {ink::dark, 1, 4});
        row_curve(f, plot, row_of(error, row), {colors[i], 1.8});
        legend.push_back({Mark::line, colors[i], fmt::format("{}", counts[i])});
    }
    f.legend({plot.box.x, plot.box.y + plot.box.h + 60}, legend);
}

/// The cascade's levels, finest first: the systems, and the maps after ten sweeps each.
struct Cascade {
    std::vector<DisparitySystem> levels;
    std::vector<DisparityMap> maps;
};

Cascade cascade_of(const DisparitySystem& system, bool printed_sign, const Exec& exec) {
    Cascade c{{system}, {}};
    while (c.levels.back().width() > 8)
        c.levels.push_back(halved(c.levels.back()));
    c.maps.resize(c.levels.size());
    DisparityMap x = c.levels.back().start;
    for (std::size_t l = c.levels.size(); l-- > 0;) {
        if (l + 1 < c.levels.size()) x = upsampled(c.levels[l], c.levels[l + 1], x, printed_sign);
        x = c.maps[l] = jacobi_sweeps(c.levels[l], std::move(x), 10, exec);
    }
    return c;
}

// Step 2: the cascade, level by level, with both signs.
void draw_cascade(Figure& f, const Cascade& c, const DisparityMap& truth, Vec2d at, std::string_view name,
                  Rgb8 color) {
    f.text(at - Vec2d{0, 12}, name, {9.5, color, Align::left, true, false});
    double x = at.x;
    for (std::size_t l = 4; l-- > 0;) {
        const DisparityMap& map = c.maps[l];
        const int zoom = 1 << l;
        draw_map(f, {x, at.y}, map, {-16, 16}, zoom);
        f.text({x, at.y + 114}, fmt::format("{} × {}", map.width, map.height),
               {9, ink::soft, Align::left, false, false});
        x += 156;
    }
    const DisparityMap error = difference(c.maps[0], truth);
    draw_map(f, {x, at.y}, error, error_colours);
    f.text({x, at.y + 114},
           fmt::format("error: rms {:.2f}, most {:.1f}", size_of(error).rms_px, size_of(error).max_px),
           {9, color, Align::left, true, false});
}

// Step 3: how slowly errors go.
void draw_decay(Figure& f, const DisparitySystem& system, const DisparityMap& truth, const Cascade& corrected,
                const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, true, "sweeps (log scale)", "rms error, pixels (log scale)");
    DisparityMap x = system.start;
    std::vector<Vec2d> line;
    int done = 0;
    for (const int count : {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048}) {
        x = jacobi_sweeps(system, std::move(x), count - done, exec);
        done = count;
        line.push_back(
            plot.at(decades_of(count), std::max(plot.y0, decades_of(size_of(difference(x, truth)).rms_px))));
    }
    f.polyline(line, {jacobi_color, 2});
    // Ten sweeps of every level, in sweeps of the finest: each level has a quarter of the pixels of the one
    // below it.
    double work = 0;
    for (const DisparityMap& map : corrected.maps)
        work += 10.0 * map.width * map.height / (width * height);
    const Vec2d at =
        plot.at(decades_of(work), decades_of(size_of(difference(corrected.maps[0], truth)).rms_px));
    f.disc(at, 5, corrected_color);
    f.text(at + Vec2d{10, 16}, "cascade", {9, corrected_color, Align::left, true, true});
}

}  // namespace

Image<Rgb8> lesson_15_jacobi(const Exec& any) {
    const Exec exec{any.isa, 1};  // a sweep of so small a map is too little work to share
    Figure f(lesson_width, lesson_height);
    f.heading(15, "Jacobi, sweep by sweep",
              "Every pixel asks its neighbours, again and again: news travels one pixel per sweep.");
    const StereoScene scene = stereo_scene();
    const MiddleView view = stereo_view(scene, width, height, exec);
    EditParams params;
    params.epsilon = 2e-3;  // at 1e-4 a thousand sweeps do next to nothing
    const DisparitySystem system = lesson_system(scene, view, lesson_edits(view, 16), params, exec).system;
    const DisparityMap truth = minimiser(system, exec);
    f.text({1560, 376}, "error: what a map has more than the minimiser; epsilon 0.002",
           {9, ink::soft, Align::right, false, false});
    draw_colours(f, {40, 362}, 288, error_colours, "px");
    draw_sweeps(f, system, truth, {{84, 480, 600, 150}, 0, 144, -2, 8}, exec);
    const Cascade corrected = cascade_of(system, false, exec), printed = cascade_of(system, true, exec);
    f.text({790, 448}, "The cascade: ten sweeps per level, from coarse to fine", lettering::head);
    draw_cascade(f, corrected, truth, {790, 496}, "x = x coarse + (D~ − D~ coarse)", corrected_color);
    draw_cascade(f, printed, truth, {790, 656}, "x = x coarse − (D~ − D~ coarse), as printed", printed_color);
    draw_colours(f, {790, 784}, 288, {-16, 16}, "px");
    draw_decay(f, system, truth, corrected, {{84, 770, 600, 110}, 0, 3.4, -1, 1}, exec);
    f.paragraph({790, 846},
                "A level starts at the coarser solution and the detail of D~ that the coarser level left "
                "out. With the\n"
                "printed sign the detail is taken away instead, and the sweeps have to bring it back. Even "
                "corrected,\n"
                "levels are not the same problem: sampled, with weights as they are. Lesson 16 mends that.");
    f.source_line(15,
                  "stereo/thesis/cascade.h jacobi_sweeps halved upsampled · stereo/solver/solver.h solve");
    return f.picture;
}

}  // namespace obscura
