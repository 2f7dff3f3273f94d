#pragma once
// The ground of lessons 26 and 27, and how it is drawn.

#include <functional>

#include "core/image.h"
#include "core/pixel.h"
#include "lessons/drawing/figure.h"
#include "raster/heights/height_field.h"

namespace obscura {

/// A ridge, a cone and rough hills between: 30 m cells.
HeightField lesson_ground(int side);

/// The ground from above, lit evenly from the north-west and brown by height; `over` may paint a sample.
Image<Rgb8> ground_picture(const HeightField& ground,
                           const std::function<Rgb8(int x, int y, Rgb8 bare)>& over);

/// An arrow on the rim of a map, the way that light comes from this azimuth.
void draw_sun_arrow(Figure& f, const Box& map, double azimuth_deg);

}  // namespace obscura
