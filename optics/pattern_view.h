#pragma once
// Patterns as pictures: diffraction spans ten decades and more, screens two.

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"
#include "core/vec.h"

namespace obscura {

struct PatternView {
    /// false: linear light, everything above `white` clips. true: equal steps of shade per decade.
    bool logarithmic = false;
    /// Power (or luminance) shown as white; 0: the pattern's largest. Smaller values over-expose, as cameras
    /// do.
    double white = 0;
    /// Logarithmic: decades below white that the shades span; white * 10^-decades and less is black. [0.1,
    /// 40]
    double decades = 6;
};

/// Greys. Linear: the sRGB code of power / white. Logarithmic: code 255 (1 + log10(power / white) / decades),
/// evenly rounded.
Image<Rgb8> view_power(ImageView<const float> power, const PatternView& view, const Exec& exec);

/// Colours (linear sRGB, channels may be negative): their luminance is shown as greys are. Colours outside
/// the gamut, and those too bright for their hue, move towards the grey of their luminance. In linear views
/// only what is brighter than white clips, to white.
Image<Rgb8> view_colour(ImageView<const Vec3f> colour, const PatternView& view, const Exec& exec);

}  // namespace obscura
