#include "optics/near_field_convolve.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/error.h"

namespace obscura {
namespace {

/// Texels that the pixels span, counted from the texel of the first to that of the last.
std::int64_t span_of(const PlaneAxis& axis, StepRatio ratio) {
    return std::int64_t{axis.pixels - 1} * ratio.p / ratio.q + 1;
}

int log2_of(const PlaneAxis& axis, StepRatio ratio) {
    int log2_length = 0;
    while ((std::int64_t{1} << log2_length) < axis.texels + span_of(axis, ratio) - 1)
        ++log2_length;
    return log2_length;
}

/// K(d) for d = 1 - texels to span - 1, from a pixel `part` of a texel beyond the first pixel's place in its
/// texel.
std::vector<FresnelValue> texel_kernel(const PlaneAxis& axis, double turns, StepRatio ratio, int part) {
    const double origin = 0.5 * axis.texels + axis.first, unit = 1.0 / ratio.q;
    const auto upper_edge = [&](std::int64_t d) {
        return static_cast<double>(-(ratio.q * d + part)) * unit - origin;
    };
    const std::int64_t lowest = 1 - axis.texels, beyond = span_of(axis, ratio);
    std::vector<FresnelValue> kernel;
    kernel.reserve(static_cast<std::size_t>(beyond - lowest));
    const bool narrow = is_narrow(axis, turns);
    FresnelValue lower = narrow ? FresnelValue{} : fresnel_at(turns, upper_edge(lowest - 1));
    for (std::int64_t d = lowest; d < beyond; ++d) {
        if (narrow) {
            kernel.push_back(fresnel_between(turns, upper_edge(d), 1));
            continue;
        }
        const FresnelValue upper = fresnel_at(turns, upper_edge(d));
        kernel.push_back({lower.c - upper.c, lower.s - upper.s});
        lower = upper;
    }
    return kernel;
}

void copy_plane(const float* from, float* to, std::ptrdiff_t stride, int rows, std::ptrdiff_t x, int width,
                std::ptrdiff_t mirror_x) {
    if (to == nullptr) return;
    for (int y = 0; y < rows; ++y) {
        const float* row = from + std::ptrdiff_t{ColumnTile::columns} * y;
        std::memcpy(to + stride * y + x, row, static_cast<std::size_t>(width) * sizeof(float));
        if (mirror_x >= 0) std::reverse_copy(row, row + width, to + stride * y + mirror_x + 1 - width);
    }
}

}  // namespace

ColumnTile::ColumnTile(int rows, const FieldTarget& target) : rows_(rows) {
    const std::size_t size = static_cast<std::size_t>(rows) * columns;
    if (target.re != nullptr) re_.reset(size);
    if (target.im != nullptr) im_.reset(size);
    if (target.power != nullptr) power_.reset(size);
}

FieldTarget ColumnTile::target() {
    return {re_.data(), im_.data(), power_.data(), columns};
}

void ColumnTile::copy_to(const FieldTarget& target, std::ptrdiff_t x, int width,
                         std::ptrdiff_t mirror_x) const {
    copy_plane(re_.data(), target.re, target.stride, rows_, x, width, mirror_x);
    copy_plane(im_.data(), target.im, target.stride, rows_, x, width, mirror_x);
    copy_plane(power_.data(), target.power, target.stride, rows_, x, width, mirror_x);
}

int ColumnConvolution::transform_length(const PlaneAxis& axis) {
    const std::optional<StepRatio> ratio = step_ratio(axis.step);
    if (!ratio || axis.texels + span_of(axis, *ratio) - 1 > 65536) return 0;
    return 1 << log2_of(axis, *ratio);
}

ColumnConvolution::ColumnConvolution(const PlaneAxis& axis, double turns, FresnelValue factor, Isa isa)
    : axis_(axis) {
    CHECK(transform_length(axis) > 0);
    const StepRatio ratio = *step_ratio(axis.step);
    plan_ = fft_plan(log2_of(axis, ratio));
    const auto length = static_cast<std::size_t>(plan_.length());
    ColumnScratch lanes(plan_.length());
    std::fill(lanes.re.begin(), lanes.re.end(), 0.0f);
    std::fill(lanes.im.begin(), lanes.im.end(), 0.0f);
    // Pixel i stands i p / q texels from the first: pixels i, i + q, i + 2 q, ... share a kernel and stand p
    // texels apart. Kernels are lanes of one transform.
    const double scale = 1.0 / plan_.length();
    kernels_.resize(static_cast<std::size_t>(std::min(ratio.q, axis.pixels)));
    for (int i = 0; i < kernels(); ++i) {
        Kernel& kernel = kernels_[static_cast<std::size_t>(i)];
        kernel.rows.first_element = i * ratio.p / ratio.q;
        kernel.rows.element_step = ratio.p;
        kernel.rows.first_row = i;
        kernel.rows.row_step = ratio.q;
        kernel.rows.count = (axis.pixels - i + ratio.q - 1) / ratio.q;
        const std::vector<FresnelValue> values = texel_kernel(axis, turns, ratio, i * ratio.p % ratio.q);
        for (std::size_t k = 0; k < values.size(); ++k) {
            // Negative distances wrap around to the end.
            const std::size_t at = (k + length + 1 - static_cast<std::size_t>(axis.texels)) % length;
            const FresnelValue v = values[k];
            lanes.re[16 * at + static_cast<std::size_t>(i)] =
                static_cast<float>((v.c * factor.c - v.s * factor.s) * scale);
            lanes.im[16 * at + static_cast<std::size_t>(i)] =
                static_cast<float>((v.c * factor.s + v.s * factor.c) * scale);
        }
    }
    fft16_forward(plan_, lanes.re.data(), lanes.im.data(), isa);
    for (std::size_t i = 0; i < kernels_.size(); ++i) {
        for (std::size_t k = 0; k < length; ++k) {
            kernels_[i].re.push_back(lanes.re[16 * k + i]);
            kernels_[i].im.push_back(lanes.im[16 * k + i]);
        }
    }
}

void ColumnConvolution::run(ColumnScratch& scratch, std::ptrdiff_t x, const FieldTarget& target,
                            Isa isa) const {
    const std::ptrdiff_t filled = 16 * static_cast<std::ptrdiff_t>(axis_.texels);
    std::fill(scratch.re.begin() + filled, scratch.re.end(), 0.0f);
    std::fill(scratch.im.begin() + filled, scratch.im.end(), 0.0f);
    fft16_forward(plan_, scratch.re.data(), scratch.im.data(), isa);
    for (const Kernel& kernel : kernels_) {
        float *re = scratch.product_re.data(), *im = scratch.product_im.data();
        OBSCURA_DISPATCH(isa, multiply16, scratch.re.data(), scratch.im.data(), kernel.re.data(),
                         kernel.im.data(), plan_.length(), re, im);
        fft16_backward(plan_, re, im, isa);
        RowStore rows = kernel.rows;
        rows.x = x;
        OBSCURA_DISPATCH(isa, store_rows16, re, im, rows, target);
    }
}

}  // namespace obscura
