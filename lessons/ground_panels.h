#pragma once
// The ground of lessons 26 and 27, and how it is drawn.

#include <functional>
#include <vector>

#include "core/image.h"
#include "core/pixel.h"
#include "hierarchy/terrain/far_day.h"
#include "lessons/drawing/figure.h"
#include "raster/heights/height_field.h"
#include "raster/heights/height_sun.h"
#include "raster/heights/profile.h"
#include "raster/heights/shadow_bits.h"

namespace obscura {

/// A ridge, a cone and rough hills between: 30 m cells.
HeightField lesson_ground(int side);

/// The ground from above, lit evenly from the north-west and brown by height; `over` may paint a sample.
Image<Rgb8> ground_picture(const HeightField& ground,
                           const std::function<Rgb8(int x, int y, Rgb8 bare)>& over);

/// An arrow on the rim of a map, the way that light comes from this azimuth.
void draw_sun_arrow(Figure& f, const Box& map, double azimuth_deg);

/// What a ray to the sun rises from line to line.
double rise_m(const HeightSun& sun);

/// The part of a profile that the plot shows, its x in cells.
void draw_profile(Figure& f, const Plot& plot, const Profile& profile, const Pen& pen);

/// Cells and blocks of cells that a ray looks at on its way to the sun, the mean of all samples. Checks that
/// rays see what is `dark`.
double looks_of_rays(const HeightField& ground, const HeightSun& sun, const ShadowBits& dark);

/// A day of so many suns from east over south to west, closer together where the sun is low.
std::vector<FarSun> day_of_suns(const HeightField& ground, int suns);

/// Whole and far shadows of one sun; and where the far bit is open.
struct ShadowParts {
    ShadowBits whole, far_bits, open;
};
ShadowParts shadow_parts(const HeightField& ground, const HeightSun& sun, int threshold);

}  // namespace obscura
