#include "app/glare/glare_margin.h"

#include <algorithm>
#include <cmath>

#include "app/glare/lens.h"
#include "core/error.h"
#include "core/num.h"
#include "core/sky/air.h"
#include "core/sky/image_sky.h"
#include "core/sky/overcast_sky.h"
#include "optics/aperture_extent.h"

namespace obscura {
namespace {

constexpr double reference_m = 550e-9;
/// Of the clip level: what may be missing at the frame's border (and twice that in its corners).
constexpr double tolerance = 1.0 / 500;
/// Surfaces are as bright as what shines on them; these many clip levels are taken for granted.
constexpr double lit_clips = 4;
/// What a margin m misses is reach times the mean of 1 / d over the way on which it fades (margin_share()),
/// from m / 2 to m: 12 times the integral of s (1 - s) / (2 - s), 18 - 24 ln 2, by 1 / m.
constexpr double fade_factor = 1.3645;
/// Of the shorter side: a picture of 16 : 9 has 1.43 times its pixels then.
constexpr int most_of_side = 8;

/// Pixels beyond which a lens sends all of its light but 1 / pixels of this: light past a line at d is
/// reach / d, as its pattern falls off (light_past_line()). 0 when that is not known.
double reach_px(const OpticsSettings& optics, const RenderSettings& render) {
    if (optics.from_file && optics.mask.pixels.empty()) return 0;  // not read yet
    try {
        const Aperture aperture = lens_aperture(optics);
        const double cycles_per_px = pixel_m(optics, render) / (reference_m * optics.f_number);
        return light_past_line(aperture.mask.view(), cycles_per_px / aperture.mask.width);
    } catch (const InputError&) {
        return 0;  // closed, which is an error of its own where its pattern is asked for
    }
}

float largest(Vec3f v) {
    return std::max({v.x, v.y, v.z});
}

/// Radiance of the brightest that a sky shows: of a clear one the middle of the sun's disc, were there no
/// air.
float brightest_of(const Sky& sky) {
    switch (sky.kind) {
        case SkyKind::gradient:
            return std::max({largest(sky.zenith), largest(sky.horizon), largest(sky.ground)});
        case SkyKind::clear: {
            // The limb is darker, so the middle is up to 1.5 times the mean.
            const double sine = num::sin_deg(sun_radius_deg);
            return static_cast<float>(1.5 * largest(to_float(sky.sun_above_air)) / (num::pi * sine * sine));
        }
        case SkyKind::overcast:
            return largest(
                overcast_sky(sky.sun_elevation_deg, sky.sun_above_air, to_double(sky.ground_albedo)).zenith);
        case SkyKind::image: {
            float most = 0;
            if (sky.image) {
                for (const Vec3f& p : sky.image->pixels.pixels)
                    most = std::max(most, largest(p));
            }
            return most;
        }
    }
    return 0;
}

}  // namespace

int glare_margin(const OpticsSettings& optics, const RenderSettings& render, double brightest_clips) {
    if (!optics.enabled) return 0;
    if (optics.margin_px != auto_glare_margin) return optics.margin_px;
    const int most = std::min(optics.radius_px, std::min(render.width, render.height) / most_of_side);
    // Points out of focus show discs, which may be as large as kernels are.
    if (optics.focus_m > 0) return most;
    // brightest reach (fade_factor / margin - 1 / radius) = tolerance: kernels end at their radius.
    const double light = reach_px(optics, render) * std::max(brightest_clips, lit_clips);
    const double margin = fade_factor / (tolerance / light + 1.0 / optics.radius_px);
    return margin < most ? static_cast<int>(std::ceil(margin)) : most;
}

int glare_margin(const Scene& scene) {
    if (!scene.optics.enabled) return 0;
    float brightest = 0;
    for (const Material& material : scene.materials)
        brightest = std::max(brightest, largest(material.emission));
    if (scene.sky.visible) brightest = std::max(brightest, brightest_of(scene.sky));
    const double clip = glare_params(scene.optics, scene.render).clip;
    return glare_margin(scene.optics, scene.render, static_cast<double>(brightest) / clip);
}

RenderSettings widened(RenderSettings render, int margin_px) {
    render.width += 2 * margin_px;
    render.height += 2 * margin_px;
    return render;
}

float margin_share(double outside_px, int margin_px) {
    const double t = std::clamp(2 - 2 * outside_px / margin_px, 0.0, 1.0);
    return static_cast<float>(t * t * (3 - 2 * t));
}

void dim_margin(int margin_px, ImageView<Vec3f> radiance) {
    if (margin_px == 0) return;
    const auto outside = [&](int at, int size) {
        return std::max({margin_px - (at + 0.5), at + 0.5 - (size - margin_px), 0.0});
    };
    for (int y = 0; y < radiance.height; ++y) {
        Vec3f* row = radiance.row(y);
        const double above = outside(y, radiance.height);
        for (int x = 0; x < radiance.width; ++x) {
            const float share = margin_share(std::max(above, outside(x, radiance.width)), margin_px);
            if (share < 1) row[x] = row[x] * share;
        }
    }
}

}  // namespace obscura
