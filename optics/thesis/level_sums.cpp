// Phasor sums over quads, level by level.

#include "optics/thesis/level_sums.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/parallel.h"
#include "optics/field/phasor.h"
#include "optics/field/separable_field.h"

namespace obscura {
namespace {

constexpr int most_levels = 31;

int side_bits(std::int32_t x, std::int32_t y, std::int32_t width, std::int32_t height) {
    const auto all = static_cast<std::uint32_t>(x | y | width | height);
    int bits = 0;
    while ((all >> bits & 1u) == 0)
        ++bits;
    return bits;
}

/// Cells of a level by column, in units of the side: y -> weight.
using Columns = std::map<std::int32_t, std::vector<std::pair<std::int32_t, float>>>;

void add_cells(const QuadList& quads, std::size_t q, int bits, Columns& columns) {
    for (std::int32_t x = quads.x[q] >> bits; x < (quads.x[q] + quads.width[q]) >> bits; ++x) {
        auto& column = columns[x];
        for (std::int32_t y = quads.y[q] >> bits; y < (quads.y[q] + quads.height[q]) >> bits; ++y)
            column.emplace_back(y, quads.weight[q]);
    }
}

SeparableTerms terms_of(const Columns& columns, int side, int origin_x, int origin_y) {
    SeparableTerms terms;
    for (const auto& [x, cells] : columns) {
        terms.x.add(x * side - origin_x, (x + 1) * side - origin_x, 1.0f);
        for (const auto& [y, weight] : cells)
            terms.y.add(y * side - origin_y, (y + 1) * side - origin_y, weight);
        terms.x.close_term();
        terms.y.close_term();
    }
    return terms;
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// `cells` own sum, over the half period.
LevelSum own_sum(const LevelCells& cells, int period_u, int period_v, const Exec& exec) {
    LevelSum sum;
    sum.period_u = period_u / cells.side;
    sum.period_v = period_v / cells.side;
    sum.columns = sum.period_u / 2 + 1;
    const auto size = static_cast<std::size_t>(sum.columns) * static_cast<std::size_t>(sum.period_v);
    sum.re.reset(size);
    sum.im.reset(size);
    const double step_u = 1.0 / period_u, step_v = 1.0 / period_v;
    const int above = sum.period_v / 2;
    const FrequencyGrid grid{sum.columns, sum.period_v, 0, -above * step_v, step_u, step_v};
    SeparableParams params;
    params.points = true;
    separable_field(cells.terms, grid, params, {sum.re.data(), sum.im.data(), nullptr, sum.columns}, exec);
    return sum;
}

/// 2 cos(pi side j / period) for `count` samples from `first`: two points half a side apart from the middle.
std::vector<float> pair_cosines(int side, int period, int first, int count, const Exec& exec) {
    std::vector<float> re(static_cast<std::size_t>(count)), im(re.size());
    const FrequencyRamp ramp{static_cast<double>(first) / period, 1.0 / period, count};
    OBSCURA_DISPATCH(exec.isa, phasor_row, ramp, side * 0.5, re.data(), im.data());
    for (float& c : re)
        c = 2.0f * c;
    return re;
}

/// A cell is four of half its side, (+-side / 2, +-side / 2) around its middle: fine += 2 cos * 2 cos *
/// coarse.
void add_coarser(const LevelSum& coarse, int fine_side, int period_u, int period_v, LevelSum& fine,
                 const Exec& exec) {
    const std::vector<float> cos_u = pair_cosines(fine_side, period_u, 0, fine.columns, exec);
    const int half = fine.period_v / 2;
    const std::vector<float> cos_v = pair_cosines(fine_side, period_v, -half, fine.period_v, exec);
    parallel_blocks(
        static_cast<std::size_t>(fine.period_v), 16, exec, [&](std::size_t begin, std::size_t end) {
            const auto columns = static_cast<std::size_t>(fine.columns);
            std::vector<float> re(columns), im(columns);
            for (std::size_t row = begin; row < end; ++row) {
                coarse.read_row(0, fine.columns, static_cast<std::int64_t>(row) - half, re.data(), im.data());
                float *to_re = fine.re.data() + row * columns, *to_im = fine.im.data() + row * columns;
                for (std::size_t j = 0; j < columns; ++j) {
                    const float c = cos_u[j] * cos_v[row];
                    to_re[j] += c * re[j];
                    to_im[j] += c * im[j];
                }
            }
        });
}

}  // namespace

int level_origin(int extent, int side) {
    return (extent / 2 + side - 1) / side * side;
}

std::vector<LevelCells> level_cells(const QuadList& quads) {
    std::array<Columns, most_levels> columns;
    int finest = most_levels, coarsest = 0;
    for (std::size_t q = 0; q < quads.size(); ++q) {
        const int bits = side_bits(quads.x[q], quads.y[q], quads.width[q], quads.height[q]);
        add_cells(quads, q, bits, columns[static_cast<std::size_t>(bits)]);
        finest = std::min(finest, bits);
        coarsest = std::max(coarsest, bits);
    }
    std::vector<LevelCells> levels;
    const int origin_x = level_origin(quads.columns, 1 << coarsest),
              origin_y = level_origin(quads.rows, 1 << coarsest);
    for (int bits = finest; bits <= coarsest; ++bits) {
        const int side = 1 << bits;
        levels.push_back({side, terms_of(columns[static_cast<std::size_t>(bits)], side, origin_x, origin_y)});
    }
    return levels;
}

void LevelSum::read_row(std::int64_t first, int count, std::int64_t k, float* to_re, float* to_im) const {
    const int half = period_v / 2;
    // Rows k and -k inside the stored period, and the signs that bringing them there costs.
    const auto row_of = [&](std::int64_t row, float& sign) {
        const std::int64_t turns = floor_div(row + half, period_v);
        sign = (turns & 1) != 0 ? -1.0f : 1.0f;
        return static_cast<std::size_t>(row + half - turns * period_v) * static_cast<std::size_t>(columns);
    };
    float sign_same = 1, sign_opposite = 1;
    const std::size_t same = row_of(k, sign_same), opposite = row_of(-k, sign_opposite);

    for (int at = 0; at < count;) {
        const std::int64_t j = first + at, turns = floor_div(j, period_u);
        const int within = static_cast<int>(j - turns * period_u);
        const float sign = (turns & 1) != 0 ? -1.0f : 1.0f;
        if (within < columns) {
            // Stored as it is.
            const int run = std::min(columns - within, count - at);
            const float s = sign * sign_same;
            const float *from_re = re.data() + same + within, *from_im = im.data() + same + within;
            for (int i = 0; i < run; ++i) {
                to_re[at + i] = s * from_re[i];
                to_im[at + i] = s * from_im[i];
            }
            at += run;
        } else {
            // T(j, k) = -T(j - period, k) = -conjugate of T(period - j, -k): backwards through the other row.
            const int run = std::min(period_u - within, count - at);
            const float s = -sign * sign_opposite;
            const float *from_re = re.data() + opposite + (period_u - within),
                        *from_im = im.data() + opposite + (period_u - within);
            for (int i = 0; i < run; ++i) {
                to_re[at + i] = s * from_re[-i];
                to_im[at + i] = -s * from_im[-i];
            }
            at += run;
        }
    }
}

LevelSum finest_sum(const std::vector<LevelCells>& levels, int period_u, int period_v, const Exec& exec) {
    LevelSum sum = own_sum(levels.back(), period_u, period_v, exec);
    for (std::size_t l = levels.size() - 1; l-- > 0;) {
        LevelSum finer = own_sum(levels[l], period_u, period_v, exec);
        add_coarser(sum, levels[l].side, period_u, period_v, finer, exec);
        sum = std::move(finer);
    }
    return sum;
}

}  // namespace obscura
