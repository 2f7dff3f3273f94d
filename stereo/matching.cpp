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

/// Whether a pixel belongs to what one end of the match reaches: the end's object, or the disc around it.
struct Reach {
    const MiddleView& view;
    const MatchEdit& match;
    MapPixel pixel;
    Vec2d point;

    bool covers(int x, int y) const {
        if (MapPixel{x, y} == pixel) return true;
        const bool everything = match.radius_px <= 0;
        if (view.object(x, y) != view.object(pixel.x, pixel.y) && (everything || !match.any_object))
            return false;
        const double dx = picture_x(view, x) - point.x, dy = picture_y(view, y) - point.y;
        return everything || dx * dx + dy * dy <= match.radius_px * match.radius_px;
    }
};

/// Pixels that `reach` covers and `other` does not, held at their distance in `map` to the reach's own, plus
/// `offset_px`; never the source itself.
MatchingSet members_of(const DisparityMap& map, const Image<std::uint8_t>& valid, MapPixel source,
                       const Reach& reach, const Reach* other, double offset_px) {
    const MiddleView& view = reach.view;
    MatchingSet set;
    set.source_x = source.x;
    set.source_y = source.y;
    const double pivot = static_cast<double>(map(reach.pixel.x, reach.pixel.y));
    for (int y = 0; y < view.height(); ++y) {
        const double dy = picture_y(view, y) - reach.point.y;
        if (reach.match.radius_px > 0 && std::abs(dy) > reach.match.radius_px && y != reach.pixel.y) continue;
        for (int x = 0; x < view.width(); ++x) {
            if (valid(x, y) == 0 || MapPixel{x, y} == source || !reach.covers(x, y)) continue;
            if (other != nullptr && other->covers(x, y)) continue;
            const double target = offset_px + static_cast<double>(map(x, y)) - pivot;
            set.members.push_back({x, y, static_cast<float>(target)});
        }
    }
    return set;
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
    const Reach reach{view, match, *destination, match.destination_px};
    MatchingSet set = members_of(view.disparity, valid, *source, reach, nullptr, match.offset_px);
    set.name = edit.name;
    set.weight = static_cast<float>(edit.weight);
    return set;
}

std::optional<MatchingSet> held_source(const MiddleView& view, const Image<std::uint8_t>& valid,
                                       const DisparityMap& edited, const StereoEdit& edit) {
    const auto& match = std::get<MatchEdit>(edit.what);
    std::string why_not;
    if (!match.hold_source || !matching_set(view, valid, edit, why_not)) return std::nullopt;
    const MapPixel source = *map_pixel(view, match.source_px),
                   destination = *map_pixel(view, match.destination_px);
    const Reach around{view, match, source, match.source_px},
        followers{view, match, destination, match.destination_px};
    MatchingSet set = members_of(edited, valid, source, around, &followers, 0);
    if (set.members.empty()) return std::nullopt;
    set.name = edit.name;
    set.weight = static_cast<float>(edit.weight);
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
        if (!set) {
            notices.push_back({edit->name, why_not});
            continue;
        }
        sets.push_back(std::move(*set));
    }
    return sets;
}

void hold_sources(const MiddleView& view, const Image<std::uint8_t>& valid, const DisparityMap& edited,
                  const std::vector<const StereoEdit*>& edits, std::vector<MatchingSet>& sets) {
    for (const StereoEdit* edit : edits) {
        if (!std::holds_alternative<MatchEdit>(edit->what)) continue;
        if (auto held = held_source(view, valid, edited, *edit)) sets.push_back(std::move(*held));
    }
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
