#pragma once
// Between pixels of the picture and of the map, which may be wider by margins and reduced.

#include <cmath>
#include <optional>

#include "core/vec.h"
#include "stereo/middle_view.h"

namespace obscura {

struct MapPixel {
    int x = 0, y = 0;
    friend bool operator==(const MapPixel&, const MapPixel&) = default;
};

/// Where the middle of a map's pixel is, in pixels of the picture: of the pixel that a reduced map keeps of
/// its block. Less than 0 in the left margin.
inline double picture_x(const MiddleView& view, int column) {
    const int map_width = view.picture_width + 2 * view.margin_px;
    return sampled_pixel(column, view.reduction, map_width) + 0.5 - view.margin_px;
}
inline double picture_y(const MiddleView& view, int row) {
    return sampled_pixel(row, view.reduction, view.picture_height) + 0.5;
}

/// The map's pixel that a point of the picture lies in; nothing beyond the map.
inline std::optional<MapPixel> map_pixel(const MiddleView& view, Vec2d point) {
    const double x = std::floor((point.x + view.margin_px) / view.reduction);
    const double y = std::floor(point.y / view.reduction);
    if (!(x >= 0 && y >= 0 && x < view.width() && y < view.height())) return std::nullopt;
    return MapPixel{static_cast<int>(x), static_cast<int>(y)};
}

}  // namespace obscura
