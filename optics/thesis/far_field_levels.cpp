// The far field by levels of a quadtree, on natural grids.
//
// After L. Scandolo: Compression and rendering with image-based representations (thesis, 2019),
// section 3.4.1, equation 3.14: quads of one shape share one transform, and differ by a phase. (It prints h(d
// q); for f_m(p) = f_k(p + d) it is h(-d q).) The sum of those phases is all that depends on where quads lie,
// and since quads of size s lie on multiples of s, it repeats (but for its sign) every M / s samples of a
// grid of step 1 / M. A level of size s thus costs 1 / s^2 of what its quads would.
//
// Levels are joined from the coarsest to the finest: a cell is four cells of half its side, whose phases add
// up to 4 cos(pi u s) cos(pi v s). One envelope, the transform of the finest cell, remains at the end.

#include "optics/thesis/far_field.h"

#include "core/parallel.h"
#include "optics/field/field_rows.h"
#include "optics/field/separable_field.h"
#include "optics/thesis/level_sums.h"

namespace obscura {
namespace {

/// Transform of a cell of `side`, whose coordinates are relative to `origin`, at the samples of a ramp.
struct Envelope {
    std::vector<float> re, im;
};

Envelope envelope_of(int side, double origin, int extent, const FrequencyRamp& ramp, const Exec& exec) {
    IntervalTerms cell;
    const double shift = origin - extent * 0.5;
    cell.add(shift - side * 0.5, shift + side * 0.5, 1.0f);
    cell.close_term();
    const std::size_t padded = (static_cast<std::size_t>(ramp.count) + 15) / 16 * 16;
    Envelope envelope{std::vector<float>(padded), std::vector<float>(padded)};
    for (int at = 0; at < ramp.count; at += 16)
        OBSCURA_DISPATCH(exec.isa, box_panel, ramp, at, cell.view(), envelope.re.data() + at,
                         envelope.im.data() + at);
    return envelope;
}

}  // namespace

void far_field_levels(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                      const Exec& exec) {
    CHECK(target.stride >= grid.width);
    const std::optional<NaturalGrid> natural = natural_grid(quads.columns, quads.rows, grid);
    if (!natural) throw InputError("far field", "levels need a grid whose phases repeat: a step of 1 / 2^k");
    if (quads.size() == 0) {
        clear(target, grid.width, grid.height, exec);
        return;
    }
    const std::vector<LevelCells> levels = level_cells(quads);
    const int finest = levels.front().side, coarsest = levels.back().side;
    const LevelSum sum = finest_sum(levels, natural->u.period(), natural->v.period(), exec);

    const Envelope along_u = envelope_of(finest, level_origin(quads.columns, coarsest), quads.columns,
                                         {grid.first_u, grid.step_u, grid.width}, exec);
    const Envelope along_v = envelope_of(finest, level_origin(quads.rows, coarsest), quads.rows,
                                         {grid.first_v, grid.step_v, grid.height}, exec);
    parallel_blocks(static_cast<std::size_t>(grid.height), 16, exec, [&](std::size_t begin, std::size_t end) {
        const auto width = static_cast<std::size_t>(grid.width);
        std::vector<float> re(width), im(width);
        for (std::size_t y = begin; y < end; ++y) {
            sum.read_row(natural->u.first, grid.width, natural->v.first + static_cast<std::int64_t>(y),
                         re.data(), im.data());
            for (std::size_t x = 0; x < width; ++x) {
                const float e_re = along_u.re[x] * along_v.re[y] - along_u.im[x] * along_v.im[y];
                const float e_im = along_u.re[x] * along_v.im[y] + along_u.im[x] * along_v.re[y];
                const float t_re = re[x], t_im = im[x];
                re[x] = e_re * t_re - e_im * t_im;
                im[x] = e_re * t_im + e_im * t_re;
            }
            put_row(target, static_cast<int>(y), grid.width, re.data(), im.data());
        }
    });
}

}  // namespace obscura
