// Far field by the runs of rows: the first of the two one-dimensional transforms of a Fourier transform is a
// sum over the two ends of every run, whatever its length; the second is a fast Fourier transform over the
// rows.
//
//     sum over x in [a, b) of e^(-2 pi i u x)  =  (e^(-2 pi i u a) - e^(-2 pi i u b)) / (1 - e^(-2 pi i u))
//
// and times the integral over a texel the denominator becomes 2 pi i u. A row of a convex aperture is one
// run, so a column of frequencies costs two table look-ups per row, where a transform of the raster costs
// log2 of its width; what is left is one FFT per column of a quarter of the grid. L. Scandolo's quads
// (thesis, 2019, equation 3.13) use the same closed form in both axes and so pay for every pair of quad and
// pixel.
//
// Symmetry: masks are real, so half of the columns do; when they are the same left and right, sums about the
// middle are real too, and two groups of columns share one complex transform.

#include <algorithm>

#include "core/buffer.h"
#include "core/parallel.h"
#include "filters/fft.h"
#include "optics/far_field_methods.h"
#include "optics/natural_transform.h"
#include "optics/run_sums.h"

namespace obscura {
namespace {

/// What all groups of columns share.
struct RunsOfMask {
    const NaturalTransform& transform;
    RowRuns runs;
    bool mirrored = false;  ///< sums about the middle, real
};

std::size_t root_index(std::int64_t product, int period) {
    return static_cast<std::size_t>(product & (period - 1));
}

/// Memory of one worker.
struct Scratch {
    Buffer<float> base_re, base_im, table_re, table_im, re, im;
    explicit Scratch(const NaturalTransform& t) {
        const auto edges = static_cast<std::size_t>(t.width) + 1;
        base_re.reset(edges);
        base_im.reset(edges);
        table_re.reset(16 * edges);
        table_im.reset(16 * edges);
        re.reset(16 * static_cast<std::size_t>(t.v_plan.length()));
        im.reset(re.size());
    }
};

/// Table of e^(-2 pi i j x / M) for the sixteen columns of a group; its imaginary part alone where that is
/// all that does not cancel.
void fill_table(const RunsOfMask& m, int group, Isa isa, Scratch& s) {
    const NaturalTransform& t = m.transform;
    const int origin = m.mirrored ? t.width / 2 : 0;
    for (int x = 0; x <= t.width; ++x) {
        const std::size_t at = root_index(std::int64_t{x - origin} * 16 * group, t.grid.u.period());
        s.base_re[static_cast<std::size_t>(x)] = t.roots.re[at];
        s.base_im[static_cast<std::size_t>(x)] = t.roots.im[at];
    }
    const PhaseSeeds seeds{t.width + 1, s.base_re.data(), s.base_im.data(),
                           (m.mirrored ? t.mirror_step_re : t.step_re).data(),
                           (m.mirrored ? t.mirror_step_im : t.step_im).data()};
    OBSCURA_DISPATCH(isa, edge_phases16, seeds, m.mirrored ? nullptr : s.table_re.data(), s.table_im.data());
}

/// Sum over the texels of a row (alternating: times (-1)^x), which differences of edges cannot give.
float row_sum(const RowRuns& runs, int y, bool alternating) {
    float sum = 0;
    for (auto r = static_cast<std::size_t>(runs.first[static_cast<std::size_t>(y)]);
         r < static_cast<std::size_t>(runs.first[static_cast<std::size_t>(y) + 1]); ++r) {
        const std::int32_t length = runs.end[r] - runs.begin[r];
        const float weight = runs.weight[r];
        if (!alternating)
            sum += weight * static_cast<float>(length);
        else if (length % 2 != 0)
            sum += runs.begin[r] % 2 == 0 ? weight : -weight;
    }
    return sum;
}

void sum_rows(const RunsOfMask& m, const float* table, Isa isa, Buffer<float>& out) {
    OBSCURA_DISPATCH(isa, run_sums16, m.runs.table(), table, out.data());
    std::fill(out.begin() + 16 * static_cast<std::ptrdiff_t>(m.transform.height), out.end(), 0.0f);
}

/// Sixteen columns of complex sums.
void complex_group(const RunsOfMask& m, int group, Isa isa, Scratch& s, const FieldTarget& target) {
    const NaturalTransform& t = m.transform;
    fill_table(m, group, isa, s);
    sum_rows(m, s.table_re.data(), isa, s.re);
    sum_rows(m, s.table_im.data(), isa, s.im);
    for (int y = 0; group == 0 && y < t.height; ++y) {
        s.re[16 * static_cast<std::size_t>(y)] = row_sum(m.runs, y, false);
        s.im[16 * static_cast<std::size_t>(y)] = row_sum(m.runs, y, true);
    }
    fft16_forward(t.v_plan, s.re.data(), s.im.data(), isa);
    const std::vector<ColumnStrip>& strips = t.edge_strips[static_cast<std::size_t>(group)].strips;
    OBSCURA_DISPATCH(isa, store_columns16, s.re.data(), s.im.data(), t.rows(), strips.data(),
                     static_cast<int>(strips.size()), target);
    if (group == 0) store_real_pair(s.re.data(), s.im.data(), t.rows(), t.grid.u, t.u_texel, target);
}

/// Two times sixteen columns of real sums.
void mirrored_pair(const RunsOfMask& m, int group, Isa isa, Scratch& s, const FieldTarget& target) {
    const NaturalTransform& t = m.transform;
    const bool partner = group + 1 < column_groups(t.grid.u);
    fill_table(m, group, isa, s);
    sum_rows(m, s.table_im.data(), isa, s.re);
    for (int y = 0; group == 0 && y < t.height; ++y)
        s.re[16 * static_cast<std::size_t>(y)] = row_sum(m.runs, y, false);
    if (partner) {
        fill_table(m, group + 1, isa, s);
        sum_rows(m, s.table_im.data(), isa, s.im);
    } else {
        std::fill(s.im.begin(), s.im.end(), 0.0f);
    }
    fft16_forward(t.v_plan, s.re.data(), s.im.data(), isa);
    const auto own = static_cast<std::size_t>(group);
    const std::vector<ColumnStrip>& strips = t.mirror_strips[own].strips;
    const std::vector<ColumnStrip>* others = partner ? &t.mirror_strips[own + 1].strips : nullptr;
    OBSCURA_DISPATCH(isa, store_real_columns16, s.re.data(), s.im.data(), t.rows(), strips.data(),
                     static_cast<int>(strips.size()), partner ? others->data() : nullptr,
                     partner ? static_cast<int>(others->size()) : 0, target);
}

}  // namespace

void far_field_runs(ImageView<const float> mask, const NaturalTransform& transform, const FieldTarget& target,
                    const Exec& exec) {
    CHECK(mask.width == transform.width && mask.height == transform.height);
    const NaturalAxis& u = transform.grid.u;
    const bool mirrored = mask.width % 2 == 0 && u.log2_period > 0 && mask_symmetry(mask).left_right;
    const RunsOfMask m{transform, row_runs(mask), mirrored};
    const int groups = column_groups(u);
    const int items = mirrored ? (groups + 1) / 2 : groups;
    // A few items share one worker's memory; which ones does not matter to the result.
    const int workers = std::min(items, 4 * (exec.threads > 0 ? exec.threads : hardware_threads()));
    parallel_for(static_cast<std::size_t>(workers), exec, [&](std::size_t worker) {
        Scratch scratch(transform);
        for (int i = static_cast<int>(worker); i < items; i += workers) {
            if (mirrored)
                mirrored_pair(m, 2 * i, exec.isa, scratch, target);
            else
                complex_group(m, i, exec.isa, scratch, target);
        }
    });
    if (mirrored) clear_half_period(u, transform.grid.v.count, target);
}

void far_field_runs(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
                    const Exec& exec) {
    const auto natural = natural_grid(mask.width, mask.height, grid);
    CHECK(natural.has_value());
    far_field_runs(mask, natural_transform(mask.width, mask.height, *natural), target, exec);
}

}  // namespace obscura
