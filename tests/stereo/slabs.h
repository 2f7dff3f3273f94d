#pragma once
// Middle views painted by hand: rectangles of sloping disparity, so that every expected number is plain.

#include <cstdint>

#include "stereo/middle_view.h"

namespace obscura {

/// Nothing seen anywhere; disparity -20.
inline MiddleView empty_view(int width, int height, int margin_px = 0) {
    MiddleView v;
    v.picture_width = width;
    v.picture_height = height;
    v.margin_px = margin_px;
    const int columns = width + 2 * margin_px;
    v.depth_m = Image<float>(columns, height, 1);
    v.normal = Image<Vec3f>(columns, height);
    v.object = v.material = v.triangle = Image<std::uint32_t>(columns, height, nothing_seen);
    v.disparity = DisparityMap(columns, height, -20);
    return v;
}

struct PaintedSlab {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< [x0, x1) x [y0, y1), columns of the map
    std::uint32_t object = 0, material = 0;
    float disparity = 0;  ///< at the upper left pixel
    float slope_x = 0, slope_y = 0;
};

inline void paint(MiddleView& v, const PaintedSlab& s) {
    for (int y = s.y0; y < s.y1; ++y) {
        for (int x = s.x0; x < s.x1; ++x) {
            v.object(x, y) = s.object;
            v.material(x, y) = s.material;
            v.disparity(x, y) = s.disparity + s.slope_x * static_cast<float>(x - s.x0) +
                                s.slope_y * static_cast<float>(y - s.y0);
        }
    }
}

}  // namespace obscura
