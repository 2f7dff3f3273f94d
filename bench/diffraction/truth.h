#pragma once
// Far and near fields by their definitions, in double, texel by texel with libm; and how far others are off.

#include <complex>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/field.h"
#include "optics/near_field.h"

namespace obscura {

/// Some indices of an axis; each stands for `weight` of them.
struct SampledAxis {
    std::vector<int> indices;
    std::vector<double> weights;
    std::size_t size() const { return indices.size(); }
};

/// All of `count` indices, or about `most` of them: those around `middle`, and others in odd steps.
SampledAxis sampled_axis(int count, int middle, int most);

/// A field at some columns and rows of a grid; element [j * columns.size() + i] is that at columns i, rows j.
struct TrueField {
    SampledAxis columns, rows;
    std::vector<std::complex<double>> values;
    double unit = 1;  ///< amplitude that errors are shares of
};

/// unit = the open area. About most_columns x most_rows pixels.
TrueField true_far_field(ImageView<const float> mask, const FrequencyGrid& grid, int most_columns,
                         int most_rows, const Exec& exec);

/// unit = 1, the unobstructed wave. `turns`: pitch^2 / (2 lambda z).
TrueField true_near_field(ImageView<const float> mask, const PlaneGrid& grid, double turns, int most,
                          const Exec& exec);

struct FieldError {
    double amplitude = 0;  ///< the largest, as a share of the unit
    /// Of log10(power / unit^2), never below 1e-10, over ten decades: 20 log10(10 / root mean square error).
    double log_psnr_db = 0;
};
/// Infinite amplitude error where a value is not finite.
FieldError error_of(const Field& field, const TrueField& truth);
/// Of magnitudes, for methods that give powers only.
FieldError error_of(const Image<float>& power, const TrueField& truth);

}  // namespace obscura
