// Lesson 10. Adding quads: the far field as a sum of closed forms.
//
// You learn: the far field of a rectangle is a product of two sincs, known at every frequency; a few hundred
// add up to that of an aperture's mask, exactly; the large ones give its middle, the small ones its streaks.
// And that the ends of runs and one-dimensional FFTs give the same for a fraction of the work. L. Scandolo,
// "Compression and rendering with image-based representations", thesis, 2019, section 3.4.1, (3.9) to (3.14).
//
// Calls: optics/field/quads.h quads_of, optics/thesis/far_field.h far_field_direct,
// optics/far_field_methods.h
//        far_field_runs, optics/field/row_runs.h row_runs, optics/field/separable_terms.h distinct_columns.

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/aperture_panels.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/pattern_panels.h"
#include "lessons/quad_fields.h"
#include "optics/field/row_runs.h"
#include "optics/field/separable_terms.h"

namespace obscura {
namespace {

constexpr int mask_texels = 128, pixels = 256;
constexpr Rgb8 one_color = ink::orange, few_color = ink::green, all_color = ink::blue;

/// All quads, the largest first; what they add up to over the grid; and F(0).
struct Sum {
    FrequencyGrid grid;
    QuadList quads;
    Field full;
    double area = 0;
    QuadList first(std::size_t n) const {
        return quads_where(quads, [n](std::size_t k) { return k < n; });
    }
};

// Step 1: the first few quads, what they cover and what they spread.
void draw_sum(Figure& f, const Sum& sum, std::size_t count, Vec2d at, const Exec& exec) {
    const QuadList quads = sum.first(count);
    const Field field = field_of_quads(quads, sum.grid, exec);
    const double error = largest_difference(field, sum.full) / sum.area;
    f.fill({at.x, at.y, mask_texels, mask_texels}, ink::panel);
    draw_quads(f, at, 1, quads);
    f.frame({at.x, at.y, mask_texels, mask_texels}, {ink::soft, 1});
    f.text(at + Vec2d{142, 14}, fmt::format("{} quad{}", quads.size(), quads.size() == 1 ? "" : "s"),
           lettering::head);
    f.paragraph(at + Vec2d{142, 42},
                fmt::format("{} negative\n \nlargest error\n{}", count_negative(quads),
                            error < 1e-6 ? "below 1e-6 F(0)" : fmt::format("{:.3f} F(0)", error)));
    draw_power(f, at + Vec2d{0, 146}, power_of(field).view(), {sum.area * sum.area, 6});
}

// Step 2: the error after every power of two.
void draw_errors(Figure& f, const Sum& sum, const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, true, "quads", "largest error / F(0)");
    std::vector<Vec2d> line;
    for (std::size_t count = 1; count < sum.quads.size(); count *= 2) {
        const Field field = field_of_quads(sum.first(count), sum.grid, exec);
        line.push_back(plot.at(decades_of(static_cast<double>(count)),
                               decades_of(largest_difference(field, sum.full) / sum.area)));
        f.disc(line.back(), 4, all_color);
    }
    f.polyline(line, {all_color, 2});
    const Vec2d end = plot.at(decades_of(static_cast<double>(sum.quads.size())), plot.y0);
    f.arrow(line.back(), end, {all_color, 2});
    f.text(end + Vec2d{-14, -18}, fmt::format("all {}: rounding", sum.quads.size()),
           {9, all_color, Align::right, true, true});
}

// Step 3: power along the horizontal axis. One quad alone is a squared sinc.
void draw_slice(Figure& f, const Sum& sum, const Plot& plot, const Exec& exec) {
    decade_axes(f, plot, false, "u, cycles per texel", "|F|² / F(0)² (log scale)");
    const int samples = static_cast<int>(plot.box.w);
    const FrequencyGrid row{samples, 1, 0, 0, plot.x1 / (samples - 1), 1};
    const std::pair<std::size_t, Rgb8> sums[] = {
        {1, one_color}, {16, few_color}, {sum.quads.size(), all_color}};
    for (const auto& [count, color] : sums) {
        const Image<float> power = power_of(field_of_quads(sum.first(count), row, exec));
        std::vector<double> shares;
        for (const float p : power.pixels)
            shares.push_back(static_cast<double>(p) / (sum.area * sum.area));
        decade_curve(f, plot, shares, {color, 1.6});
    }
    axis_numbers(f, plot, {0, 0.02, 0.04, 0.06}, 2);
}

// Step 4: complex multiply-adds for half of a plane of frequencies; the other half is conjugate.
void draw_work(Figure& f, int side, const Box& box, Isa isa) {
    const Image<float> mask = binary_mask(ApertureKind::iris, side);
    const double n = 2 * side, columns = n / 2 + 1, butterflies = n / 2 * decades_of(n) / decades_of(2);
    const double texels = open_area(mask.view());
    const auto quads = static_cast<double>(quads_of(mask.view()).size());
    const auto runs = static_cast<double>(row_runs(mask.view(), isa).begin.size());
    const double distinct = distinct_columns(mask.view()).count();
    const std::pair<std::string, double> ways[] = {
        {fmt::format("{} texels", texels), texels * n * columns},
        {fmt::format("{} quads", quads), quads * n * columns},
        {fmt::format("{} distinct columns", distinct), distinct * n * columns},
        {"FFTs of rows, of columns", (n / 4 + columns) * butterflies},
        {fmt::format("{} runs, FFTs of columns", runs), 2 * runs * columns + columns * butterflies}};
    double y = box.y;
    for (const auto& [name, work] : ways) {
        const double bar = (box.w - 300) * (decades_of(work) - 6) / 5;
        f.text({box.x + 190, y + 13}, name, lettering::right);
        f.fill({box.x + 202, y, bar, 16}, name == ways[4].first ? all_color : ink::grey);
        f.text({box.x + 210 + bar, y + 13}, fmt::format("{:.{}f} million", work * 1e-6, work < 1e7 ? 1 : 0),
               {9});
        y += 27;
    }
}

}  // namespace

Image<Rgb8> lesson_10_adding_quads(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(10, "Adding quads",
              "Far fields of rectangles are closed forms: added up, that of an aperture.");
    const Image<float> mask = binary_mask(ApertureKind::iris, mask_texels);
    const FrequencyGrid grid = centred_grid(pixels, pixels, 1.0 / (2 * pixels));
    const QuadList quads = largest_first(quads_of(mask.view()));
    const Sum sum{grid, quads, field_of_quads(quads, grid, exec), open_area(mask.view())};
    CHECK(largest_difference(sum.full, field_of_runs(mask.view(), grid, exec)) < 1e-6 * sum.area);
    const std::size_t counts[] = {1, 4, 16, 64, sum.quads.size()};
    for (int i = 0; i < 5; ++i)
        draw_sum(f, sum, counts[i], {40 + 316.0 * i, 132}, exec);
    draw_scale(f, {170, 552}, 200, "1e-6 of the peak", "peak of the aperture's pattern (log scale)");
    f.text({40, 620}, "Error over the pattern (log scales)", lettering::head);
    draw_errors(f, sum, {{84, 664, 340, 210}, 0, 2.5, -4, 0}, exec);
    f.text({500, 620}, "Along the horizontal axis", lettering::head);
    draw_slice(f, sum, {{544, 664, 400, 210}, 0, 0.0625, -7, 0}, exec);
    f.legend({544, 912},
             {{Mark::line, one_color, "1"}, {Mark::line, few_color, "16"}, {Mark::line, all_color, "all"}});
    f.text({1020, 620}, "Complex multiply-adds (log scale from a million)", lettering::head);
    draw_work(f, 512, {1020, 644, 540, 150}, exec.isa);
    f.paragraph(
        {1020, 806},
        "Heptagon of 512 × 512 texels, 1024 × 513 frequencies. A quad's transform\nis sin(πuw) / (πu) "
        "times sin(πvh) / (πv), turned by its place: no samples,\nnothing left out but rounding. A run "
        "of a row needs its two ends only, and\nfrom row to row an FFT does at once what quads do one "
        "by one.\nBoth sums are the same function: above, they differ by less than 1e-6 F(0).");
    f.source_line(10,
                  "optics/thesis/far_field.h far_field_direct · optics/far_field_methods.h far_field_runs · "
                  "optics/field/quads.h quads_of · optics/field/separable_terms.h distinct_columns");
    return f.picture;
}

}  // namespace obscura
