#pragma once
// Panels of lesson 22: the sky from below, and the directions that stand for it.

#include <functional>
#include <span>
#include <string>

#include "core/sky/sky_directions.h"
#include "lessons/drawing/figure.h"

namespace obscura {

/// Where a direction of the upper hemisphere stands on a disc of equal solid angles (J. Lambert 1772): the
/// zenith in the middle, x to the right, -z upwards, as a map of the sky seen from above.
Vec2d on_sky_disc(const Box& box, Vec3d direction);

/// Every pixel of the disc in the colour of its direction; beside it, the panel.
void draw_sky_disc(Figure& f, const Box& box, const std::function<Rgb8(Vec3d)>& color);

/// Directions as dots: those that arrive filled, others as rings.
void draw_suns(Figure& f, const Box& box, std::span<const SkyDirection> suns,
               const std::function<bool(std::size_t)>& arrives, double radius, Rgb8 color);

/// Axes of a share of light across a street, from 0 on.
void draw_share_axes(Figure& f, const Plot& plot);

/// A field of colour with a name and a line below it.
void draw_swatch(Figure& f, const Box& box, Rgb8 color, const std::string& name, const std::string& says);

}  // namespace obscura
