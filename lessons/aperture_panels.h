#pragma once
// Apertures of lessons 9 to 12 and 18, and their quads as pictures.

#include <cstddef>
#include <functional>

#include "lessons/drawing/figure.h"
#include "optics/aperture_shapes.h"
#include "optics/field/quads.h"

namespace obscura {

/// A shape of 0.9 of the mask's width; texels are open where at least half of them is.
Image<float> binary_mask(ApertureKind kind, int size);

/// The mask behind an opaque disc, both in texels: closed where a texel's centre is.
Image<float> behind_disc_at(Image<float> mask, Vec2d centre, double radius);

/// Side of the squares of the level that wrote quad k.
int level_side(const QuadList& quads, std::size_t k);

/// The quads k with keep(k), in their order.
QuadList quads_where(const QuadList& quads, const std::function<bool(std::size_t k)>& keep);

/// By area; equally large ones stay in their order.
QuadList largest_first(const QuadList& quads);

/// Negative weights: the sum is the mask only with them.
std::size_t count_negative(const QuadList& quads);

constexpr Rgb8 positive_quad = ink::blue, negative_quad = ink::red;

/// Every quad by its sign, `texel` pixels to a texel, rimmed with paper from 4 pixels' side on.
void draw_quads(Figure& f, Vec2d origin, double texel, const QuadList& quads);

/// Loops of an outline, `texel` pixels to a texel, the mask's upper left corner at `origin`.
void draw_outline(Figure& f, Vec2d origin, double texel, const Outline& outline, const Pen& pen);

/// A row of the mask as grey from 0 to 1 of the plot's y, by its openness; x in widths of the mask.
void shade_row(Figure& f, const Plot& plot, ImageView<const float> mask, int row);

}  // namespace obscura
