// Lesson 12. Wavelengths adding to colour.
//
// You learn: a pattern grows with its wavelength, so each adds its own size of the same pattern in its own
// colour; a few wavelengths are a few patterns side by side, many are a spectrum along every streak; and a
// pattern computed once may stand for all, if it is looked up finely enough: |F|^2 has twice the bandwidth of
// F. L. Scandolo, thesis, 2019, section 3.4.3, equations 3.15 to 3.17.
//
// Calls: optics/psf.h far_field_colour, optics/spectrum.h spectral_samples, optics/thesis/spectral_lookup.h
//        add_scaled_power, optics/pattern_view.h view_colour.

#include <algorithm>

#include <fmt/format.h>

#include "lessons/colour_sums.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/plane_fields.h"

namespace obscura {
namespace {

constexpr int mask_texels = 128, pixels = 296;
constexpr double reach = 20.0 / mask_texels;  ///< of the panels: 20 fringes of the aperture's width
constexpr Rgb8 near_color = ink::blue, middle_color = ink::green, far_color = ink::orange;

FrequencyGrid grid_of(int size) {
    return centred_grid(size, size, 2 * reach / size);
}

// Step 1: more and more wavelengths of daylight; below, which.
void draw_sum(Figure& f, const Aperture& aperture, int wavelengths, Vec2d at, const Exec& exec) {
    const Image<Vec3f> colour = colour_of(aperture, grid_of(pixels), wavelengths, exec);
    f.image(static_cast<int>(at.x), static_cast<int>(at.y), log_picture(colour, 5.5, exec), 1);
    const std::vector<SpectralSample> samples = spectral_samples({}, wavelengths);
    f.text(at - Vec2d{0, 10}, fmt::format("{} wavelength{}", samples.size(), samples.size() == 1 ? "" : "s"),
           lettering::bold);
    f.fill({at.x, at.y + pixels + 8, pixels, 18}, ink::dark);
    for (const SpectralSample& s : samples) {
        const double x = (s.wavelength_nm - 380) / 400 * pixels;
        f.fill({at.x + x - 1.5, at.y + pixels + 8, 3, 18}, hue_of(s));
    }
}

// Step 2: how many it takes, near the middle and farther out.
void draw_counts(Figure& f, const Aperture& aperture, const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, true, "wavelengths (log scale)", "mean error of X, Y, Z (log scale)");
    const FrequencyGrid grid = grid_of(64);
    const Image<Vec3f> all = colour_of(aperture, grid, 600, exec);
    constexpr int counts[] = {1, 3, 7, 15, 30, 60, 120, 240};
    std::vector<Image<Vec3f>> sums;
    for (const int count : counts)
        sums.push_back(colour_of(aperture, grid, count, exec));
    constexpr Rgb8 colors[] = {near_color, middle_color, far_color};
    for (int zone = 0; zone < 3; ++zone) {
        std::vector<Vec2d> line;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const double error = colour_error(sums[i], all, grid, reach * zone / 3, reach * (zone + 1) / 3);
            line.push_back(plot.at(decades_of(counts[i]), std::max(decades_of(error), plot.y0)));
            f.disc(line.back(), 3.5, colors[zone]);
        }
        f.polyline(line, {colors[zone], 1.6});
    }
}

// Step 3: what straight lines between samples make of |F|^2, along the vertical axis.
void draw_lookup(Figure& f, const Aperture& aperture, const Plot& plot, const Exec& exec) {
    f.axes(plot, "", "|F|² / F(0)², millionths");
    level_lines(f, plot, {0, 100, 200, 300, 400});
    const double area = open_area(aperture.mask.view());
    const std::pair<int, Pen> curves[] = {{64, {ink::dark, 2.5}}, {1, {ink::red, 1.6}}, {2, {ink::sky, 1.6}}};
    for (const auto& [per_fringe, pen] : curves) {
        const int samples = static_cast<int>(plot.x1 - plot.x0) * per_fringe + 1;
        const double step = 1.0 / (mask_texels * per_fringe);
        const FrequencyGrid column{1, samples, 0, plot.x0 / mask_texels, 1, step};
        const Image<float> power = far_field_power(aperture, column, {}, exec);
        std::vector<Vec2d> line;
        for (int i = 0; i < samples; ++i) {
            const double share = static_cast<double>(power(0, i)) / (area * area);
            line.push_back(plot.at(plot.x0 + i * 1.0 / per_fringe, 1e6 * share));
            if (per_fringe < 64) f.disc(line.back(), 3.5, pen.color);
        }
        f.polyline(line, pen);
    }
    axis_numbers(f, plot, {5, 7, 9, 11, 13}, 0);
    f.text(plot.at(plot.x1, 0) + Vec2d{10, 38}, "frequency times W", {9, ink::soft, Align::right});
}

// Step 4: the error of lookups against patterns computed for each of the same 60 wavelengths.
void draw_lookup_errors(Figure& f, const Aperture& aperture, const Box& box, const Exec& exec) {
    const FrequencyGrid grid = grid_of(64);
    const Image<Vec3f> exact = colour_of(aperture, grid, 60, exec);
    double y = box.y;
    for (const PowerInterpolation interpolation : {PowerInterpolation::linear, PowerInterpolation::cubic}) {
        for (const int finer : {1, 2, 4}) {
            const Image<Vec3f> sum =
                looked_up_colour(aperture, grid, 60, 1.0 / (finer * mask_texels), interpolation, exec);
            const double error = 100 * colour_error(sum, exact, grid, 0, reach);
            f.text({box.x + 112, y + 13},
                   fmt::format("{}, {}", interpolation == PowerInterpolation::linear ? "linear" : "cubic",
                               finer == 1 ? "1/W" : fmt::format("1/{}W", finer)),
                   lettering::right);
            f.fill({box.x + 124, y, error * 5, 16}, finer == 1 ? ink::red : ink::sky);
            f.text({box.x + 132 + error * 5, y + 13}, fmt::format("{:.2f} %", error), {9});
            y += 26;
        }
    }
}

}  // namespace

Image<Rgb8> lesson_12_colour(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(
        12, "Wavelengths adding to colour",
        "A pattern grows with its wavelength: every wavelength adds its own size of it, in its own colour.");
    const Aperture aperture = full_aperture(ApertureKind::iris, mask_texels);
    constexpr int counts[] = {1, 3, 7, 15, 60};
    for (int i = 0; i < 5; ++i)
        draw_sum(f, aperture, counts[i], {40 + 306.0 * i, 146}, exec);
    f.text(
        {40, 506},
        "Luminance on a log scale, 5.5 decades from the middle down · daylight D65 · bars: the wavelengths, "
        "380 to 780 nm");
    f.text({40, 566}, "How many wavelengths?", lettering::head);
    draw_counts(f, aperture, {{90, 610, 380, 230}, 0, 2.5, -6, 0.2}, exec);
    f.legend({90, 910}, {{Mark::line, near_color, "inner third"},
                         {Mark::line, middle_color, "middle"},
                         {Mark::line, far_color, "outer"}});
    f.text({560, 566}, "Samples of |F|² and lines between", lettering::head);
    draw_lookup(f, aperture, {{600, 610, 420, 230}, 5, 13, 0, 450}, exec);
    f.text({1090, 566}, "Mean error of lookups, 60 wavelengths", lettering::head);
    draw_lookup_errors(f, aperture, {1090, 590, 470, 160}, exec);
    f.legend({600, 910}, {{Mark::line, ink::dark, "|F|²"},
                          {Mark::line, ink::red, "samples 1/W apart"},
                          {Mark::line, ink::sky, "1/2W"}});
    f.paragraph({1090, 790},
                "W is the aperture's width: samples 1/W apart hold F, but not\n|F|², whose bandwidth is "
                "twice as large; its fringes fall between\nthem. Against that error, 60 wavelengths or 600 "
                "make no\ndifference: half the step first, cubics second, and only then more\nwavelengths. "
                "Or no lookups: every wavelength on its own grid.");
    f.source_line(12,
                  "optics/psf.h far_field_colour · optics/spectrum.h spectral_samples · "
                  "optics/thesis/spectral_lookup.h add_scaled_power");
    return f.picture;
}

}  // namespace obscura
