#include "app/report/pair_pictures.h"

#include <algorithm>
#include <array>

#include "core/buffer.h"
#include "core/color.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/num.h"
#include "core/parallel.h"
#include "filters/tonemap.h"
#include "stereo/conflict_overlay.h"
#include "stereo/thesis/warp.h"

namespace obscura {
namespace {

constexpr std::array map_role_names = {
    "before.pfm", "before.png", "after.pfm",          "after.png",           "left.pfm",  "left.png",
    "right.pfm",  "right.png",  "left.occlusion.png", "right.occlusion.png", "scale.png", "conflicts.png"};

std::string grey_png(const Image<std::uint8_t>& mask) {
    Image<Rgb8> picture(mask.width, mask.height);
    std::transform(mask.pixels.begin(), mask.pixels.end(), picture.pixels.begin(), [](std::uint8_t v) {
        return Rgb8{v, v, v};
    });
    return encode_png(picture.view());
}

const Raster<Vec3f>& middle_radiance(const StereoPair& pair) {
    CHECK(pair.eyes.middle.has_value(), "the middle picture was not asked for");
    return pair.eyes.middle->radiance;
}

}  // namespace

DisparityColours common_colours(const DisparityMap& a, const DisparityMap& b, const ComfortZone& comfort) {
    DisparityColours colours = colours_for(a);
    const DisparityColours other = colours_for(b);
    colours.far_px = std::min(colours.far_px, other.far_px);
    colours.near_px = std::max(colours.near_px, other.near_px);
    colours.comfort_far_px = comfort.farthest_px;
    colours.comfort_near_px = comfort.nearest_px;
    return colours;
}

TwoWayDisparity two_way_maps(const StereoPair& pair, const Exec& exec) {
    return cross_checked({pair.eyes.left_map.disparity, pair.eyes.left_map.original, {}},
                         {pair.eyes.right_map.disparity, pair.eyes.right_map.original, {}}, TwoWayParams{},
                         exec);
}

Image<Vec3f> display_light(ImageView<const Vec3f> radiance, const RenderSettings& render, const Exec& exec) {
    const double scale = num::exp2(render.exposure_ev);
    const auto shown = [&](float v) {
        return static_cast<float>(tone_curve(render.tone, std::max(0.0, scale * double{v})));
    };
    Image<Vec3f> out(radiance.width, radiance.height);
    parallel_for(static_cast<std::size_t>(out.height), exec, [&](std::size_t row) {
        const auto y = static_cast<int>(row);
        std::transform(radiance.row(y), radiance.row(y) + out.width, out.row(y), [&](Vec3f v) {
            return Vec3f{shown(v.x), shown(v.y), shown(v.z)};
        });
    });
    return out;
}

std::string encode_display(const Image<Vec3f>& picture) {
    const CodeTable& srgb = linear_to_srgb8_table();
    Image<Rgb8> codes(picture.width, picture.height);
    std::transform(picture.pixels.begin(), picture.pixels.end(), codes.pixels.begin(), [&](Vec3f v) {
        return Rgb8{srgb(v.x), srgb(v.y), srgb(v.z)};
    });
    return encode_png(codes.view());
}

Image<Vec3f> without_margins(const Image<Vec3f>& wide, int margin_px) {
    Image<Vec3f> out(wide.width - 2 * margin_px, wide.height);
    for (int y = 0; y < out.height; ++y)
        std::copy_n(wide.row(y) + margin_px, out.width, out.row(y));
    return out;
}

std::vector<std::string> layout_roles(std::string_view role, StereoLayout layout) {
    if (layout != StereoLayout::separate) return {std::string(role)};
    const std::string start = role.empty() ? "" : std::string(role) + ".";
    return {start + "left", start + "right"};
}

std::vector<RoledFile> laid_out_files(std::string_view role, const Image<Vec3f>& left,
                                      const Image<Vec3f>& right, StereoLayout layout) {
    const std::vector<std::string> roles = layout_roles(role, layout);
    if (layout != StereoLayout::separate) return {{roles[0], encode_display(lay_out(left, right, layout))}};
    return {{roles[0], encode_display(left)}, {roles[1], encode_display(right)}};
}

std::vector<std::string> map_roles() {
    return {map_role_names.begin(), map_role_names.end()};
}

std::vector<RoledFile> map_files(const StereoPair& pair, const StereoSettings& settings,
                                 const RenderSettings& render, const Exec& exec) {
    const DisparityColours colours =
        common_colours(pair.view.disparity, pair.optimised, settings.edit.comfort);
    std::vector<RoledFile> files;
    const auto add_map = [&](const std::string& name, const DisparityMap& map) {
        files.push_back({name + ".pfm", encode_pfm(map.view())});
        files.push_back({name + ".png", encode_png(disparity_picture(map, colours, exec).view())});
    };
    add_map("before", pair.view.disparity);
    add_map("after", pair.optimised);
    const TwoWayDisparity eyes = two_way_maps(pair, exec);
    add_map("left", eyes.left.disparity);
    add_map("right", eyes.right.disparity);
    files.push_back({"left.occlusion.png", grey_png(occlusion_mask(eyes.left))});
    files.push_back({"right.occlusion.png", grey_png(occlusion_mask(eyes.right))});
    files.push_back({"scale.png", encode_png(disparity_scale(512, 32, colours).strip.view())});
    const Image<Vec3f> middle =
        without_margins(display_light(middle_radiance(pair).view(), render, exec), pair.view.margin_px);
    files.push_back(
        {"conflicts.png", encode_display(conflict_overlay(middle, pair.view, pair.edited.conflict_pixels))});
    return files;
}

WarpedPair warped_pair(const StereoPair& pair, const RenderSettings& render, const Exec& exec) {
    const Image<Vec3f> middle = display_light(middle_radiance(pair).view(), render, exec);
    WarpParams params;
    WarpedPicture left = warped(middle, pair.view, pair.optimised, params, exec);
    params.shift = -params.shift;
    WarpedPicture right = warped(middle, pair.view, pair.optimised, params, exec);
    return {std::move(left.picture), std::move(right.picture), left.holes + right.holes};
}

}  // namespace obscura
