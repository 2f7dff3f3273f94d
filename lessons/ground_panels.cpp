#include "lessons/ground_panels.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "raster/heights/height_near.h"
#include "raster/heights/height_rays.h"
#include "raster/heights/height_sweep.h"

namespace obscura {

HeightField lesson_ground(int side) {
    HeightField ground{Image<std::int32_t>(side, side), 30, 30, Diagonal::falling};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            // In a square of 100, whatever the side.
            const double u = 100.0 * x / side, v = 100.0 * y / side;
            const double ridge = std::max(0.0, 1 - std::fabs(u - 66 + 0.3 * (v - 50)) / 14);
            const double dx = u - 34, dy = v - 36,
                         cone = std::max(0.0, 1 - std::sqrt(dx * dx + dy * dy) / 19);
            const double crest = 1 + 0.35 * num::sin(0.31 * v) + 0.2 * num::sin(0.83 * v + 1);
            const double hills =
                num::sin(0.23 * u + 0.4) * num::sin(0.19 * v) + 0.6 * num::sin(0.51 * u + 0.37 * v);
            const double rough = num::sin(1.7 * u + 0.9 * v) * num::sin(1.3 * v - 0.7 * u);
            const double m = 420 * ridge * crest + 520 * cone + 38 * hills + 11 * rough + 120;
            ground.height_q16(x, y) = height_q16_of(m);
        }
    }
    return ground;
}

Image<Rgb8> ground_picture(const HeightField& ground, const std::function<Rgb8(int, int, Rgb8)>& over) {
    Image<Rgb8> picture(ground.width(), ground.height());
    const HeightRange range = height_range(ground);
    const auto at = [&](int x, int y) {
        return metres_of(
            ground.height_q16(std::clamp(x, 0, ground.width() - 1), std::clamp(y, 0, ground.height() - 1)));
    };
    for (int y = 0; y < ground.height(); ++y) {
        for (int x = 0; x < ground.width(); ++x) {
            const double east = (at(x + 1, y) - at(x - 1, y)) / (2 * ground.cell_x_m),
                         south = (at(x, y + 1) - at(x, y - 1)) / (2 * ground.cell_y_m);
            const double light = (east + south + 1.4) / std::sqrt(3.96 * (1 + east * east + south * south));
            const double high = (at(x, y) - metres_of(range.least_q16)) /
                                (metres_of(range.greatest_q16) - metres_of(range.least_q16));
            const Rgb8 bare = mix({60, 62, 58}, mix({214, 206, 178}, {252, 250, 244}, high),
                                  std::clamp(0.25 + 0.75 * light, 0.0, 1.0));
            picture(x, y) = over(x, y, bare);
        }
    }
    return picture;
}

void draw_sun_arrow(Figure& f, const Box& map, double azimuth_deg) {
    const Vec2d way{-num::sin_deg(azimuth_deg), num::cos_deg(azimuth_deg)};
    const Vec2d middle = map.centre(), from = middle - way * (0.5 * map.w - 8);
    f.arrow(from, from + way * 56.0, {ink::orange, 4}, 15);
}

double rise_m(const HeightSun& sun) {
    return static_cast<double>(sun.rise_q36) / static_cast<double>(std::int64_t{1} << rise_fraction_bits);
}

void draw_profile(Figure& f, const Plot& plot, const Profile& profile, const Pen& pen) {
    std::vector<Vec2d> points;
    for (std::size_t i = 0; i < profile.lines.size(); ++i) {
        const ProfileLine& line = profile.lines[i];
        const double to = i + 1 < profile.lines.size() ? profile.lines[i + 1].from : profile.end;
        for (const double u : {line.from, to}) {
            const double cells = u / static_cast<double>(cell_q20);
            if (cells >= plot.x0 && cells <= plot.x1)
                points.push_back(plot.at(cells, std::max(line.at(u), plot.y0)));
        }
    }
    if (points.size() >= 2) f.polyline(points, pen);
}

double looks_of_rays(const HeightField& ground, const HeightSun& sun, const ShadowBits& dark) {
    const HeightPyramid pyramid = height_pyramid(ground);
    const HeightRays rays(ground, pyramid, sun);
    HeightRayCounts counts;
    for (int y = 0; y < ground.height(); ++y) {
        for (int x = 0; x < ground.width(); ++x) {
            const int cx = std::min(x, ground.width() - 2), cy = std::min(y, ground.height() - 2);
            const bool ray = rays.ground_hidden({cx, cy, double(x - cx), double(y - cy)}, 1 << 20, &counts);
            CHECK(ray == dark(x, y), "rays and the sweep agree at every sample");
        }
    }
    return static_cast<double>(counts.cells + counts.blocks) / static_cast<double>(counts.rays);
}

std::vector<FarSun> day_of_suns(const HeightField& ground, int suns) {
    std::vector<FarSun> day;
    for (int i = 0; i < suns; ++i) {
        const double t = (i + 0.5) / suns, even = 0.5 - 0.5 * num::cos_deg(180 * t);
        FarSun s{5 + 14 * even, 14.0 / suns, 62 + 236 * even, 1 + 52 * num::sin_deg(180 * even), {}};
        s.direction = height_sun(ground, s.azimuth_deg, s.elevation_deg);
        day.push_back(s);
    }
    return day;
}

ShadowParts shadow_parts(const HeightField& ground, const HeightSun& sun, int threshold) {
    const int thresholds[] = {0, threshold};
    auto maps = sweep_shadows(ground, sun, thresholds);
    ShadowBits all(ground.width(), ground.height());
    for (int y = 0; y < ground.height(); ++y) {
        for (int x = 0; x < ground.width(); ++x)
            all.set(x, y);
    }
    return {maps[0], maps[1], eroded(near_shadows(ground, sun, threshold, all))};
}

}  // namespace obscura
