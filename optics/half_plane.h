#pragma once
// Mirror images of far fields: F(-u, -v) is the conjugate of F(u, v), since masks are real; and of a mask
// that is the same left and right or top and bottom, F(u, -v) is the conjugate of F(u, v), or F(u, v) itself.

#include <optional>

#include "core/isa.h"
#include "optics/far_field.h"

namespace obscura {

/// The part of a grid that is computed, and how the rest follows.
struct HalfPlane {
    FrequencyGrid grid;  ///< columns u >= 0; all rows, or those with v >= 0; one more of either where the
                         ///< grid's first sample has no opposite
    int centre_x = 0, centre_y = 0;  ///< pixel of the whole grid where u = v = 0
    bool quarter = false;            ///< only rows v >= 0
    bool top_bottom = false;         ///< F(u, -v) = F(u, v); else, in a quarter, its conjugate
};

/// Nothing when the grid is not centred on frequency 0, or when mirroring would cost more than it saves.
std::optional<HalfPlane> half_plane(const Aperture& aperture, const FrequencyGrid& grid,
                                    const FarFieldParams& params);

/// Copies the part and its mirror images into the whole; conjugate_sign is what a channel is multiplied by in
/// conjugates: 1 for real parts and powers, -1 for imaginary parts.
void unfold(const HalfPlane& half, ImageView<const float> part, float conjugate_sign, Image<float>& whole,
            const Exec& exec);

}  // namespace obscura
