// Lesson 16. The V-cycle.
//
// You learn: what a sweep cannot mend is smooth, so it can be seen on a coarser grid, where it is not smooth
// any more; down the levels go right sides, up come corrections. A cycle by itself stalls where many pixels
// hang on one; as the preconditioner of conjugate gradients it does not. (A. Brandt 1977; O. Tatebe 1993.)
//
// Calls: stereo/solver/grid_hierarchy.h grid_hierarchy, stereo/solver/v_cycle.h descend, ascend,
//        solve_coarsest, stereo/solver/conjugate_gradients.h start_residual, stereo/solver/solver.h solve.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stereo_edits.h"
#include "lessons/stereo_panels.h"
#include "stereo/solver/conjugate_gradients.h"

namespace obscura {
namespace {

constexpr int width = 144, height = 96, most_iterations = 8;
constexpr DisparityColours error_colours{-10, 10};

DisparityMap map_of(const GridPlane& plane) {
    DisparityMap map(plane.width(), plane.height());
    for (int y = 0; y < map.height; ++y)
        std::copy_n(plane.row(y), map.width, map.row(y));
    return map;
}

/// Step 1: one cycle from zero. Right sides and corrections of all levels stay in the hierarchy.
struct Cycle {
    GridVector rhs;
    DisparityMap swept, corrected;  ///< D~ after one sweep, and after the whole cycle
    std::vector<DisparityMap> right_sides, corrections;
};

Cycle cycle_of(const DisparitySystem& system, GridHierarchy& h, const Exec& exec) {
    Cycle c{grid_vector(h), system.start, system.start, {}, {}};
    start_residual(system, h, system.start, exec, c.rhs);
    std::vector<double> hubs = c.rhs.hubs;
    const std::size_t last = h.levels.size() - 1;
    for (std::size_t l = 0; l < last; ++l)
        descend(h.levels[l], l == 0 ? c.rhs.cells : h.levels[l].rhs, h.levels[l + 1], hubs, exec);
    solve_coarsest(h, hubs);
    for (std::size_t l = last - 1; l > 0; --l)
        ascend(h.levels[l], h.levels[l].rhs, h.levels[l + 1], hubs, h.levels[l].solution, exec);
    GridPlane finest(width, height);
    ascend(h.levels[0], c.rhs.cells, h.levels[1], hubs, finest, exec);
    for (std::size_t l = 0; l <= last; ++l) {
        c.right_sides.push_back(map_of(l == 0 ? c.rhs.cells : h.levels[l].rhs));
        c.corrections.push_back(map_of(l == 0 ? finest : h.levels[l].solution));
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            c.swept(x, y) += h.levels[0].relax.row(y)[x] * c.rhs.cells.row(y)[x];
            c.corrected(x, y) += finest.row(y)[x];
        }
    }
    for (std::size_t k = 0; k < hubs.size(); ++k)
        c.corrected(h.hubs[k].x, h.hubs[k].y) += static_cast<float>(hubs[k]);
    return c;
}

void draw_levels(Figure& f, const Cycle& c) {
    for (std::size_t l = 0; l < 5; ++l) {
        const double x = 40 + 308.0 * static_cast<double>(l);
        const int zoom = 2 << l;
        const DisparityMap &down = c.right_sides[l], &up = c.corrections[l];
        const double most = std::max(size_of(down).max_px * 0.4, 1e-6);
        f.text({x, 138}, fmt::format("{} × {}", down.width, down.height), lettering::bold);
        f.text({x + 288, 138}, fmt::format("dark: ±{:.0f}", most),
               {9, ink::soft, Align::right, false, false});
        draw_map(f, {x, 150}, down, {-most, most}, zoom);
        draw_map(f, {x, 396}, up, error_colours, zoom);
        if (l == 4) break;
        f.arrow({x + 291, 236}, {x + 306, 236}, {ink::dark, 1.5}, 8);
        f.arrow({x + 306, 500}, {x + 291, 500}, {ink::dark, 1.5}, 8);
    }
}

// Step 2: errors against the minimiser.
void draw_errors(Figure& f, const DisparitySystem& system, const Cycle& c, const DisparityMap& truth) {
    const std::pair<const char*, const DisparityMap*> maps[] = {
        {"error of D~", &system.start}, {"after one sweep", &c.swept}, {"after one V-cycle", &c.corrected}};
    double x = 40;
    for (const auto& [name, map] : maps) {
        const DisparityMap error = difference(*map, truth);
        f.text({x, 662}, name, lettering::bold);
        f.text({x + 288, 662}, fmt::format("rms {:.2f} px", size_of(error).rms_px), lettering::right);
        draw_map(f, {x, 674}, error, error_colours, 2);
        x += 308;
    }
}

// Step 3: error against iterations, of a system with a matching set and of one without.
void draw_curves(Figure& f, const DisparitySystem& system, const DisparityMap& truth, const Plot& plot,
                 bool dashed, const Exec& exec) {
    const std::pair<SolverMethod, Rgb8> methods[] = {{SolverMethod::vcycle, ink::red},
                                                     {SolverMethod::fmg, ink::orange},
                                                     {SolverMethod::multigrid, ink::blue}};
    for (const auto& [method, color] : methods) {
        SolverCache cache;
        std::vector<Vec2d> line{plot.at(0, decades_of(size_of(difference(system.start, truth)).rms_px))};
        for (int k = 1; k <= most_iterations; ++k) {
            SolverParams params;
            params.method = method;
            params.max_iterations = k;
            params.tolerance_max_px = params.tolerance_rms_px = 1e-9;
            params.verify = false;
            const Solution s = solve(system, params, exec, {}, &cache);
            line.push_back(plot.at(
                k, std::clamp(decades_of(size_of(difference(s.disparity, truth)).rms_px), plot.y0, plot.y1)));
        }
        f.polyline(line, {color, 2, dashed ? 5.0 : 0.0});
    }
}

}  // namespace

Image<Rgb8> lesson_16_v_cycle(const Exec& any) {
    const Exec exec{any.isa, 1};  // so small a map is too little work to share
    Figure f(lesson_width, lesson_height);
    f.heading(16, "The V-cycle",
              "Down the levels goes what is still wrong, up come corrections: news crosses the picture in "
              "one cycle.");
    const StereoScene scene = stereo_scene();
    const MiddleView view = stereo_view(scene, width, height, exec);
    std::vector<StereoEdit> edits = lesson_edits(view, 16);
    const DisparitySystem system = lesson_system(scene, view, edits, {}, exec).system;
    edits.push_back(lesson_match(view));
    const DisparitySystem matched = lesson_system(scene, view, edits, {}, exec).system;
    const DisparityMap truth = minimiser(system, exec);
    GridHierarchy hierarchy = grid_hierarchy(system, exec);
    const Cycle cycle = cycle_of(system, hierarchy, exec);
    draw_levels(f, cycle);
    f.text({40, 366},
           "Down: the right side. Smooth by one sweep, take what it leaves, add it up in cells of twice the "
           "size: restriction.");
    f.text({40, 612}, fmt::format("Up: the correction, pixels. {} × {} cells are solved exactly; then "
                                  "interpolate what comes from there, and smooth by one sweep.",
                                  cycle.corrections.back().width, cycle.corrections.back().height));
    draw_errors(f, system, cycle, truth);
    draw_colours(f, {40, 884}, 288, error_colours, "px");
    const Plot plot{{1060, 690, 330, 190}, 0, most_iterations, -4, 1.2};
    decade_axes(f, plot, false, "iterations", "rms error, pixels (log scale)");
    axis_numbers(f, plot, {0, 2, 4, 6, 8}, 0);
    draw_curves(f, system, truth, plot, false, exec);
    draw_curves(f, matched, minimiser(matched, exec), plot, true, exec);
    constexpr std::pair<const char*, Rgb8> names[] = {
        {"V-cycles", ink::red}, {"full multigrid", ink::orange}, {"conjugate\ngradients", ink::blue}};
    double y = 712;
    for (const auto& [name, color] : names)
        y = f.paragraph({1410, y}, name, {9.5, color, Align::left, true, false}) + 8;
    f.paragraph({1410, y + 16}, "dashed: the block is\nmatched to one point\nof the ball, a hub");
    f.source_line(
        16, "stereo/solver/grid_hierarchy.h · v_cycle.h descend solve_coarsest ascend · solver.h solve");
    return f.picture;
}

}  // namespace obscura
