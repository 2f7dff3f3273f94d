#include "lessons/stereo_panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "lessons/drawing/panels.h"

namespace obscura {

void draw_map(Figure& f, Vec2d at, const DisparityMap& map, const DisparityColours& colours, int zoom) {
    draw_picture(f, at, disparity_picture(map, colours, {}), zoom);
}

void draw_colours(Figure& f, Vec2d at, int width, const DisparityColours& colours, std::string_view unit) {
    const DisparityScale scale = disparity_scale(width, 14, colours);
    f.image(static_cast<int>(at.x), static_cast<int>(at.y), scale.strip, 1);
    for (const ScaleTick& tick : scale.ticks)
        f.text(at + Vec2d{tick.x, 30}, fmt::format("{:g}", tick.disparity_px), lettering::tick);
    f.text(at + Vec2d{width + 10.0, 12}, unit, {9, ink::soft, Align::left, false, false});
}

std::vector<double> row_of(const DisparityMap& map, int y) {
    return std::vector<double>(map.row(y), map.row(y) + map.width);
}

DisparityMap difference(const DisparityMap& a, const DisparityMap& b) {
    CHECK(a.width == b.width && a.height == b.height);
    DisparityMap out = a;
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] -= b.pixels[i];
    return out;
}

ErrorSize size_of(const DisparityMap& error) {
    ErrorSize size;
    for (const float e : error.pixels) {
        size.max_px = std::max(size.max_px, std::fabs(static_cast<double>(e)));
        size.rms_px += static_cast<double>(e) * static_cast<double>(e);
    }
    size.rms_px = std::sqrt(size.rms_px / static_cast<double>(error.pixels.size()));
    return size;
}

}  // namespace obscura
