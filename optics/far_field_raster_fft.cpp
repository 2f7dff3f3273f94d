// Far field by a plain two-dimensional fast Fourier transform of the raster, times the transform of a texel:
// the method to compare with, and the one for masks that are no sum of few runs (noise, photographs).

#include <algorithm>

#include "core/buffer.h"
#include "core/error.h"
#include "core/parallel.h"
#include "filters/fft.h"
#include "optics/far_field_methods.h"
#include "optics/natural_transform.h"
#include "optics/row_spectra.h"

namespace obscura {
namespace {

/// Spectra of all rows, sixteen columns of frequencies after the other: element
/// (group * height + y) * 16 + lane. Lane 0 of group 0 holds the frequencies 0 and M / 2, both real, as one.
struct RowSpectra {
    Buffer<float> re, im;
};

RowSpectra transform_rows(ImageView<const float> mask, const NaturalTransform& t, const Exec& exec) {
    const int groups = column_groups(t.grid.u);
    const FftPlan& plan = t.u_plan;
    RowSpectra spectra;
    spectra.re.reset(std::size_t{16} * static_cast<std::size_t>(groups) *
                     static_cast<std::size_t>(mask.height));
    spectra.im.reset(spectra.re.size());
    // Thirty-two rows at a time: row 2 l is the real, row 2 l + 1 the imaginary part of lane l.
    constexpr int batch = 32;
    const int items = (mask.height + batch - 1) / batch;
    const int workers = std::min(items, 4 * (exec.threads > 0 ? exec.threads : hardware_threads()));
    parallel_for(static_cast<std::size_t>(workers), exec, [&](std::size_t worker) {
        Buffer<float> re(std::size_t{16} * static_cast<std::size_t>(plan.length())), im(re.size());
        for (int i = static_cast<int>(worker); i < items; i += workers) {
            const int rows = std::min(batch, mask.height - batch * i);
            const MaskRows from{mask.row(batch * i), mask.stride, mask.width, rows};
            OBSCURA_DISPATCH(exec.isa, load_rows16, from, plan.length(), re.data(), im.data());
            fft16_forward(plan, re.data(), im.data(), exec.isa);
            const SpectraTarget to{spectra.re.data(), spectra.im.data(), mask.height, batch * i, rows};
            OBSCURA_DISPATCH(exec.isa, split_rows16, re.data(), im.data(), t.grid.u.log2_period,
                             plan.position.data(), to);
        }
    });
    return spectra;
}

}  // namespace

void far_field_raster_fft(ImageView<const float> mask, const NaturalTransform& transform,
                          const FieldTarget& target, const Exec& exec) {
    const NaturalTransform& t = transform;
    CHECK(mask.width == t.width && mask.height == t.height);
    const RowSpectra spectra = transform_rows(mask, t, exec);
    const int groups = static_cast<int>(t.used_groups.size());
    const int batch = groups_at_once(groups, t.v_plan.length(), exec);
    parallel_for(static_cast<std::size_t>((groups + batch - 1) / batch), exec, [&](std::size_t item) {
        const std::size_t used = std::size_t{16} * static_cast<std::size_t>(mask.height);
        const std::size_t length = std::size_t{16} * static_cast<std::size_t>(t.v_plan.length());
        Buffer<float> re(length * static_cast<std::size_t>(batch)), im(re.size());
        std::vector<SpectrumBlock> blocks;
        const int first = static_cast<int>(item) * batch;
        for (int i = first; i < std::min(first + batch, groups); ++i) {
            const int group = t.used_groups[static_cast<std::size_t>(i)];
            float* group_re = re.data() + length * blocks.size();
            float* group_im = im.data() + length * blocks.size();
            const std::size_t from = used * static_cast<std::size_t>(group);
            std::fill(std::copy_n(spectra.re.data() + from, used, group_re), group_re + length, 0.0f);
            std::fill(std::copy_n(spectra.im.data() + from, used, group_im), group_im + length, 0.0f);
            fft16_forward(t.v_plan, group_re, group_im, exec.isa);
            const std::vector<ColumnStrip>& strips = t.texel_strips[static_cast<std::size_t>(group)].strips;
            blocks.push_back(
                {group_re, group_im, strips.data(), static_cast<int>(strips.size()), nullptr, 0});
        }
        OBSCURA_DISPATCH(exec.isa, store_columns16, blocks.data(), static_cast<int>(blocks.size()), t.rows(),
                         target);
        if (first == 0) store_real_pair(re.data(), im.data(), 1, t.rows(), t.grid.u, t.u_texel, target);
    });
}

void far_field_raster_fft(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
                          const Exec& exec) {
    const auto natural = natural_grid(mask.width, mask.height, grid);
    if (!natural)
        throw InputError("far field", "raster_fft needs a grid whose phases repeat: a step of 1 / 2^k");
    far_field_raster_fft(mask, natural_transform(mask.width, mask.height, *natural), target, exec);
}

}  // namespace obscura
