#include "stereo/matching.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
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

std::vector<MatchingSet> matching_sets(const MiddleView& view, const Image<std::uint8_t>& valid,
                                       const std::vector<const StereoEdit*>& edits,
                                       std::vector<EditNotice>& notices) {
    std::vector<MatchingSet> sets;
    for (const StereoEdit* edit : edits) {
        if (!std::holds_alternative<MatchEdit>(edit->what)) continue;
        std::string why_not;
        std::optional<MatchingSet> set = matching_set(view, valid, *edit, why_not);
        if (set)
            sets.push_back(std::move(*set));
        else
            notices.push_back({edit->name, why_not});
    }
    return sets;
}

void move_members(const std::vector<MatchingSet>& sets, DisparityMap& edited) {
    if (sets.empty()) return;
    // Several sets of one pixel: the mean of what they want by weight.
    Image<double> weight(edited.width, edited.height), pull(edited.width, edited.height);
    for (const MatchingSet& set : sets) {
        const auto w = static_cast<double>(set.weight);
        const auto source = static_cast<double>(edited(set.source_x, set.source_y));
        for (const MatchedPixel& p : set.members) {
            weight(p.x, p.y) += w;
            pull(p.x, p.y) +=
                w * (source + static_cast<double>(p.target) - static_cast<double>(edited(p.x, p.y)));
        }
    }
    for (std::size_t i = 0; i < edited.pixels.size(); ++i)
        if (const double w = weight.pixels[i]; w > 0)
            edited.pixels[i] += static_cast<float>(pull.pixels[i] / w * std::min(1.0, w));
}

}  // namespace obscura
