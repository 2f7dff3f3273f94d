#pragma once
// Panels of lesson 20: the parts that lights with a size are taken for, and the cone that holds what any of
// them has before a point.

#include "lessons/drawing/figure.h"

namespace obscura {

/// Of the lesson's sun.
constexpr double soft_sun_deg = 4;

/// A disc in the sky, a square and a ball, 64 parts each, side by side from `at` on.
void draw_lights(Figure& f, Vec2d at);

/// A sketch from the side: sixteen samples, the cone to the sun, boxes within it and beside it.
void draw_cone(Figure& f, const Box& box);

}  // namespace obscura
