#include "stereo/anchor_areas.h"

#include <algorithm>

namespace obscura {
namespace {

/// Calls fn(x, y, class) for every pixel that is seen.
template <class Fn>
void for_pixels(const ClassMap& map, Fn&& fn) {
    for (int y = 0; y < map.of.height; ++y) {
        for (int x = 0; x < map.of.width; ++x) {
            if (map.of(x, y) != no_class) fn(x, y, map.of(x, y));
        }
    }
}

AnchorArea area_of(const ClassMap& map, const std::vector<ClassShape>& shapes, const StereoEdit& edit,
                   const AnchorEdit& anchor, const EditParams& params, const DisparitySystem& system) {
    AnchorArea area{edit.name, static_cast<float>(params.anchor_weight * edit.weight), {}};
    const std::vector<std::uint8_t> covered = covered_classes(map, anchor.target);
    for_pixels(map, [&](int x, int y, std::uint32_t c) {
        if (covered[c] == 0) return;
        const double wanted =
            rounded(shapes[c], static_cast<double>(system.original(x, y))) + anchor.offset_px;
        area.pixels.push_back({x, y, static_cast<float>(wanted)});
    });
    return area;
}

}  // namespace

std::vector<AnchorArea> anchor_areas(const ClassMap& map, const std::vector<ClassShape>& shapes,
                                     const std::vector<const StereoEdit*>& order, const EditParams& params,
                                     const DisparitySystem& system) {
    std::vector<AnchorArea> areas;
    for (const StereoEdit* edit : order) {
        const auto* anchor = std::get_if<AnchorEdit>(&edit->what);
        if (anchor == nullptr || params.anchor_weight == 0) continue;
        AnchorArea area = area_of(map, shapes, *edit, *anchor, params, system);
        if (!area.pixels.empty()) areas.push_back(std::move(area));
    }
    // Where conflicts added weight, D~ stands at the limit that they leave.
    AnchorArea limits{
        limits_area_name, static_cast<float>(std::max(params.comfort_weight, params.window_weight)), {}};
    const double unit = static_cast<double>(system.epsilon) / params.epsilon;  // of a reduced map's pixels
    for_pixels(map, [&](int x, int y, std::uint32_t c) {
        const double own = unit * params.anchor_weight * shapes[c].anchor_weight;
        if (static_cast<double>(system.anchor_weight(x, y)) > 1.001 * own + 1e-6)
            limits.pixels.push_back({x, y, system.start(x, y)});
    });
    if (!limits.pixels.empty()) areas.push_back(std::move(limits));
    return areas;
}

}  // namespace obscura
