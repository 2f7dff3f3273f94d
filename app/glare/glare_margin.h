#pragma once
// How much wider than the frame the picture is rendered that glare is computed on.

#include "app/scene/scene.h"
#include "core/image.h"

namespace obscura {

/// Pixels on every side. "auto": as many as it takes for what lies farther away to add less than a 500th of
/// the clip level to any pixel of the frame, were all of it as bright as the brightest that the scene shows
/// by itself (`brightest_clips`, in clip levels; surfaces in light count as 4); less than the kernel's
/// radius, and an eighth of the picture's shorter side at most. 0 without a lens.
int glare_margin(const OpticsSettings& optics, const RenderSettings& render, double brightest_clips);
int glare_margin(const Scene& scene);

/// The picture with so many pixels more on every side, for estimates of what it takes.
RenderSettings widened(RenderSettings render, int margin_px);

/// How much of its light a pixel whose middle is `outside_px` beyond the frame gives to the glare: all of it
/// in the inner half of the margin, then less, 3 t^2 - 2 t^3 of the way t to its end. A lamp that leaves the
/// picture loses its glare over that way, at most 3 / margin of it per pixel, and not at once.
float margin_share(double outside_px, int margin_px);

/// Dims the margin of a wide picture by it.
void dim_margin(int margin_px, ImageView<Vec3f> radiance);

}  // namespace obscura
