#pragma once
// Where ground meets sky: for penumbrae, which a bit per sample does not tell, and skylight.

#include "core/image.h"
#include "core/isa.h"
#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"

namespace obscura {

/// For every sample the tangent of the elevation of the ground's horizon in the sun's direction, of which
/// only the azimuth counts: a sun is hidden where its own tangent is less. Minus infinity where the ray
/// leaves the grid at once. In doubles, rounded to float; time grows with the length of the rays.
Image<float> horizon_tangents(const HeightField& field, const HeightSun& sun, const Exec& exec);

/// Share in [0, 1] of a uniform disc, of angular radius radius_deg > 0 and its middle at elevation_deg, above
/// a level horizon at horizon_deg: with x = (horizon - middle) / radius, (acos x - x sqrt(1 - x^2)) / pi.
double lit_share_of_disc(double elevation_deg, double horizon_deg, double radius_deg);

}  // namespace obscura
