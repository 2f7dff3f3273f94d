#pragma once
// A sky from a picture of the whole sphere.

#include <string>
#include <string_view>

#include "core/image.h"
#include "core/image_io.h"
#include "core/vec.h"

namespace obscura {

/// Equirectangular: the top row looks straight up, the bottom row straight down; columns run clockwise as
/// seen from above, the left edge and the right edge both look to `left_edge_azimuth_deg` (180: north is in
/// the middle).
struct ImageSky {
    Image<Vec3f> pixels;  ///< radiance, W/(m2 sr) per channel, linear sRGB
    double left_edge_azimuth_deg = 180;
};

/// As bright as keys of scenes allow: sums over a sky, times what lenses do to it, stay finite.
constexpr float largest_sky_radiance = 1e9f;

/// From the bytes of a PFM file, grey or colour, each radiance times `scale` (> 0). Throws InputError when it
/// is no PFM, is not twice as wide as high, or a pixel is not from 0 to largest_sky_radiance; LimitError as
/// decode_pfm().
ImageSky image_sky(std::string_view pfm_bytes, const std::string& name, double scale,
                   const ImageFileLimits& limits = {});

/// The pixel that a unit direction falls into, by bilinear interpolation between middles of pixels; columns
/// wrap.
Vec3f sky_radiance(const ImageSky& sky, Vec3d direction);

}  // namespace obscura
