// Lesson 11. From near to far: one aperture, farther and farther away.
//
// You learn: only the Fresnel number a^2 / (lambda z) matters; near the aperture there is its shadow with
// fringes along the edge, far away the square of its Fourier transform, and no border between; on the axis
// light comes and goes with every zone that the opening lets through, and behind a disc it is as bright as
// without (Poisson's spot). L. Scandolo, thesis, 2019, section 3.4.5; A. Fresnel, 1819, on the disc.
//
// Calls: optics/near_field.h near_field, near_field_intensity, optics/far_field.h far_field_power.

#include <algorithm>

#include <fmt/format.h>

#include "core/num.h"
#include "lessons/aperture_panels.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/pattern_panels.h"
#include "lessons/plane_fields.h"

namespace obscura {
namespace {

constexpr int mask_texels = 256, pixels = 260;

// Step 1: an intensity and the aperture's outline at the same scale; `widths`: of the mask, across the panel.
void draw_panel(Figure& f, Vec2d at, const Image<float>& power, const Aperture& aperture, double widths,
                std::string_view name) {
    const float peak = *std::max_element(power.pixels.begin(), power.pixels.end());
    draw_power(f, at, power.view(), {static_cast<double>(peak), 4});
    const double texel = pixels / (widths * mask_texels);
    const double corner = 0.5 * (pixels - texel * mask_texels);
    draw_outline(f, at + Vec2d{corner, corner}, texel, aperture.outline, {ink::paper, 1.2});
    f.text(at - Vec2d{0, 10}, name, lettering::bold);
    f.text(at + Vec2d{pixels, -10}, fmt::format("{:g} apertures wide", widths),
           {8.5, ink::soft, Align::right});
}

// Step 2: the same aperture at falling Fresnel numbers, then the far field alone.
constexpr std::pair<double, double> stages[] = {{50, 1.25}, {10, 1.25}, {3, 1.5},
                                                {1, 2},     {0.3, 8},   {0.05, 48}};

void draw_stages(Figure& f, const Aperture& aperture, const Exec& exec) {
    for (int i = 0; i < 7; ++i) {
        const auto [fresnel, widths] = stages[std::min(i, 5)];
        const PlaneGrid plane = centred_plane(pixels, widths * mask_texels);
        const Vec2d at{40 + 276.0 * (i % 4), 156 + 304.0 * (i / 4)};
        const Image<float> power =
            i < 6 ? near_field_intensity(aperture, plane, at_fresnel_number(aperture, fresnel), exec)
                  : far_intensity(aperture, plane, fresnel, exec);
        draw_panel(f, at, power, aperture, widths,
                   i < 6 ? fmt::format("N = {:g}", fresnel) : std::string("far field"));
    }
}

// Step 3: on the axis of a circular opening, and of a disc; the closed forms are 4 sin^2(pi N / 2) and 1.
void draw_axis(Figure& f, const Aperture& circle, const Plot& plot, const Exec& exec) {
    f.axes(plot, "", "intensity (1: nothing in the way)");
    level_lines(f, plot, {0, 1, 2, 3, 4});
    std::vector<Vec2d> closed;
    for (double n = 0; n <= plot.x1; n += 0.03125) {
        const double s = num::sin(0.5 * num::pi * n);
        closed.push_back(plot.at(n, 4 * s * s));
    }
    f.polyline(closed, {ink::blue, 1.6});
    f.line(plot.at(plot.x0, 1), plot.at(plot.x1, 1), {ink::red, 1.6});
    for (double n = 0.125; n <= plot.x1; n += 0.125) {
        const OnAxis light = on_axis(circle, n, exec);
        f.disc(plot.at(n, light.opening), 2.6, ink::blue);
        f.disc(plot.at(n, light.disc), 2.6, ink::red);
    }
    axis_numbers(f, plot, {0, 2, 4, 6, 8}, 0);
    f.text(plot.at(8, 0) + Vec2d{10, 38}, "Fresnel number N", {9, ink::soft, Align::right});
}

// Step 4: intensity along the horizontal axis, over the geometric shadow.
void draw_slice(Figure& f, const Aperture& aperture, const Plot& plot, const Exec& exec) {
    f.axes(plot, "", "intensity");
    const int samples = static_cast<int>(plot.box.w);
    shade_row(f, plot, aperture.mask.view(), mask_texels / 2);
    level_lines(f, plot, {0, 1, 2});
    const PlaneGrid row{samples, 1, plot.x0 * mask_texels, 0, (plot.x1 - plot.x0) * mask_texels / samples};
    for (const auto& [fresnel, color] : {std::pair{50.0, ink::blue}, {3.0, ink::orange}, {0.3, ink::green}}) {
        const Image<float> power =
            near_field_intensity(aperture, row, at_fresnel_number(aperture, fresnel), exec);
        std::vector<Vec2d> line;
        for (int i = 0; i < samples; ++i)
            line.push_back({plot.box.x + i, plot.at(0, static_cast<double>(power(i, 0))).y});
        f.polyline(line, {color, 1.6});
    }
    axis_numbers(f, plot, {-0.5, 0, 0.5}, 1);
    f.text(plot.at(plot.x1, 0) + Vec2d{10, 38}, "x, aperture widths", {9, ink::soft, Align::right});
}

// Step 5: how far the near field is from what the far field says.
void draw_distance(Figure& f, const Aperture& aperture, const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, true, "Fresnel number N (log scale)", "largest difference / peak (log scale)");
    std::vector<Vec2d> line;
    for (double n = 1; n > 0.009; n *= 0.56234132519034908) {
        const PlaneGrid plane = centred_plane(48, 2.4 / n * mask_texels);
        const Image<float> near = near_field_intensity(aperture, plane, at_fresnel_number(aperture, n), exec);
        line.push_back(
            plot.at(decades_of(n), decades_of(share_of_peak(near, far_intensity(aperture, plane, n, exec)))));
        f.disc(line.back(), 3.5, ink::green);
    }
    f.polyline(line, {ink::green, 1.6});
}

}  // namespace

Image<Rgb8> lesson_11_near_to_far(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(11, "From near to far",
              "The light behind an aperture of radius a at distance z depends on N = a² / (λz): from a "
              "shadow with fringes to the far field.");
    const Aperture heptagon = full_aperture(ApertureKind::iris, mask_texels),
                   circle = full_aperture(ApertureKind::circle, mask_texels);
    draw_stages(f, heptagon, exec);
    const PlaneGrid plane = centred_plane(pixels, 1.5 * mask_texels);
    draw_panel(f, {868, 460}, behind_disc(circle, plane, 10, exec), circle, 1.5, "behind a disc, N = 10");
    f.text({1180, 146}, "On the axis of a circle", lettering::head);
    draw_axis(f, circle, {{1210, 190, 340, 210}, 0, 8, 0, 4.2}, exec);
    f.legend({1190, 466}, {{Mark::dot, ink::blue, "opening"},
                           {Mark::dot, ink::red, "disc"},
                           {Mark::line, ink::grey, "closed forms"}});
    f.text({1180, 516}, "Near field against far field", lettering::head);
    draw_distance(f, heptagon, {{1230, 560, 320, 150}, -2, 0, -5, 0}, exec);
    draw_scale(f, {250, 738}, 200, "1e-4 of each panel's peak",
               "its peak (log scale) · white: the aperture at the same scale");
    draw_slice(f, heptagon, {{84, 796, 480, 106}, -0.75, 0.75, 0, 3}, exec);
    f.legend({84, 940}, {{Mark::line, ink::blue, "N = 50"},
                         {Mark::line, ink::orange, "N = 3"},
                         {Mark::line, ink::green, "N = 0.3"}});
    f.paragraph(
        {640, 796},
        "N counts the zones of half a wave that the middle sees in the opening.\n"
        "Large N: each edge has its own fringes, as if it were alone, and the\nmiddle is as bright as "
        "without an aperture. N near 1: all edges meet\nin the middle. Small N: light spreads by "
        "λz / a, far wider than the\naperture, and its shape no longer changes, only its size.");
    f.paragraph({1180, 796},
                "Circle: odd N is bright, even N dark, and\nbehind a disc there is light at every N:\n"
                "Poisson's spot, which he thought absurd.\nHere it is 1 − U: what the disc takes away "
                "is\nwhat the opening lets through (Babinet).\n \nThe difference above falls with N².");
    f.source_line(11,
                  "optics/near_field.h near_field near_field_intensity · optics/far_field.h far_field_power");
    return f.picture;
}

}  // namespace obscura
