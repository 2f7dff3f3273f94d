#pragma once
// Two pictures into one, for eyes and screens.

#include <array>
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

/// Dubois' matrix for red-cyan: red, green and blue of the anaglyph from red, green, blue of the left and of
/// the right picture, all in linear light. Rows sum to 1.
inline constexpr std::array<std::array<double, 6>, 3> dubois_matrix{{
    {0.45610004, 0.50048381, 0.17638087, -0.0434706, -0.08793882, -0.00155529},
    {-0.04008216, -0.03782458, -0.01575895, 0.37847603, 0.73363998, -0.01845032},
    {-0.01521607, -0.02059714, -0.00546856, -0.07215268, -0.11296065, 1.2263951},
}};

/// Display-referred pictures of the same size, linear light, each channel in [0, 1] (tone mapped, before the
/// sRGB curve); the result likewise. Half layouts of an odd side give the first picture the larger half.
/// CHECKs that the layout is one picture: not `separate`.
Image<Vec3f> lay_out(const Image<Vec3f>& left, const Image<Vec3f>& right, StereoLayout layout);

}  // namespace obscura
