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
#include <cmath>
#include <optional>

#include "core/buffer.h"
#include "core/parallel.h"
#include "filters/fft.h"
#include "optics/far_field_chirp.h"
#include "optics/far_field_methods.h"
#include "optics/field/row_runs.h"
#include "optics/low_columns.h"
#include "optics/natural_transform.h"
#include "optics/run_sums.h"

namespace obscura {
namespace {

/// What all groups of columns share.
struct RunsOfMask {
    const NaturalTransform& transform;
    const RowRuns& runs;
    bool mirrored = false;        ///< sums about the middle, real
    float alternating_scale = 1;  ///< see alternating_scale_of()
};

std::size_t root_index(std::int64_t product, int period) {
    return static_cast<std::size_t>(product & (period - 1));
}

/// Memory of one worker: tables of one group, spectra of several.
struct Scratch {
    Buffer<float> base_re, base_im, table_re, table_im, re, im;
    Scratch(const NaturalTransform& t, int groups) {
        const auto edges = static_cast<std::size_t>(t.width) + 1;
        base_re.reset(edges);
        base_im.reset(edges);
        table_re.reset(16 * edges);
        table_im.reset(16 * edges);
        re.reset(16 * static_cast<std::size_t>(t.v_plan.length()) * static_cast<std::size_t>(groups));
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

/// Sum over the texels of a row, each times (-1)^x: the column of half a cycle per texel.
float alternating_sum(const RowRuns& runs, int y) {
    double sum = 0;  // thousands of equal terms would all round the same way in float
    for (auto r = static_cast<std::size_t>(runs.first[static_cast<std::size_t>(y)]);
         r < static_cast<std::size_t>(runs.first[static_cast<std::size_t>(y) + 1]); ++r) {
        const std::int32_t length = runs.end[r] - runs.begin[r];
        const double weight = static_cast<double>(runs.weight[r]);
        if (length % 2 != 0) sum += runs.begin[r] % 2 == 0 ? weight : -weight;
    }
    return static_cast<float>(sum);
}

/// The power of two that brings the alternating sums of all rows to 1 at most, as what they share a transform
/// with: they are small for most masks, as large as rows are long for gratings of one texel.
float alternating_scale_of(const RowRuns& runs, int height) {
    float most = 0, scale = 1;
    for (int y = 0; y < height; ++y)
        most = std::max(most, std::fabs(alternating_sum(runs, y)));
    while (most * scale > 1)
        scale /= 2;
    return scale;
}

void sum_rows(const RunsOfMask& m, const float* table, Isa isa, float* out) {
    OBSCURA_DISPATCH(isa, run_sums16, m.runs.table(), table, out);
    std::fill(out + 16 * m.transform.height, out + 16 * m.transform.v_plan.length(), 0.0f);
}

/// Spectra of sixteen columns of complex sums.
SpectrumBlock complex_group(const RunsOfMask& m, int group, Isa isa, Scratch& s, float* re, float* im) {
    const NaturalTransform& t = m.transform;
    fill_table(m, group, isa, s);
    sum_rows(m, s.table_re.data(), isa, re);
    sum_rows(m, s.table_im.data(), isa, im);
    for (int y = 0; group == 0 && y < t.height; ++y) {
        re[16 * y] = 0;  // see write_low_columns()
        im[16 * y] = alternating_sum(m.runs, y) * m.alternating_scale;
    }
    fft16_forward(t.v_plan, re, im, isa);
    const std::vector<ColumnStrip>& strips = t.edge_strips[static_cast<std::size_t>(group)].strips;
    return {re, im, strips.data(), static_cast<int>(strips.size()), nullptr, 0};
}

/// Spectra of two times sixteen columns of real sums.
SpectrumBlock mirrored_pair(const RunsOfMask& m, int group, std::optional<int> partner, Isa isa, Scratch& s,
                            float* re, float* im) {
    const NaturalTransform& t = m.transform;
    fill_table(m, group, isa, s);
    sum_rows(m, s.table_im.data(), isa, re);
    if (partner) {
        fill_table(m, *partner, isa, s);
        sum_rows(m, s.table_im.data(), isa, im);
    } else {
        std::fill_n(im, 16 * t.v_plan.length(), 0.0f);
    }
    fft16_forward(t.v_plan, re, im, isa);
    const auto own = static_cast<std::size_t>(group);
    const std::vector<ColumnStrip>& strips = t.mirror_strips[own].strips;
    SpectrumBlock block{re, im, strips.data(), static_cast<int>(strips.size()), nullptr, 0};
    if (partner) {
        const std::vector<ColumnStrip>& others = t.mirror_strips[static_cast<std::size_t>(*partner)].strips;
        block.partner_strips = others.data();
        block.partner_count = static_cast<int>(others.size());
    }
    return block;
}

/// Groups (or pairs) first to last - 1: transformed one by one, written together.
void column_batch(const RunsOfMask& m, int first, int last, Isa isa, Scratch& s, const FieldTarget& target) {
    const NaturalTransform& t = m.transform;
    const std::vector<int>& groups = t.used_groups;
    std::vector<SpectrumBlock> blocks;
    for (int i = first; i < last; ++i) {
        const std::ptrdiff_t at = std::ptrdiff_t{16} * t.v_plan.length() * (i - first);
        float *re = s.re.data() + at, *im = s.im.data() + at;
        const std::size_t item = static_cast<std::size_t>(i), pair = 2 * item;
        if (m.mirrored) {
            const auto partner = pair + 1 < groups.size() ? std::optional(groups[pair + 1]) : std::nullopt;
            blocks.push_back(mirrored_pair(m, groups[pair], partner, isa, s, re, im));
        } else {
            blocks.push_back(complex_group(m, groups[item], isa, s, re, im));
        }
    }
    const int count = static_cast<int>(blocks.size());
    if (m.mirrored) {
        OBSCURA_DISPATCH(isa, store_real_columns16, blocks.data(), count, t.rows(), target);
    } else {
        OBSCURA_DISPATCH(isa, store_columns16, blocks.data(), count, t.rows(), target);
        if (first == 0)
            store_real_pair(blocks[0].re, blocks[0].im, m.alternating_scale, t.rows(), t.grid.u, t.u_texel,
                            target);
    }
    if (first == 0) write_low_columns(m.runs, m.mirrored, t, target);
}

}  // namespace

void far_field_runs(ImageView<const float> mask, const RowRuns& runs, const NaturalTransform& transform,
                    const FieldTarget& target, const Exec& exec) {
    CHECK(mask.width == transform.width && mask.height == transform.height);
    const NaturalAxis& u = transform.grid.u;
    RunsOfMask m{transform, runs};
    m.mirrored = mask.width % 2 == 0 && u.log2_period > 0 && same_left_and_right(m.runs, mask.width);
    if (!m.mirrored) m.alternating_scale = alternating_scale_of(m.runs, mask.height);
    const int groups = static_cast<int>(transform.used_groups.size());
    const int items = m.mirrored ? (groups + 1) / 2 : groups;
    const int batch = groups_at_once(items, transform.v_plan.length(), exec);
    parallel_for(static_cast<std::size_t>((items + batch - 1) / batch), exec, [&](std::size_t b) {
        Scratch scratch(transform, batch);
        const int first = static_cast<int>(b) * batch;
        column_batch(m, first, std::min(first + batch, items), exec.isa, scratch, target);
    });
    if (m.mirrored) clear_half_period(u, transform.grid.v.count, target);
}

void far_field_runs(ImageView<const float> mask, const RowRuns& runs, const FrequencyGrid& grid,
                    const FieldTarget& target, const Exec& exec) {
    const auto natural = natural_grid(mask.width, mask.height, grid);
    if (natural && natural_is_cheaper(*natural, mask.height, grid))
        far_field_runs(mask, runs, natural_transform(mask.width, mask.height, *natural), target, exec);
    else
        far_field_chirp(mask, runs, grid, target, exec);
}

}  // namespace obscura
