#pragma once
// Textures: from sRGB pixels of 8 or 16 bits to linear light with a mip chain.

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/pixel.h"
#include "core/scene.h"

namespace obscura {

/// Decodes `image` (alpha is ignored) and adds levels down to 1 x 1. A level has half the size of the one
/// above, rounded down but at least 1; its pixels are means over the area they cover, which for even sizes is
/// the 2 x 2 box, so that a level's mean is that of the picture.
Texture make_texture(std::string name, ImageView<const Rgba8> image);
/// The same of all 16 bits: code / 65535 is decoded, so that spread codes of 8 bits give what these give.
Texture make_texture(std::string name, ImageView<const Rgba16> image);

/// Bytes that make_texture() will allocate for its result.
std::int64_t texture_bytes(int width, int height);

}  // namespace obscura
