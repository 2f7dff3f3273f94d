#pragma once
// Convolution of columns with the chirp, each texel integrated: sixteen columns at a time, by FFT.

#include <vector>

#include "core/buffer.h"
#include "filters/fft.h"
#include "optics/column_products.h"
#include "optics/field/fresnel.h"
#include "optics/field/near_field_axis.h"

namespace obscura {

/// Sixteen columns while they are convolved: element k of lane l at 16 k + l.
struct ColumnScratch {
    explicit ColumnScratch(int length)
        : re(16 * static_cast<std::size_t>(length)),
          im(16 * static_cast<std::size_t>(length)),
          product_re(16 * static_cast<std::size_t>(length)),
          product_im(16 * static_cast<std::size_t>(length)) {}
    Buffer<float> re, im, product_re, product_im;
};

/// Columns of pixels that are finished together. A transform yields columns, pictures are rows: sixteen
/// pixels of every row would touch each of its pages and, where rows are not aligned, each line of the caches
/// twice. So columns gather here and leave as pieces of rows.
class ColumnTile {
  public:
    static constexpr int columns = 64;
    /// Holds what `target` asks for.
    ColumnTile(int rows, const FieldTarget& target);
    FieldTarget target();
    /// Columns [0, width) to column x of the target, and mirrored to mirror_x, mirror_x - 1, ... unless that
    /// is below 0.
    void copy_to(const FieldTarget& target, std::ptrdiff_t x, int width, std::ptrdiff_t mirror_x) const;

  private:
    int rows_;
    Buffer<float> re_, im_, power_;
};

/// Linear convolution of texels with K(d) = E(lower edge of the texel) - E(upper edge) at d from texel to
/// pixel. The kernel is exact for texels, however fast the chirp turns within one, and reaches no farther
/// than the pixels do: twice the texels is all the padding there is. Pixels q to a texel are q kernels: one
/// forward and q backward transforms, not a longer one.
class ColumnConvolution {
  public:
    /// 0 when the axis is none for this: step no ratio, or transforms beyond 2^16.
    static int transform_length(const PlaneAxis& axis);
    /// Kernels are multiplied by `factor`. transform_length(axis) > 0.
    ColumnConvolution(const PlaneAxis& axis, double turns, FresnelValue factor, Isa isa);
    int length() const { return plan_.length(); }
    int kernels() const { return static_cast<int>(kernels_.size()); }
    /// scratch.re and im hold axis.texels elements; all pixels go to the target's rows, sixteen columns from
    /// x on.
    void run(ColumnScratch& scratch, std::ptrdiff_t x, const FieldTarget& target, Isa isa) const;

  private:
    struct Kernel {
        RowStore rows;  ///< where its elements go
        std::vector<float> re, im;
    };
    PlaneAxis axis_;
    FftPlan plan_;
    std::vector<Kernel> kernels_;
};

}  // namespace obscura
