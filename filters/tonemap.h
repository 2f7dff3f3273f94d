#pragma once
// From linear radiance to the pixels of a PNG: exposure, tone curve, sRGB, in one exact step per channel.

#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"
#include "core/vec.h"

namespace obscura {

enum class ToneCurve { linear, filmic };

struct ToneParams {
    double exposure_ev = 0.0;  ///< radiance is scaled by 2^exposure_ev
    ToneCurve curve = ToneCurve::filmic;
};

/// The curve itself, x >= 0 to display light in [0, 1], rising:
///  - linear: min(x, 1);
///  - filmic: K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015:
///    x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14),
///    at most 1. Applied per channel, as film does: very bright saturated colours turn towards white, and
///    their hue towards the nearest primary or secondary.
double tone_curve(ToneCurve curve, double x);

/// One pixel, by definition: codes are those of srgb_encode(tone_curve(curve, scale * x)) to the nearest.
/// Negative and NaN radiance counts as 0.
Rgb8 tonemap(Vec3f radiance, const ToneParams& params);

/// A row of n pixels given as planes; same bits as tonemap().
void tonemap_row(const float* r, const float* g, const float* b, int n, const ToneParams& params, Rgb8* out);

/// A whole picture; same bits as tonemap().
Image<Rgb8> tonemap(ImageView<const Vec3f> radiance, const ToneParams& params, const Exec& exec);

}  // namespace obscura
