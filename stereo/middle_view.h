#pragma once
// What the camera midway between the eyes sees: the image that edits and the solver work on. It may be wider
// than the picture by a margin on both sides, so that what either eye sees at its borders is in it.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace obscura {

/// Pixels, left minus right at the middle view, positive in front of the screen.
using DisparityMap = Image<float>;

constexpr std::uint32_t nothing_seen = 0xffffffffu;

/// Per pixel of the map. All images have the same size: (picture_width + 2 margin_px) x picture_height of
/// the picture divided by `reduction`, rounded up. Disparities stay in pixels of the full picture.
struct MiddleView {
    int picture_width = 0, picture_height = 0;  ///< of one eye's picture, full resolution
    int margin_px = 0;                          ///< columns of the full picture added on either side
    int reduction = 1;                          ///< 1, 2, 4 or 8: map pixels per picture pixel, one way
    Image<float> depth_m;                       ///< along the view axis; infinity where nothing is
    Image<Vec3f> normal;                        ///< world space, unit, towards the viewer; 0 where nothing is
    Image<std::uint32_t> object;                ///< index into Mesh::objects; nothing_seen where nothing is
    Image<std::uint32_t> material;  ///< index into Scene::materials; nothing_seen where nothing is
    Image<std::uint32_t> triangle;  ///< index into Mesh::triangles; nothing_seen where nothing is. Empty when
                                    ///< the view is of a photograph
    DisparityMap disparity;         ///< unedited; of infinity where nothing is
    int width() const { return disparity.width; }
    int height() const { return disparity.height; }
};

/// Every reduction-th pixel of a full-resolution view (the pixel whose centre is nearest to the middle of its
/// block, the upper left of four): values are sampled, never averaged, so borders of objects stay sharp.
MiddleView reduced(const MiddleView& view, int reduction);

/// The column (or row) of a full-resolution map, `full_size` wide, whose value stands at `index` of the
/// reduced one: its centre is index * reduction + (reduction - 1) / 2, but in a last, narrower block.
int sampled_pixel(int index, int reduction, int full_size);

}  // namespace obscura
