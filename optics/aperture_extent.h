#pragma once
// How wide an aperture is: what sets how finely its pattern varies.

#include "optics/field/aperture.h"

namespace obscura {

/// Width and height in texels of the rectangle around all open texels; 0 when there are none.
struct OpenExtent {
    int width = 0, height = 0;
};
OpenExtent open_extent(ImageView<const float> mask);

/// Width of the opening as seen along (u, v), times the length of (u, v): the fringes that the power |F|^2
/// can pass between frequency 0 and (u, v). Its Fourier transform, the autocorrelation, ends at the widths.
double fringes_to(ImageView<const float> mask, double u, double v);

/// Integral of the squared transmission in texels^2, which is that of |F|^2 over all frequencies (Parseval).
double transmitted_power(ImageView<const float> mask);

/// Share of a pattern's light that falls past a straight line `frequency` > 0 cycles per texel from its
/// middle, far from it, on the average over the line's directions: borders of length P around an area A send
/// P / (2 pi^3 A frequency) that far, whatever their shape (Porod 1951, for scattering by particles). A grey
/// border counts by how much it changes.
double light_past_line(ImageView<const float> mask, double frequency);

}  // namespace obscura
