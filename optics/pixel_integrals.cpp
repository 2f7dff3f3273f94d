// Summed-area tables over bands of frequencies.

#include "optics/pixel_integrals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "optics/psf_memory.h"

namespace obscura {

namespace {

constexpr int rows_per_item = 32;
constexpr std::int64_t cells_per_band = std::int64_t{1} << 22;
constexpr std::int64_t least_columns_per_band = 128;
constexpr double most_frequencies = 0x1p36;  // minutes, and half a gigabyte a band

/// Cells around samples k cell: columns k = 0 to columns - 1 of the half plane u >= 0, of whose first only
/// the right half counts; rows k = -rows to rows.
struct Cells {
    double side = 0;
    int columns = 0, rows = 0;
    int height() const { return 2 * rows + 1; }
    int columns_per_band() const {
        const std::int64_t fit = std::max(least_columns_per_band, cells_per_band / height());
        return static_cast<int>(std::min<std::int64_t>(fit, columns));
    }
};

Cells cells_of(double cell, int radius_px, const std::vector<PixelLight>& lights) {
    double widest = 0;
    for (const PixelLight& light : lights)
        widest = std::max(widest, light.pixel);
    const double reach = std::ceil((radius_px + 0.5) * widest / cell);
    const double wanted = 2 * (reach + 2) * (reach + 2);
    if (!(wanted < most_frequencies)) {
        throw PatternLimit(
            fmt::format("the lens's pattern needs {:.3g} frequencies, the limit is {:.3g}; smaller pixels, a "
                        "larger f-number or a smaller radius need fewer",
                        wanted, most_frequencies));
    }
    const int count = static_cast<int>(reach) + 1;
    return {cell, count + 1, count};
}

/// A place between two borders of cells.
struct Place {
    int border = 0;
    double beyond = 0;  ///< in [0, 1)
};

Place place_of(double borders) {
    const double border = std::floor(borders);
    return {static_cast<int>(border), borders - border};
}

/// Border column 0 is at u = 0, border column k at u = (k - 1/2) cells.
Place column_place(double cells) {
    return cells < 0.5 ? Place{0, 2 * cells} : place_of(cells + 0.5);
}

/// Integrals from (0, least v) to a border column and a border row, in units of a cell, for the border
/// columns first to first + count - 1; row k holds those of column first + k.
struct Table {
    int first = 0, count = 0, borders = 0;
    std::vector<double> sums;
    double* row(int k) { return sums.data() + static_cast<std::ptrdiff_t>(k) * borders; }
    const double* row(int k) const { return sums.data() + static_cast<std::ptrdiff_t>(k) * borders; }
};

/// Sums down sixteen columns of the band at a time, so that whole cache lines of the power are read.
void sum_columns(Table& table, const Image<float>& power, int begin, int end) {
    double sum[16] = {};
    for (int x = begin; x < end; ++x)
        table.row(x + 1)[0] = 0;
    for (int y = 0; y < power.height; ++y) {
        const float* row = power.row(y);
        for (int x = begin; x < end; ++x)
            table.row(x + 1)[y + 1] = sum[x - begin] += static_cast<double>(row[x]);
    }
    if (table.first > 0 || begin > 0) return;
    for (int y = 0; y <= power.height; ++y)
        table.row(1)[y] *= 0.5;
}

/// Moves the table on to the next band; its last column becomes the first.
void advance(Table& table, const Image<float>& power, const Exec& exec) {
    const double* last = table.row(table.count - 1);
    std::copy(last, last + table.borders, table.row(0));
    table.first += table.count - 1;
    table.count = power.width + 1;
    parallel_blocks(static_cast<std::size_t>(power.width), 16, exec, [&](std::size_t begin, std::size_t end) {
        sum_columns(table, power, static_cast<int>(begin), static_cast<int>(end));
    });
    parallel_blocks(static_cast<std::size_t>(table.borders), 512, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (int k = 1; k < table.count; ++k) {
                            const double* before = table.row(k - 1);
                            double* row = table.row(k);
                            for (std::size_t j = begin; j < end; ++j)
                                row[j] += before[j];
                        }
                    });
}

/// What is known of one light between bands.
struct Passage {
    PixelLight light;
    std::vector<Place> edges;    ///< of the pixels, from top to bottom
    std::vector<double> before;  ///< per pixel row: integral up to the last pixel border passed
    int next = 0, end = 0;       ///< pixel columns whose right border lies in the band
};

std::vector<Passage> passages_of(const Cells& cells, int radius_px, const std::vector<PixelLight>& lights) {
    const int side = 2 * radius_px + 1;
    std::vector<Passage> passages;
    for (const PixelLight& light : lights) {
        Passage passage;
        passage.light = light;
        for (int m = 0; m <= side; ++m)
            passage.edges.push_back(
                place_of((m - radius_px - 0.5) * light.pixel / cells.side + cells.rows + 0.5));
        passage.before.assign(static_cast<std::size_t>(side), 0.0);
        passages.push_back(std::move(passage));
    }
    return passages;
}

/// Where the right border of a column of pixels lies among the border columns.
Place right_border(const Passage& passage, const Cells& cells, int column) {
    return column_place((column + 0.5) * passage.light.pixel / cells.side);
}

/// Adds the pixels of rows [begin, end) whose right borders the band holds. Column x of the half kernel is
/// row x of `half`.
void gather(Passage& passage, const Table& table, const Cells& cells, int begin, int end,
            Image<Vec3d>& half) {
    for (int column = passage.next; column < passage.end; ++column) {
        const Place at = right_border(passage, cells, column);
        const double* left = table.row(at.border - table.first);
        const double* right = table.row(at.border - table.first + 1);
        const auto up_to = [&](const Place& edge) {
            const double above = left[edge.border] + at.beyond * (right[edge.border] - left[edge.border]);
            const double below =
                left[edge.border + 1] + at.beyond * (right[edge.border + 1] - left[edge.border + 1]);
            return above + edge.beyond * (below - above);
        };
        const Place* edges = passage.edges.data();
        double* before = passage.before.data();
        Vec3d* out = half.row(column);
        double top = up_to(edges[begin]);
        for (int m = begin; m < end; ++m) {
            const double bottom = up_to(edges[m + 1]);
            const double here = bottom - top;
            out[m] = out[m] + passage.light.colour * (here - before[m]);
            before[m] = here;
            top = bottom;
        }
    }
}

/// The half kernel and its reflection through the centre. Its first column is half a pixel wide.
Image<Vec3d> whole_kernel(const Image<Vec3d>& half, int radius_px, double area) {
    const int side = 2 * radius_px + 1;
    Image<Vec3d> kernel(side, side);
    for (int m = 0; m < side; ++m) {
        kernel(radius_px, m) = (half(m, 0) + half(side - 1 - m, 0)) * area;
        for (int x = 1; x <= radius_px; ++x)
            kernel(radius_px + x, m) = kernel(radius_px - x, side - 1 - m) = half(m, x) * area;
    }
    return kernel;
}

}  // namespace

Image<Vec3d> integrate_over_pixels(const PowerSource& power, double cell, int radius_px,
                                   const std::vector<PixelLight>& lights, const Exec& exec) {
    CHECK(cell > 0 && radius_px >= 0 && !lights.empty());
    const Cells cells = cells_of(cell, radius_px, lights);
    std::vector<Passage> passages = passages_of(cells, radius_px, lights);
    const int side = 2 * radius_px + 1, band = cells.columns_per_band();
    Image<Vec3d> half(side, radius_px + 1);
    Table table{0, 1, cells.height() + 1, {}};
    table.sums.assign(static_cast<std::size_t>(band + 1) * static_cast<std::size_t>(table.borders), 0.0);

    for (int first = 0; first < cells.columns; first += band) {
        const int width = std::min(band, cells.columns - first);
        advance(table, power({width, cells.height(), first * cell, -cells.rows * cell, cell, cell}), exec);
        for (Passage& passage : passages) {
            passage.next = passage.end;
            while (passage.end <= radius_px &&
                   right_border(passage, cells, passage.end).border < first + width)
                ++passage.end;
        }
        parallel_blocks(
            static_cast<std::size_t>(side), rows_per_item, exec, [&](std::size_t begin, std::size_t end) {
                for (Passage& passage : passages) {
                    gather(passage, table, cells, static_cast<int>(begin), static_cast<int>(end), half);
                }
            });
    }
    return whole_kernel(half, radius_px, cell * cell);
}

PixelIntegralWork pixel_integral_work(double cell, int radius_px, const std::vector<PixelLight>& lights) {
    const Cells cells = cells_of(cell, radius_px, lights);
    return {std::int64_t{cells.columns} * cells.height(),
            {cells.columns_per_band(), cells.height(), 0, -cells.rows * cell, cell, cell}};
}

std::int64_t pixel_integral_bytes(const PixelIntegralWork& work, int radius_px, std::size_t lights) {
    const std::int64_t side = 2 * std::int64_t{radius_px} + 1;
    const std::int64_t table =
        (std::int64_t{work.band.width} + 1) * (work.band.height + 1) * std::int64_t{sizeof(double)};
    const std::int64_t passage =
        (side + 1) * std::int64_t{sizeof(Place)} + side * std::int64_t{sizeof(double)};
    return table + static_cast<std::int64_t>(lights) * passage +
           side * (radius_px + 1) * std::int64_t{sizeof(Vec3d)};
}

double pixel_integral_cost_ms(const PixelIntegralWork& work, int radius_px, std::size_t lights) {
    constexpr double ns_per_cell = 8, ns_per_pixel = 8;
    const double half_kernel = (radius_px + 1.0) * (2.0 * radius_px + 1);
    return 1e-6 * (ns_per_cell * static_cast<double>(work.frequencies) +
                   ns_per_pixel * half_kernel * static_cast<double>(lights));
}

}  // namespace obscura
