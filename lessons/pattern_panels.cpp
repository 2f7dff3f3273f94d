#include "lessons/pattern_panels.h"

#include <algorithm>
#include <cmath>

#include "lessons/drawing/panels.h"

namespace obscura {

Rgb8 LogScale::color(double power) const {
    // 64 shades: more cannot be told apart, and fewer make smaller files.
    constexpr double shades = 64;
    if (power <= 0) return heat(0);
    const double t = std::clamp(1 + decades_of(power / peak) / decades, 0.0, 1.0);
    return heat(std::min(std::floor(t * shades), shades - 1) / (shades - 1));
}

void draw_power(Figure& f, Vec2d origin, ImageView<const float> power, const LogScale& scale) {
    Image<Rgb8> colors(power.width, power.height);
    for (int y = 0; y < power.height; ++y) {
        for (int x = 0; x < power.width; ++x)
            colors(x, y) = scale.color(static_cast<double>(power(x, y)));
    }
    draw_picture(f, origin, colors);
}

void draw_scale(Figure& f, Vec2d at, double width, std::string_view low, std::string_view high) {
    for (double x = 0; x < width; ++x)
        f.fill({at.x + x, at.y, 1, 14}, heat(x / (width - 1)));
    f.text({at.x - 10, at.y + 12}, low, lettering::right);
    f.text({at.x + width + 10, at.y + 12}, high);
}

void draw_mask(Figure& f, Vec2d origin, int side, ImageView<const float> mask, Rgb8 color) {
    Image<Rgb8> colors(mask.width, mask.height);
    for (int y = 0; y < colors.height; ++y) {
        for (int x = 0; x < colors.width; ++x)
            colors(x, y) = mix(ink::panel, color, static_cast<double>(mask(x, y)));
    }
    draw_picture(f, origin, colors, side);
}

}  // namespace obscura
