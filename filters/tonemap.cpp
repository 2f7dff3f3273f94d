#include "filters/tonemap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/color.h"
#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// The input that a curve maps to y in (0, 1).
double inverse_curve(ToneCurve curve, double y) {
    if (curve == ToneCurve::linear) return y;
    // y (x (2.43 x + 0.59) + 0.14) = x (2.51 x + 0.03): the positive root of a x^2 + b x - c.
    const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = 0.14 * y;
    const double root = std::sqrt(b * b + 4 * a * c);
    return b > 0 ? 2 * c / (b + root) : (root - b) / (2 * a);  // whichever form does not cancel
}

/// Exposed radiance to code: curve and sRGB together are one rising function, so 255 thresholds say it all.
const CodeTable& curve_table(ToneCurve curve) {
    if (curve == ToneCurve::linear) return linear_to_srgb8_table();
    static const CodeTable filmic = [] {
        std::array<float, 256> thresholds{};
        for (std::size_t c = 1; c < 256; ++c) {
            const double display = srgb_decode((static_cast<double>(c) - 0.5) / 255.0);
            thresholds[c] = round_up_to_float(inverse_curve(ToneCurve::filmic, display));
        }
        return CodeTable(thresholds);
    }();
    return filmic;
}

float exposure_scale(const ToneParams& params) {
    return static_cast<float>(num::exp2(params.exposure_ev));
}

}  // namespace

double tone_curve(ToneCurve curve, double x) {
    if (curve == ToneCurve::linear) return std::min(x, 1.0);
    // Beyond 8 the value is above 1 anyway, and an infinite x would give NaN.
    const double bounded = std::min(x, 8.0);
    return std::min(1.0, bounded * (2.51 * bounded + 0.03) / (bounded * (2.43 * bounded + 0.59) + 0.14));
}

Rgb8 tonemap(Vec3f radiance, const ToneParams& params) {
    const CodeTable& table = curve_table(params.curve);
    const float scale = exposure_scale(params);
    return {table(radiance.x * scale), table(radiance.y * scale), table(radiance.z * scale)};
}

void tonemap_row(const float* r, const float* g, const float* b, int n, const ToneParams& params, Rgb8* out) {
    const CodeTable& table = curve_table(params.curve);
    const float scale = exposure_scale(params);
    for (int x = 0; x < n; ++x)
        out[x] = {table(r[x] * scale), table(g[x] * scale), table(b[x] * scale)};
}

Image<Rgb8> tonemap(ImageView<const Vec3f> radiance, const ToneParams& params, const Exec& exec) {
    const CodeTable& table = curve_table(params.curve);
    const float scale = exposure_scale(params);
    Image<Rgb8> out(radiance.width, radiance.height);
    parallel_blocks(
        static_cast<std::size_t>(radiance.height), 16, exec, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                const Vec3f* from = radiance.row(y);
                Rgb8* to = out.row(y);
                for (int x = 0; x < radiance.width; ++x) {
                    to[x] = {table(from[x].x * scale), table(from[x].y * scale), table(from[x].z * scale)};
                }
            }
        });
    return out;
}

}  // namespace obscura
