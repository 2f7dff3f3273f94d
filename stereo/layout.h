#pragma once
// Two pictures into one, for eyes and screens.

#include <optional>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/vec.h"

namespace obscura {

enum class StereoLayout {
    side_by_side,       ///< left | right, 2 w x h
    half_side_by_side,  ///< squeezed to w x h (box filter in linear light)
    cross_eye,          ///< right | left
    over_under,         ///< left above right, w x 2 h
    half_over_under,
    anaglyph,         ///< red-cyan, colour
    anaglyph_half,    ///< red-cyan, half-colour: the red channel is the left's luma
    anaglyph_dubois,  ///< least squares for red-cyan glasses (Dubois 2001)
    interlaced,       ///< even rows left, odd rows right
    left,
    right,     ///< one eye
    separate,  ///< two files
};
/// "side-by-side", "half-side-by-side", "cross-eye", ...; nothing for any other text.
std::optional<StereoLayout> parse_layout(std::string_view text);
std::string_view layout_name(StereoLayout layout);
std::vector<std::string_view> layout_names();

/// Display-referred pictures of the same size, linear light, each channel in [0, 1] (tone mapped, before the
/// sRGB curve); the result likewise. Not for `separate`.
Image<Vec3f> lay_out(const Image<Vec3f>& left, const Image<Vec3f>& right, StereoLayout layout);

}  // namespace obscura
