#include "lessons/light_panels.h"

#include <cmath>
#include <string>

#include "raster/light_samples.h"

namespace obscura {
namespace {

/// The parts of a light. `place`: of a sample, its outline within 1 of the middle.
template <class Place>
void draw_points(Figure& f, const Box& box, const Light& light, int count, bool round,
                 const std::string& name, Place&& place) {
    const double radius = 0.46 * box.w;
    f.fill(box, ink::panel);
    if (round) {
        f.ring(box.centre(), radius, {ink::grey, 1});
    } else {
        f.frame({box.centre().x - radius, box.centre().y - radius, 2 * radius, 2 * radius}, {ink::grey, 1});
    }
    for (const Light& sample : light_samples(light, count)) {
        const Vec2d p = place(sample);
        f.disc(box.centre() + Vec2d{p.x * radius, p.y * radius}, 3, ink::orange);
    }
    f.text({box.x, box.y + box.h + 19}, name);
}

}  // namespace

void draw_lights(Figure& f, Vec2d at) {
    Light sun;
    sun.direction = {0, -1, 0};
    sun.angular_diameter_deg = soft_sun_deg;
    const double rim = light_samples(sun, 1024).back().direction.y, reach = std::sqrt(1 - rim * rim);
    draw_points(f, {at.x, at.y, 240, 240}, sun, 64, true, "64 directions of a disc", [&](const Light& s) {
        return Vec2d{s.direction.x / reach, s.direction.z / reach};
    });
    Light panel;
    panel.kind = LightKind::area;
    panel.direction = {0, -1, 0};
    panel.across = {1, 0, 0};
    panel.width_m = panel.height_m = 2;
    draw_points(f, {at.x + 260, at.y, 240, 240}, panel, 64, false, "64 points of a square",
                [](const Light& s) {
                    return Vec2d{s.position.x, s.position.z};
                });
    Light ball;
    ball.kind = LightKind::point;
    ball.radius_m = 1;
    draw_points(f, {at.x + 520, at.y, 240, 240}, ball, 64, true, "64 points in a ball, from the side",
                [](const Light& s) {
                    return Vec2d{s.position.x, s.position.y};
                });
}

void draw_cone(Figure& f, const Box& box) {
    f.fill(box, ink::panel);
    const double floor = box.y + box.h - 30, middle = box.centre().x, foot = 22, spread = 0.22;
    const double top = box.y + 16, reach = foot + spread * (floor - top);
    f.polygon({{middle - foot, floor}, {middle - reach, top}, {middle + reach, top}, {middle + foot, floor}},
              ink::yellow, 0.35);
    f.line({middle - foot, floor}, {middle - reach, top}, {ink::orange, 1.5});
    f.line({middle + foot, floor}, {middle + reach, top}, {ink::orange, 1.5});
    f.line({box.x + 10, floor}, {box.x + box.w - 10, floor}, {ink::dark, 1.5});
    for (int i = 0; i < 16; ++i)
        f.disc({middle - foot + 2 * foot * (i + 0.5) / 16, floor}, 2.2, ink::dark);
    // Boxes that the cone meets are walked into; others hold nothing that any part has before the samples.
    const Box near[] = {{middle - 52, box.y + 40, 34, 26}, {middle + 16, box.y + 104, 30, 22}};
    const Box far[] = {{box.x + 18, box.y + 96, 40, 34}, {box.x + box.w - 66, box.y + 138, 46, 28}};
    for (const Box& b : near)
        f.frame(b, {ink::red, 2});
    for (const Box& b : far)
        f.frame(b, {ink::grey, 1.5});
    f.text({box.x, box.y + box.h + 19}, "sixteen samples, and what is asked");
}

}  // namespace obscura
