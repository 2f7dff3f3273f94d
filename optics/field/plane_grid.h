#pragma once
// Places at which a near field is wanted.

namespace obscura {

/// Positions of pixel centres, in texels from the mask's centre: first_x + x step, first_y + y step.
struct PlaneGrid {
    int width = 0, height = 0;
    double first_x = 0, first_y = 0;
    double step = 0;
};

/// `size` pixels over a square of `extent_texels`, centred on the mask.
PlaneGrid centred_plane(int size, double extent_texels);

}  // namespace obscura
