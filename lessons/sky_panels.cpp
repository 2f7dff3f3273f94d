#include "lessons/sky_panels.h"

#include <cmath>

#include <fmt/format.h>

#include "lessons/drawing/panels.h"

namespace obscura {

Vec2d on_sky_disc(const Box& box, Vec3d direction) {
    // r^2 = 1 - y, so that equal areas are equal solid angles.
    const double stretch = 1 / std::sqrt(1 + direction.y), radius = 0.5 * box.w;
    return box.centre() + Vec2d{direction.x * stretch * radius, direction.z * stretch * radius};
}

void draw_sky_disc(Figure& f, const Box& box, const std::function<Rgb8(Vec3d)>& color) {
    constexpr int finer = 2;
    const int side = finer * static_cast<int>(box.w);
    Image<Rgb8> picture(side, side);
    for (int py = 0; py < side; ++py) {
        for (int px = 0; px < side; ++px) {
            const double u = 2 * (px + 0.5) / side - 1, v = 2 * (py + 0.5) / side - 1, square = u * u + v * v;
            const double stretch = std::sqrt(2 - square);
            picture(px, py) = square >= 1 ? ink::paper : color({u * stretch, 1 - square, v * stretch});
        }
    }
    f.image(static_cast<int>(box.x), static_cast<int>(box.y), picture, finer);
    f.ring(box.centre(), 0.5 * box.w, {ink::soft, 1});
}

void draw_suns(Figure& f, const Box& box, std::span<const SkyDirection> suns,
               const std::function<bool(std::size_t)>& arrives, double radius, Rgb8 color) {
    for (std::size_t k = 0; k < suns.size(); ++k) {
        const Vec2d at = on_sky_disc(box, suns[k].direction);
        if (arrives(k)) {
            f.disc(at, radius + 1.2, ink::dark);
            f.disc(at, radius, color);
        } else {
            f.ring(at, radius, {ink::paper, 1.5});
        }
    }
}

void draw_share_axes(Figure& f, const Plot& plot) {
    f.axes(plot, "", "share of what open ground gets");
    for (const double y : {0.2, 0.4}) {
        f.line(plot.at(plot.x0, y), plot.at(plot.x1, y), {ink::grid, 1});
        f.text(plot.at(plot.x0, y) + Vec2d{-8, 4}, fmt::format("{}", y), {8.5, ink::soft, Align::right});
    }
    axis_numbers(f, plot, {plot.x0, 0, plot.x1}, 0);
    f.text(plot.at(0.5 * plot.x1, plot.y0) + Vec2d{0, 18}, "metres", lettering::tick);
}

void draw_swatch(Figure& f, const Box& box, Rgb8 color, const std::string& name, const std::string& says) {
    f.fill(box, color);
    f.frame(box, {ink::soft, 1});
    f.text({box.x + box.w + 12, box.centre().y - 5}, name, lettering::bold);
    f.text({box.x + box.w + 12, box.centre().y + 14}, says);
}

}  // namespace obscura
