// Lesson 18. A far field kept up to date: a disc moves over an iris.
//
// You learn: the transform is linear, so the transform of what opened less that of what closed turns the last
// pattern into the next one; what changed is cut into far fewer quads than the whole, and has fewer distinct
// columns; every sum rounds, so the error is bounded step by step and the field computed anew before it is
// too large; and where much changed, starting anew is cheaper. L. Scandolo, "Compression and rendering with
// image-based representations", thesis, 2019, section 3.4.3, "Progressive Refinement".
//
// Calls: optics/far_field_progress.h update_far_field, optics/field/quads.h difference_quads, quads_of,
//        optics/field/separable_terms.h separable_terms.

#include <iterator>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/aperture_panels.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/pattern_panels.h"
#include "lessons/quad_fields.h"
#include "optics/far_field_progress.h"
#include "optics/field/separable_terms.h"

namespace obscura {
namespace {

constexpr int mask_texels = 128, pixels = 256, steps = 5;
constexpr double radius = 14;
const FrequencyGrid pattern_grid = centred_grid(pixels, pixels, 0.5 / pixels);
constexpr Rgb8 open_color{196, 200, 206}, bound_color = ink::orange, error_color = ink::blue;

/// The iris behind a disc that has gone this many texels from the left rim, and half as many down.
Image<float> mask_after(const Image<float>& iris, double gone, double disc = radius) {
    return behind_disc_at(iris, {24 + gone, 46 + 0.5 * gone}, disc);
}

double share_of(const Field& kept, const Image<float>& mask, const FrequencyGrid& grid, const Exec& exec) {
    return largest_difference(kept, field_anew(mask, grid, exec)) / open_area(mask.view());
}

// Step 1: bring the field to the next mask. The difference's quads lead from mask to mask, and the kept field
// is as near to the truth as the report says.
struct Step {
    Image<float> mask;
    QuadList difference;
    ProgressReport report;
    double error = 0;  ///< against a field made anew, share of F(0)
};

Step next_step(FarFieldProgress& progress, const Image<float>& mask, const Exec& exec) {
    Step step{mask, {}, {}, 0};
    const Image<float> before = progress.mask.width > 0 ? progress.mask : mask;
    step.difference = difference_quads(before.view(), mask.view());
    Image<float> sum = mask_of(step.difference);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        sum.pixels[i] += before.pixels[i];
    CHECK(sum.pixels == mask.pixels);
    step.report = update_far_field(progress, mask.view(), exec);
    step.error = share_of(progress.field, mask, progress.grid, exec);
    CHECK(step.report.refreshed ? step.error == 0 : step.error < 1e-6);
    CHECK(step.error <= step.report.error_bound && step.report.error_bound <= progress.tolerance);
    return step;
}

// Step 2: what opened and what closed, over the mask; the pattern below.
void draw_step(Figure& f, const Step& step, const Field& kept, int number, Vec2d at) {
    const double area = open_area(step.mask.view());
    f.text(at - Vec2d{0, 10}, number == 0 ? "start" : fmt::format("step {}", number), lettering::bold);
    f.text(at + Vec2d{pixels, -10}, step.report.refreshed ? "computed anew" : "difference added",
           lettering::right);
    draw_mask(f, at, pixels / mask_texels, step.mask.view(), open_color);
    draw_quads(f, at, pixels / mask_texels, step.difference);
    f.frame({at.x, at.y, pixels, pixels}, {ink::soft, 1});
    draw_power(f, at + Vec2d{0, pixels + 12}, power_of(kept).view(), {area * area, 6});
}

// Step 3: what it took.
constexpr double column_ends[] = {44, 150, 260, 340, 410, 510, 610};

void draw_head(Figure& f, Vec2d at) {
    constexpr std::pair<const char*, const char*> names[] = {{"", "step"},
                                                             {"quads:", "changed / all"},
                                                             {"columns:", "changed / all"},
                                                             {"ms to", "add"},
                                                             {"ms", "anew"},
                                                             {"measured", "error"},
                                                             {"its", "bound"}};
    for (std::size_t i = 0; i < std::size(names); ++i) {
        f.text(at + Vec2d{column_ends[i], 0}, names[i].first, {9, ink::soft, Align::right});
        f.text(at + Vec2d{column_ends[i], 20}, names[i].second, {9, ink::soft, Align::right});
    }
}

void draw_row(Figure& f, const Step& step, int number, Vec2d at) {
    const ProgressReport& r = step.report;
    const auto cost = [](double ms) { return ms > 0 ? fmt::format("{:.3f}", ms) : std::string("·"); };
    const std::string cells[] = {
        number == 0 ? std::string("start") : fmt::format("{}", number),
        fmt::format("{} / {}", step.difference.size(), quads_of(step.mask.view()).size()),
        fmt::format("{} / {}", r.terms, separable_terms(step.mask.view()).count()),
        cost(r.update_ms),
        cost(r.refresh_ms),
        r.refreshed ? std::string("0") : fmt::format("{:.1e}", step.error),
        fmt::format("{:.1e}", r.error_bound)};
    for (std::size_t i = 0; i < std::size(cells); ++i)
        f.text(at + Vec2d{column_ends[i], 0}, cells[i], lettering::right);
}

// Step 4: one texel after the other: the bound grows, and starts again.
void draw_drift(Figure& f, const Image<float>& iris, const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, false, "texels to the right, one per step", "");
    FarFieldProgress progress;
    progress.grid = centred_grid(pixels / 2, pixels / 2, 1.0 / pixels);
    const double limit = decades_of(progress.tolerance);
    f.line(plot.at(plot.x0, limit), plot.at(plot.x1, limit), {ink::dark, 1.5, 5});
    for (double gone = plot.x0; gone <= plot.x1; ++gone) {
        const Step step = next_step(progress, mask_after(iris, gone), exec);
        f.disc(plot.at(gone, decades_of(step.report.error_bound)), 2.8, bound_color);
        if (step.error > 0)
            f.disc(plot.at(gone, decades_of(step.error)), 2.8, error_color);
        else
            f.line(plot.at(gone, plot.y0), plot.at(gone, plot.y1), {ink::grid, 1.5});
    }
    axis_numbers(f, plot, {0, 15, 30, 45, 60}, 0);
}

// Step 5: what the model expects of adding the difference, for discs that jump.
void draw_costs(Figure& f, const Image<float>& iris, const Plot& plot, const Exec& exec) {
    f.axes(plot, "", "");
    for (const double ms : {0.0, 0.1, 0.2, 0.3}) {
        f.line(plot.at(plot.x0, ms), plot.at(plot.x1, ms), {ink::grid, 1});
        f.text(plot.at(plot.x0, ms) + Vec2d{-8, 4}, fmt::format("{:.1f}", ms),
               {8.5, ink::soft, Align::right});
    }
    constexpr std::pair<double, Rgb8> discs[] = {{7, ink::green}, {14, ink::blue}, {28, ink::purple}};
    for (const auto& [disc, color] : discs) {
        std::vector<Vec2d> added, anew;
        for (const double gone : {1, 2, 4, 8, 12, 16, 24, 32, 48}) {
            FarFieldProgress progress;
            progress.grid = pattern_grid;
            update_far_field(progress, mask_after(iris, 20, disc).view(), exec);
            const ProgressReport r =
                update_far_field(progress, mask_after(iris, 20 + gone, disc).view(), exec);
            CHECK(r.refreshed == (r.update_ms > r.refresh_ms));
            added.push_back(plot.at(gone, r.update_ms));
            anew.push_back(plot.at(gone, r.refresh_ms));
            f.disc(added.back(), 3.5, color);
        }
        f.polyline(added, {color, 1.6});
        f.polyline(anew, {ink::dark, 1.5, 5});
    }
    axis_numbers(f, plot, {0, 16, 32, 48}, 0);
    f.text(plot.at(plot.x1, 0) + Vec2d{10, 38}, "texels to the right in one step",
           {9, ink::soft, Align::right});
}

}  // namespace

Image<Rgb8> lesson_18_kept_field(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(18, "A far field kept up to date",
              "The transform is linear: what opened less what closed turns one pattern into the next.");
    const Image<float> iris = binary_mask(ApertureKind::iris, mask_texels);
    FarFieldProgress progress;
    progress.grid = pattern_grid;
    draw_head(f, {40, 766});
    for (int i = 0; i < steps; ++i) {
        const Step step = next_step(progress, mask_after(iris, 13 * i), exec);
        draw_step(f, step, progress.field, i, {40 + 316.0 * i, 142});
        draw_row(f, step, i, {40, 818 + 28.0 * i});
    }
    const double right = f.legend({40, 692}, {{Mark::square, open_color, "open"},
                                              {Mark::square, positive_quad, "quads added, weight +1"},
                                              {Mark::square, negative_quad, "quads removed, weight −1"}});
    draw_scale(f, {right + 124, 680}, 200, "1e-6 F(0)²", "|F|² of the kept field (log scale)");
    f.text({1130, 692}, "Sums run over distinct columns or rows: fewer than quads.");
    f.text({40, 734}, "Every step", lettering::head);
    f.text({650, 734}, "errors: shares of F(0), against a field made anew", {9, ink::soft, Align::right});
    f.text({720, 734}, "Error / F(0), a texel at a time", lettering::head);
    draw_drift(f, iris, {{764, 766, 320, 124}, 0, 60, -9, -5}, exec);
    f.legend({764, 947}, {{Mark::dot, bound_color, "bound"},
                          {Mark::dot, error_color, "measured"},
                          {Mark::dashes, ink::dark, "tolerance"}});
    f.text({1170, 734}, "Cost by the model, ms", lettering::head);
    draw_costs(f, iris, {{1210, 766, 340, 124}, 0, 48, 0, 0.3}, exec);
    f.legend({1180, 947}, {{Mark::line, ink::green, "radius 7"},
                           {Mark::line, ink::blue, "14"},
                           {Mark::line, ink::purple, "28"},
                           {Mark::dashes, ink::dark, "anew"}});
    f.source_line(18,
                  "optics/far_field_progress.h update_far_field · optics/field/quads.h difference_quads · "
                  "optics/field/separable_terms.h separable_terms");
    return f.picture;
}

}  // namespace obscura
