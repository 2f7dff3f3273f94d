#pragma once
// An aperture as few rectangles of constant transmission.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.2.

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace obscura {

/// Rectangles [x, x + width) x [y, y + height) in texels of a mask, whose weighted sum is the mask. Structure
/// of arrays; weights may be negative, rectangles may overlap. Widths and heights are powers of two,
/// positions multiples of the smaller of the two. Where a mask's sides are no powers of two, rectangles may
/// reach beyond its right and lower border; there they add up to 0.
struct QuadList {
    int columns = 0, rows = 0;  ///< of the mask
    std::vector<std::int32_t> x, y, width, height;
    std::vector<float> weight;
    std::size_t size() const { return x.size(); }
};

/// The paper's bottom-up decomposition. Of four binary texels: four become their parent; one, or two on a
/// diagonal, are squares; two side by side are one rectangle; three are the parent less a square. Grey masks:
/// by weight, the same rules where they hold. Adding the quads in the order of the list (coarse to fine), in
/// float, gives the mask exactly, and so does any order in exact arithmetic (any size; texels outside the
/// mask count as 0).
QuadList quads_of(ImageView<const float> mask);

/// after - before, as signed quads: what turns one pattern into the other. Same sizes. Added to `before` in
/// float, in any order, they give `after` exactly where both are binary; grey masks: in exact arithmetic.
QuadList difference_quads(ImageView<const float> before, ImageView<const float> after);

/// Adds every quad to a mask of list.columns x list.rows.
Image<float> mask_of(const QuadList& quads);

}  // namespace obscura
