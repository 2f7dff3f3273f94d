#pragma once
// Channels of a stereo pair as the bytes of files.

#include <string>
#include <string_view>
#include <vector>

#include "app/pair/pair.h"
#include "app/scene/scene.h"
#include "core/image.h"
#include "core/isa.h"
#include "core/pixel.h"
#include "stereo/comfort.h"
#include "stereo/disparity.h"
#include "stereo/disparity_colour.h"
#include "stereo/layout.h"

namespace obscura {

/// Bytes of a file and what it shows: "" the pair itself, "warp", "before.pfm", ...
struct RoledFile {
    std::string role, bytes;
};

/// Exposed and tone mapped, linear light in [0, 1]: what lay_out() takes.
Image<Vec3f> display_light(ImageView<const Vec3f> radiance, const RenderSettings& render, const Exec& exec);

/// 8-bit sRGB.
std::string encode_display(const Image<Vec3f>& picture);

/// The columns of a widened picture that are the picture itself.
Image<Vec3f> without_margins(const Image<Vec3f>& wide, int margin_px);

/// Roles of the files that show two pictures in a layout: `role`, or "role.left" and "role.right".
std::vector<std::string> layout_roles(std::string_view role, StereoLayout layout);

/// Those files.
std::vector<RoledFile> laid_out_files(std::string_view role, const Image<Vec3f>& left,
                                      const Image<Vec3f>& right, StereoLayout layout);

/// A range that holds both maps, and the comfort zone.
DisparityColours common_colours(const DisparityMap& a, const DisparityMap& b, const ComfortZone& comfort);

/// Disparity of both eyes' pictures, with what only one sees.
TwoWayDisparity two_way_maps(const StereoPair& pair, const Exec& exec);

/// Roles of the files that `map_files` gives.
std::vector<std::string> map_roles();

/// Disparity of the middle view before and after (PFM, and colours over one range of both), of the left eye
/// to the right one and back, what only one eye sees, and the conflicts of the edits. Needs
/// settings.middle_picture.
std::vector<RoledFile> map_files(const StereoPair& pair, const StereoSettings& settings,
                                 const RenderSettings& render, const Exec& exec);

/// Both eyes' pictures, warped out of the middle one: the comparison. Needs settings.middle_picture. `holes`:
/// pixels whose colour was invented, of both.
struct WarpedPair {
    Image<Vec3f> left, right;
    std::int64_t holes = 0;
};
WarpedPair warped_pair(const StereoPair& pair, const RenderSettings& render, const Exec& exec);

}  // namespace obscura
