// Far field by the runs of rows on any grid. Columns as in far_field_runs.cpp, each interval's transform in
// closed form; over the rows a chirp-z transform, which turns equally spaced samples of a spectrum into a
// convolution: with k y = (k^2 + y^2 - (k - y)^2) / 2,
//
//     sum over y of d_y e^(-2 pi i (v0 + k dv) y)
//         = e^(-pi i dv k^2) * sum over y of [d_y e^(-2 pi i v0 y) e^(-pi i dv y^2)] e^(pi i dv (k - y)^2).
//
// L. I. Bluestein: A linear filtering approach to the computation of discrete Fourier transform, 1970; L.
// Rabiner, R. Schafer, C. Rader: The chirp z-transform algorithm, 1969. Zooming in costs what a whole grid of
// as many pixels costs, and no padding.

#include "optics/far_field_chirp.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/buffer.h"
#include "core/num.h"
#include "core/parallel.h"
#include "filters/fft.h"
#include "optics/column_products.h"
#include "optics/field/phasor.h"
#include "optics/field/row_runs.h"
#include "optics/field/sinc.h"
#include "optics/run_sums.h"

namespace obscura {
namespace {

/// Complex factors, one per element of a sequence.
struct Factors {
    std::vector<float> re, im;
    void push_turns(double turns, double size) {
        const double angle = -2 * num::pi * (turns - std::floor(turns + 0.5));
        re.push_back(static_cast<float>(size * num::cos(angle)));
        im.push_back(static_cast<float>(size * num::sin(angle)));
    }
};

/// Rows first to first + count - 1 of the grid.
struct Tile {
    int first = 0, count = 0;
    Factors before, after;  ///< before and after the convolution
};

struct ChirpTransform {
    FftPlan plan;
    Factors spectrum;  ///< of the chirp, 1 / length included, in the plan's order
    std::vector<Tile> tiles;
};

ChirpTransform chirp_transform(int rows, const FrequencyGrid& grid) {
    ChirpTransform t;
    const int log2_length = chirp_log2_length(rows, grid.height);
    CHECK(log2_length > 0);
    t.plan = fft_plan(log2_length);
    const int length = t.plan.length(), most = length - rows + 1;
    const double dv = grid.step_v, middle = 0.5 - rows / 2.0;  // of the first texel
    for (int first = 0; first < grid.height; first += most) {
        Tile tile{first, std::min(most, grid.height - first), {}, {}};
        const double v0 = grid.first_v + first * dv;
        for (int y = 0; y < rows; ++y)
            tile.before.push_turns(v0 * (y + middle) + dv * y * y / 2, 1);
        for (int k = 0; k < tile.count; ++k)
            tile.after.push_turns(dv * k * middle + dv * k * k / 2, sinc_in_double(v0 + k * dv));
        t.tiles.push_back(std::move(tile));
    }
    // The chirp from -(rows - 1) to most - 1, around the corner, is transformed in the first lane.
    Buffer<float> re(16 * static_cast<std::size_t>(length)), im(re.size());
    std::fill(re.begin(), re.end(), 0.0f);
    std::fill(im.begin(), im.end(), 0.0f);
    Factors chirp;
    for (int m = 1 - rows; m < most; ++m) {
        chirp.push_turns(-dv * m * m / 2, 1.0 / length);
        const auto at = 16 * static_cast<std::size_t>(m < 0 ? m + length : m);
        re[at] = chirp.re.back();
        im[at] = chirp.im.back();
    }
    fft16_forward(t.plan, re.data(), im.data(), Isa::sse2);
    for (std::size_t k = 0; k < static_cast<std::size_t>(length); ++k) {
        t.spectrum.re.push_back(re[16 * k]);
        t.spectrum.im.push_back(im[16 * k]);
    }
    return t;
}

/// The sums over a row's runs, for sixteen columns of frequencies. Where rows have few runs, each is
/// transformed by itself; where they have many, the interval from the middle to every edge is, once, and a
/// run is a difference of two.
struct RowSums {
    const RowRuns& runs;
    bool tabulated = false;
    std::vector<std::int32_t> begin;  ///< of intervals; by row, or one interval per edge
    std::vector<double> x0, x1;
    std::vector<float> weight;
    BoxTerms terms() const {
        return {begin.data(), x0.data(), x1.data(), weight.data(), static_cast<int>(begin.size()) - 1};
    }
};

RowSums row_sums(const RowRuns& row_runs, int width) {
    // A transform of an interval costs about as much as this many differences.
    constexpr std::size_t runs_per_transform = 8;
    RowSums sums{row_runs, false, {}, {}, {}, {}};
    const double middle = width / 2.0;
    const std::size_t edges = static_cast<std::size_t>(width) + 1, runs = sums.runs.begin.size();
    sums.tabulated = edges / 2 + runs / runs_per_transform < runs;
    if (sums.tabulated) {
        // Those left of the middle are mirror images.
        for (int x = (width + 1) / 2; x <= width; ++x) {
            sums.begin.push_back(static_cast<std::int32_t>(sums.x0.size()));
            sums.x0.push_back(0);
            sums.x1.push_back(x - middle);
            sums.weight.push_back(-1);  // run_sums16 subtracts ends from beginnings
        }
        sums.begin.push_back(static_cast<std::int32_t>(sums.x0.size()));
        return sums;
    }
    sums.begin = sums.runs.first;
    sums.weight = sums.runs.weight;
    for (std::size_t r = 0; r < runs; ++r) {
        sums.x0.push_back(sums.runs.begin[r] - middle);
        sums.x1.push_back(sums.runs.end[r] - middle);
    }
    return sums;
}

/// Sixteen columns from `column` on: element 16 y + lane.
void sum_columns(const RowSums& sums, int width, const FrequencyRamp& ramp, int column, Isa isa,
                 Buffer<float>& re, Buffer<float>& im) {
    const BoxTerms terms = sums.terms();
    if (!sums.tabulated) {
        OBSCURA_DISPATCH(isa, box_panel, ramp, column, terms, re.data(), im.data());
        return;
    }
    const int right = (width + 1) / 2;  // the first edge that is not left of the middle
    Buffer<float> table_re(16 * (static_cast<std::size_t>(width) + 1)), table_im(table_re.size());
    OBSCURA_DISPATCH(isa, box_panel, ramp, column, terms, table_re.data() + 16 * right,
                     table_im.data() + 16 * right);
    // The integral from 0 to -x is minus the conjugate of that from 0 to x.
    for (int x = 0; x < right; ++x) {
        const auto to = 16 * static_cast<std::size_t>(x), from = 16 * static_cast<std::size_t>(width - x);
        for (std::size_t lane = 0; lane < 16; ++lane) {
            table_re[to + lane] = 0.0f - table_re[from + lane];
            table_im[to + lane] = table_im[from + lane];
        }
    }
    OBSCURA_DISPATCH(isa, run_sums16, sums.runs.table(), table_re.data(), re.data());
    OBSCURA_DISPATCH(isa, run_sums16, sums.runs.table(), table_im.data(), im.data());
}

}  // namespace

int chirp_log2_length(int mask_height, int grid_height) {
    int best = 0;
    double least = 0;
    for (int log2 = 0; log2 <= 16; ++log2) {
        const int most = (1 << log2) - mask_height + 1;
        if (most < 1) continue;
        const double tiles = std::ceil(static_cast<double>(grid_height) / most);
        const double cost = tiles * (log2 + 4) * (1 << log2);
        if (best == 0 || cost < least) {
            best = log2;
            least = cost;
        }
    }
    return best;
}

bool natural_is_cheaper(const NaturalGrid& natural, int mask_height, const FrequencyGrid& grid) {
    const double period = natural.v.period();
    const double groups = std::min(natural.u.period() / 32.0, grid.width / 16.0) + 1;
    const int log2 = chirp_log2_length(mask_height, grid.height);
    const double length = 1 << log2, tiles = std::ceil(grid.height / (length - mask_height + 1));
    // Products with the chirp weigh about as much as two passes; tables of the period, as several transforms.
    const double tables = 4.0 * (period + natural.u.period());
    return groups * period * (natural.v.log2_period + 1) + tables <
           std::ceil(grid.width / 16.0) * tiles * length * 2 * (log2 + 2);
}

void far_field_chirp(ImageView<const float> mask, const RowRuns& runs, const FrequencyGrid& grid,
                     const FieldTarget& target, const Exec& exec) {
    const ChirpTransform t = chirp_transform(mask.height, grid);
    const RowSums sums = row_sums(runs, mask.width);
    const FrequencyRamp ramp{grid.first_u, grid.step_u, grid.width};
    const std::size_t used = std::size_t{16} * static_cast<std::size_t>(mask.height);
    const std::size_t length = std::size_t{16} * static_cast<std::size_t>(t.plan.length());
    parallel_for(static_cast<std::size_t>((grid.width + 15) / 16), exec, [&](std::size_t group) {
        Buffer<float> row_re(used), row_im(used), re(length), im(length);
        const int column = 16 * static_cast<int>(group), lanes = std::min(16, grid.width - column);
        sum_columns(sums, mask.width, ramp, column, exec.isa, row_re, row_im);
        for (const Tile& tile : t.tiles) {
            OBSCURA_DISPATCH(exec.isa, multiply16, row_re.data(), row_im.data(), tile.before.re.data(),
                             tile.before.im.data(), mask.height, re.data(), im.data());
            std::fill(re.begin() + used, re.end(), 0.0f);
            std::fill(im.begin() + used, im.end(), 0.0f);
            fft16_forward(t.plan, re.data(), im.data(), exec.isa);
            OBSCURA_DISPATCH(exec.isa, multiply16, re.data(), im.data(), t.spectrum.re.data(),
                             t.spectrum.im.data(), t.plan.length(), re.data(), im.data());
            fft16_backward(t.plan, re.data(), im.data(), exec.isa);
            FieldTarget part = target;
            const std::ptrdiff_t skip = target.stride * tile.first;
            if (part.re != nullptr) part.re += skip;
            if (part.im != nullptr) part.im += skip;
            if (part.power != nullptr) part.power += skip;
            OBSCURA_DISPATCH(exec.isa, store_products16, re.data(), im.data(), tile.after.re.data(),
                             tile.after.im.data(), tile.count, column, lanes, part);
        }
    });
}

}  // namespace obscura
