#pragma once
// The textures of the scenes, as code: seamless, one metre wide, 8-bit sRGB. The PNG files below scenes/ hold
// the same pixels: obscura_textures (write_textures.cpp) writes them and a test compares.

#include <string>
#include <vector>

#include "core/image.h"
#include "core/pixel.h"

namespace obscura {

struct Pattern {
    std::string file;  ///< relative to scenes/
    Image<Rgb8> image;
};

/// textures/wood.png (grain along u), parquet.png (squares of strips, their grain crosswise), tiles.png
/// (painted tiles of 25 cm), cloth.png (woven checks of 12.5 cm), eye.png (no texture: an aperture, a pupil
/// behind eyelashes); tests/checks.png (black and white squares
/// of 12.5 cm).
std::vector<Pattern> patterns();

}  // namespace obscura
