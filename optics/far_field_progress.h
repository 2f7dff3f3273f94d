#pragma once
// The far field of an aperture that changes from frame to frame: the difference is added, as long as that is
// exact enough and cheaper than starting anew.

#include <cstdint>
#include <string>

#include "core/isa.h"
#include "optics/far_field.h"
#include "optics/field/field.h"

namespace obscura {

/// What is kept between frames. Set grid and tolerance, leave the rest to update_far_field().
struct FarFieldProgress {
    FrequencyGrid grid;
    /// Error of the amplitudes, as a share of the open area, from which on the field is computed anew; a
    /// fresh field counts as 1e-6.
    double tolerance = 3e-6;

    // Of the field below; empty before the first update.
    Image<float> mask;
    FrequencyGrid field_grid;
    Field field;
    double error_bound = 0;  ///< of the field's amplitudes, in texels^2
    double refresh_ms = 0;   ///< what the planner expected of the last computation, one thread
};

struct ProgressReport {
    bool refreshed = false;                ///< else the difference was added
    std::string reason;                    ///< one line: which, and why
    std::int64_t terms = 0;                ///< distinct columns (or rows) of the difference
    double update_ms = 0, refresh_ms = 0;  ///< what either costs by the model, one thread
    double error_bound = 0;                ///< share of the open area, after the update
};

/// Brings progress.field to the field of `mask`. A mask of another size, or another grid, starts anew. After
/// a refresh the bits are those of far_field_into() with default parameters.
ProgressReport update_far_field(FarFieldProgress& progress, ImageView<const float> mask, const Exec& exec);

}  // namespace obscura
