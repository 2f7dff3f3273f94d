#include "bench/shadows/map_points.h"

#include <algorithm>
#include <cmath>

namespace obscura {

// As filters/pcf_ref.cpp does for the middle tap of a kernel.
TestedTexel tested_texel(const SurfaceBlock& surface, const PcfLight& light, int at) {
    const ref::PcfPlace place = ref::pcf_place(surface, light, at);
    if (place.kind != ref::PcfPlace::on_map) return {};
    TestedTexel t;
    t.looked_up = true;
    t.x = static_cast<std::int32_t>(std::nearbyint(place.X * 256.0)) >> 8;
    t.y = static_cast<std::int32_t>(std::nearbyint(place.Y * 256.0)) >> 8;
    const auto to_centre_x = static_cast<float>((static_cast<double>(t.x) + 0.5) - place.X);
    const auto to_centre_y = static_cast<float>((static_cast<double>(t.y) + 0.5) - place.Y);
    t.depth = place.depth + std::min(place.slope_x * to_centre_x + place.slope_y * to_centre_y, 0.0f);
    return t;
}

MapPointList map_points(const VisiblePoints& points, const PcfLight& light) {
    MapPointList list;
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        for (int column = 0; column < frame_tile_side; column += 4) {
            for (int lane = 0; lane < 16; ++lane) {
                const int at = lane / 4 * frame_tile_side + column + lane % 4;
                const TestedTexel t = tested_texel(points.blocks[b], light, at);
                if (!t.looked_up) continue;
                list.x.push_back(t.x);
                list.y.push_back(t.y);
                list.depth.push_back(t.depth);
                list.pixel.push_back(static_cast<std::uint32_t>(points.pixel(b, at)));
            }
        }
    }
    return list;
}

}  // namespace obscura
