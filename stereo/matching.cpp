#include "stereo/matching.h"

#include <fmt/format.h>

#include <variant>

#include "stereo/map_columns.h"

namespace obscura {
namespace {

/// The pixel at an end of the match, or a reason why there is none.
std::optional<MapPixel> seen_pixel(const MiddleView& view, const Image<std::uint8_t>& valid, Vec2d point,
                                   const char* end, std::string& why_not) {
    const std::optional<MapPixel> pixel = map_pixel(view, point);
    if (!pixel) {
        why_not = fmt::format("the {} ({:.1f}, {:.1f}) is outside of the picture", end, point.x, point.y);
        return std::nullopt;
    }
    if (valid(pixel->x, pixel->y) == 0) {
        why_not = fmt::format("nothing is seen at the {} ({:.1f}, {:.1f})", end, point.x, point.y);
        return std::nullopt;
    }
    return pixel;
}

}  // namespace

std::optional<MatchingSet> matching_set(const MiddleView& view, const Image<std::uint8_t>& valid,
                                        const StereoEdit& edit, std::string& why_not) {
    const auto& match = std::get<MatchEdit>(edit.what);
    const auto source = seen_pixel(view, valid, match.source_px, "source", why_not);
    if (!source) return std::nullopt;
    const auto destination = seen_pixel(view, valid, match.destination_px, "destination", why_not);
    if (!destination) return std::nullopt;
    if (*source == *destination) {
        why_not = "source and destination are the same pixel";
        return std::nullopt;
    }

    MatchingSet set;
    set.name = edit.name;
    set.source_x = source->x;
    set.source_y = source->y;
    set.weight = static_cast<float>(edit.weight);
    const std::uint32_t object = view.object(destination->x, destination->y);
    const double pivot = static_cast<double>(view.disparity(destination->x, destination->y));
    const bool everything = match.radius_px <= 0;
    for (int y = 0; y < view.height(); ++y) {
        const double dy = picture_y(view, y) - match.destination_px.y;
        if (!everything && std::abs(dy) > match.radius_px && y != destination->y) continue;
        for (int x = 0; x < view.width(); ++x) {
            if (valid(x, y) == 0 || MapPixel{x, y} == *source) continue;
            if (view.object(x, y) != object && (everything || !match.any_object)) continue;
            const double dx = picture_x(view, x) - match.destination_px.x;
            const bool within = dx * dx + dy * dy <= match.radius_px * match.radius_px;
            if (!everything && !within && MapPixel{x, y} != *destination) continue;
            const double target = match.offset_px + static_cast<double>(view.disparity(x, y)) - pivot;
            set.members.push_back({x, y, static_cast<float>(target)});
        }
    }
    return set;
}

}  // namespace obscura
