// The far field of separable terms.

#include "optics/field/separable_field.h"

#include <algorithm>
#include <cmath>

#include "core/buffer.h"
#include "core/parallel.h"
#include "optics/field/product.h"

namespace obscura {
namespace {

enum class Transform { box, slope, point };

/// Transforms of all terms at all frequencies of a ramp, in panels of sixteen.
struct Factors {
    Buffer<float> re, im;
    bool real = false;
    const float* imaginary() const { return real ? nullptr : im.data(); }
};

int panels_for(int count) {
    return (count + product_tile - 1) / product_tile;
}

Factors factors_of(const IntervalTerms& terms, const FrequencyRamp& ramp, Transform transform,
                   const Exec& exec) {
    const auto panels = static_cast<std::size_t>(panels_for(ramp.count));
    const std::size_t size = static_cast<std::size_t>(terms.count()) * product_tile;
    Factors factors;
    factors.re.reset(panels * size);
    factors.im.reset(panels * size);
    factors.real = all_even(terms);
    parallel_for(panels, exec, [&](std::size_t p) {
        const int first = static_cast<int>(p) * product_tile;
        float *re = factors.re.data() + p * size, *im = factors.im.data() + p * size;
        switch (transform) {
            case Transform::box:
                OBSCURA_DISPATCH(exec.isa, box_panel, ramp, first, terms.view(), re, im);
                break;
            case Transform::slope:
                OBSCURA_DISPATCH(exec.isa, box_slope_panel, ramp, first, terms.view(), re, im);
                break;
            case Transform::point:
                OBSCURA_DISPATCH(exec.isa, point_panel, ramp, first, terms.view(), re, im);
                break;
        }
    });
    return factors;
}

/// Frequencies of the rows that are computed: from v = 0 on where rows come in pairs.
FrequencyRamp row_ramp(const FrequencyGrid& grid, int middle) {
    if (middle < 0) return {grid.first_v, grid.step_v, grid.height};
    return {0, grid.step_v, std::max(middle, grid.height - 1 - middle) + 1};
}

}  // namespace

int mirror_row(const FrequencyGrid& grid) {
    const double row = std::floor(0.5 - grid.first_v / grid.step_v);
    if (!(row >= 0 && row < grid.height)) return -1;
    return std::fabs(grid.first_v + row * grid.step_v) <= 1e-10 * grid.step_v ? static_cast<int>(row) : -1;
}

void separable_field(const SeparableTerms& terms, const FrequencyGrid& grid, const SeparableParams& params,
                     const FieldTarget& target, const Exec& exec) {
    CHECK(target.stride >= grid.width);
    CHECK(!params.points || params.slope == Slope::none);
    CHECK(!params.add || (target.re != nullptr && target.im != nullptr));
    // The derivative by v is odd where F is even: its rows come in no conjugate pairs.
    const Transform plain = params.points ? Transform::point : Transform::box;
    const Transform along_u = params.slope == Slope::u ? Transform::slope : plain,
                    along_v = params.slope == Slope::v ? Transform::slope : plain;
    const int middle = params.slope == Slope::v ? -1 : mirror_row(grid);
    const FrequencyRamp rows = row_ramp(grid, middle), columns{grid.first_u, grid.step_u, grid.width};
    const Factors a = factors_of(terms.y, rows, along_v, exec),
                  b = factors_of(terms.x, columns, along_u, exec);
    const ProductPanels panels{a.re.data(), a.imaginary(), b.re.data(), b.imaginary(), terms.count()};

    ProductTarget to{target.re, target.im, target.power, target.stride, grid.width, grid.height};
    to.mirrored = middle >= 0;
    to.origin = std::max(middle, 0);
    to.add = params.add;
    if (params.blocks != nullptr) {
        to.active = params.blocks->active.data();
        to.active_stride = params.blocks->columns;
    }

    // Two panels of rows meet every panel of columns while that is in the cache.
    const int row_panels = panels_for(rows.count), column_panels = panels_for(columns.count);
    parallel_for(static_cast<std::size_t>((row_panels + 1) / 2), exec, [&](std::size_t item) {
        const int first = static_cast<int>(item) * 2;
        for (int c = 0; c < column_panels; ++c) {
            for (int r = first; r < std::min(first + 2, row_panels); ++r)
                OBSCURA_DISPATCH(exec.isa, product, panels, to, r, c);
        }
    });
}

double separable_cost_ns(const SeparableTerms& terms, const FrequencyGrid& grid) {
    const double rows = row_ramp(grid, mirror_row(grid)).count, columns = grid.width;
    const double intervals_x = static_cast<double>(terms.x.x0.size()),
                 intervals_y = static_cast<double>(terms.y.x0.size());
    const double pixels = static_cast<double>(grid.width) * grid.height;
    return 0.025 * products_per_term(terms) * terms.count() * rows * columns +
           1.0 * (intervals_x * columns + intervals_y * rows) + 0.25 * pixels + 5000;
}

}  // namespace obscura
