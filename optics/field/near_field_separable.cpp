// The near field of separable terms. An interval's factor is a difference of two rows of the axis's table,
// taken in double and then rounded: the panels are as exact as floats can be however far away the plane is.

#include "optics/field/near_field_separable.h"

#include <algorithm>
#include <cmath>

#include "core/buffer.h"
#include "core/parallel.h"
#include "optics/field/line_sums.h"
#include "optics/field/product.h"

namespace obscura {
namespace {

/// Terms as sums of rows of a table.
struct TermRows {
    std::vector<std::int32_t> first{0}, edge;
    std::vector<double> weight;
};

TermRows rows_of(const IntervalTerms& terms, int texels) {
    TermRows rows;
    for (std::size_t k = 0; k + 1 < terms.begin.size(); ++k) {
        for (auto r = static_cast<std::size_t>(terms.begin[k]);
             r < static_cast<std::size_t>(terms.begin[k + 1]); ++r) {
            const double weight = static_cast<double>(terms.weight[r]);
            rows.edge.push_back(static_cast<std::int32_t>(std::floor(terms.x1[r] + 0.5 * texels + 0.5)));
            rows.weight.push_back(weight);
            rows.edge.push_back(static_cast<std::int32_t>(std::floor(terms.x0[r] + 0.5 * texels + 0.5)));
            rows.weight.push_back(-weight);
        }
        rows.first.push_back(static_cast<std::int32_t>(rows.edge.size()));
    }
    return rows;
}

int panels_for(int count) {
    return (count + product_tile - 1) / product_tile;
}

/// Factors of all terms at the first `pixels` pixels, in panels of sixteen.
struct Factors {
    Buffer<float> re, im;
};

Factors factors_of(const IntervalTerms& terms, const PlaneAxis& axis, int pixels, double turns,
                   const Exec& exec) {
    const TermRows rows = rows_of(terms, axis.texels);
    std::vector<std::int32_t> edges = rows.edge;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const EdgeTable table(axis, turns, edges, exec);
    std::vector<std::int64_t> offsets;
    for (const std::int32_t e : rows.edge)
        offsets.push_back(table.offset(e));

    const auto panels = static_cast<std::size_t>(panels_for(pixels));
    const std::size_t size = static_cast<std::size_t>(terms.count()) * product_tile;
    Factors factors{Buffer<float>(panels * size), Buffer<float>(panels * size)};
    parallel_for(panels, exec, [&](std::size_t p) {
        const std::size_t at = p * product_tile;
        const LineSums sums{terms.count(),      rows.first.data(),    offsets.data(),
                            rows.weight.data(), table.re_base() + at, table.im_base() + at};
        OBSCURA_DISPATCH(exec.isa, sum_lines16, sums, factors.re.data() + p * size,
                         factors.im.data() + p * size);
    });
    return factors;
}

/// The factor 1 / (2 i) of both axes together: twice the real part becomes minus the imaginary one.
void divide_by_2i(Factors& factors) {
    for (std::size_t i = 0; i < factors.re.size(); ++i) {
        const float re = factors.re[i];
        factors.re[i] = 0.5f * factors.im[i];
        factors.im[i] = -0.5f * re;
    }
}

void clear(float* plane, const PlaneGrid& grid, std::ptrdiff_t stride) {
    if (plane == nullptr) return;
    for (int y = 0; y < grid.height; ++y)
        std::fill_n(plane + y * stride, grid.width, 0.0f);
}

/// The columns from `columns` on and the rows from `rows` on are the others' mirror images.
void mirror(float* plane, const PlaneGrid& grid, std::ptrdiff_t stride, int columns, int rows) {
    if (plane == nullptr) return;
    for (int y = 0; y < rows; ++y) {
        float* row = plane + y * stride;
        for (int x = columns; x < grid.width; ++x)
            row[x] = row[grid.width - 1 - x];
    }
    for (int y = rows; y < grid.height; ++y)
        std::copy_n(plane + (grid.height - 1 - y) * stride, grid.width, plane + y * stride);
}

}  // namespace

void near_field_separable(const NearFieldCase& c, const SeparableTerms& terms, const BlockSet* blocks,
                          const FieldTarget& target, const Exec& exec) {
    CHECK(target.stride >= c.grid.width);
    const auto [columns, rows] = part_to_compute(c);
    const Factors a = factors_of(terms.y, c.vertical(), rows, c.turns, exec);
    Factors b = factors_of(terms.x, c.horizontal(), columns, c.turns, exec);
    divide_by_2i(b);

    const ProductPanels panels{a.re.data(), a.im.data(), b.re.data(), b.im.data(), terms.count()};
    ProductTarget to{target.re, target.im, target.power, target.stride, columns, rows};
    if (blocks != nullptr) {
        to.active = blocks->active.data();
        to.active_stride = blocks->columns;
        for (float* plane : {target.re, target.im, target.power})
            clear(plane, c.grid, target.stride);
    }
    const int row_panels = panels_for(rows), column_panels = panels_for(columns);
    parallel_for(static_cast<std::size_t>((row_panels + 1) / 2), exec, [&](std::size_t item) {
        const int first = static_cast<int>(item) * 2;
        for (int column = 0; column < column_panels; ++column) {
            for (int row = first; row < std::min(first + 2, row_panels); ++row)
                OBSCURA_DISPATCH(exec.isa, product, panels, to, row, column);
        }
    });
    for (float* plane : {target.re, target.im, target.power})
        mirror(plane, c.grid, target.stride, columns, rows);
}

}  // namespace obscura
