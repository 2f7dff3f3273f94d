#pragma once
// The opening that light passes: a mask of texels and, where the shape is known, its exact outline.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace obscura {

/// Closed loops in texels of the mask (x right, y down, the mask's upper left corner at 0, 0). A point is
/// open where its winding number is positive; loops that turn the same way as x towards y count +1.
struct Outline {
    std::vector<std::vector<Vec2d>> loops;
    /// True when the loops are simple and do not cross, so that the signed sum of their Fourier transforms
    /// is that of the opening.
    bool disjoint = false;
};

struct Aperture {
    /// Amplitude that each texel lets through, in [0, 1]; row 0 is the top row. Coordinates of diffraction
    /// patterns have their origin at the mask's centre, (width / 2, height / 2) texels.
    Image<float> mask;
    double pitch_m = 0;  ///< side of a (square) texel
    Outline outline;     ///< empty when only the mask is known
};

/// Sum of the mask in texels: the far field at frequency 0.
double open_area(ImageView<const float> mask);

/// 2^levels x 2^levels texels become one (their mean; texels outside the mask are 0), pitch and outline with
/// them. With `binary`, means of at least 0.5 become 1, others 0: the finest level of a quadtree.
Aperture reduce(const Aperture& aperture, int levels, bool binary);

/// Mirror symmetry of the mask, bit for bit: left_right is f(x, y) = f(width - 1 - x, y).
struct MaskSymmetry {
    bool left_right = false, top_bottom = false;
};
MaskSymmetry mask_symmetry(ImageView<const float> mask);

}  // namespace obscura
