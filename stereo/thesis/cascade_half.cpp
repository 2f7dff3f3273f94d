// Jacobi sweeps on maps of 16-bit floats, as the paper keeps them (section 4.3.5): three rows are widened,
// swept and narrowed again.

#include "core/parallel.h"
#include "stereo/solver/grid_rows.h"
#include "stereo/thesis/cascade.h"
#include "stereo/thesis/half_rows.h"

namespace obscura {
namespace {

constexpr std::size_t rows_per_task = 32;

/// A map of 16-bit floats; rows are as long as the row loops want.
struct HalfMap {
    Image<std::uint16_t> values;
    HalfMap(int width, int height) : values(row_count(width), height) {}
};

void put(HalfMap& map, int x, int y, float value) {
    alignas(64) const float wide[16] = {value};
    alignas(64) std::uint16_t half[16];
    ref::half_row(wide, 16, half);
    map.values(x, y) = half[0];
}

float get(const HalfMap& map, int x, int y) {
    alignas(64) const std::uint16_t half[16] = {map.values(x, y)};
    alignas(64) float wide[16];
    ref::float_row(half, 16, wide);
    return wide[0];
}

void sweep_rows(const DisparitySystem& s, const JacobiForm& form, const HalfMap& before, int y0, int y1,
                const Exec& exec, HalfMap& after) {
    RowRing rows(s.width(), 3);
    GridPlane out(s.width(), 1);
    const GridPlane zeros(s.width(), 1);
    const int count = form.relax.count();
    const RowEdges edges{2 * s.gradient_weight, nullptr, nullptr, nullptr};
    const auto widen = [&](int y) {
        if (y >= 0 && y < s.height())
            OBSCURA_DISPATCH(exec.isa, float_row, before.values.row(y), count, rows.row(y));
    };
    const auto row = [&](int y) { return y < 0 || y >= s.height() ? zeros.row(0) : rows.row(y); };
    widen(y0 - 1);
    widen(y0);
    for (int y = y0; y < y1; ++y) {
        widen(y + 1);
        LaneSums sums;
        OBSCURA_DISPATCH(exec.isa, smooth_row, form.b.row(y), RowTriple{row(y - 1), row(y), row(y + 1)},
                         edges, form.relax.row(y), 0.0f, count, out.row(0), sums);
        OBSCURA_DISPATCH(exec.isa, half_row, out.row(0), count, after.values.row(y));
    }
}

void add_sets(const DisparitySystem& s, const JacobiForm& form, const HalfMap& before, HalfMap& after) {
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        const float source = get(before, set.source_x, set.source_y);
        double pull = 0;
        for (const MatchedPixel& p : set.members) {
            if (s.valid(p.x, p.y) == 0 || (p.x == set.source_x && p.y == set.source_y)) continue;
            put(after, p.x, p.y, get(after, p.x, p.y) + form.relax.row(p.y)[p.x] * (set.weight * source));
            pull += static_cast<double>(get(before, p.x, p.y));
        }
        const float step = form.relax.row(set.source_y)[set.source_x] *
                           static_cast<float>(static_cast<double>(set.weight) * pull);
        put(after, set.source_x, set.source_y, get(after, set.source_x, set.source_y) + step);
    }
}

}  // namespace

DisparityMap jacobi_sweeps_half(const DisparitySystem& s, DisparityMap x, int sweeps, const Exec& exec) {
    const JacobiForm form = jacobi_form(s, exec);
    HalfMap maps[2] = {HalfMap(s.width(), s.height()), HalfMap(s.width(), s.height())};
    for (int y = 0; y < s.height(); ++y) {
        for (int i = 0; i < s.width(); ++i)
            put(maps[0], i, y, s.valid(i, y) != 0 ? x(i, y) : 0.0f);
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const HalfMap& before = maps[sweep % 2];
        HalfMap& after = maps[1 - sweep % 2];
        parallel_blocks(static_cast<std::size_t>(s.height()), rows_per_task, exec,
                        [&](std::size_t begin, std::size_t end) {
                            sweep_rows(s, form, before, static_cast<int>(begin), static_cast<int>(end), exec,
                                       after);
                        });
        add_sets(s, form, before, after);
    }
    for (int y = 0; y < s.height(); ++y) {
        for (int i = 0; i < s.width(); ++i)
            x(i, y) = s.valid(i, y) != 0 ? get(maps[sweeps % 2], i, y) : s.start(i, y);
    }
    return x;
}

}  // namespace obscura
