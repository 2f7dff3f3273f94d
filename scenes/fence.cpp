#include <cmath>

#include "core/error.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// Bar from the ground to its spear, turned in one piece.
Mesh bar(const FenceParams& p) {
    const double r = p.bar_radius_m, collar = p.height_m - 0.20;
    return lathe({{0, 0.02},
                  {r, 0.02},
                  {r, collar},
                  {1.9 * r, collar + 0.008},
                  {1.9 * r, collar + 0.022},
                  {0.9 * r, collar + 0.034},
                  {1.3 * r, collar + 0.06},
                  {2.3 * r, collar + 0.095},
                  {1.5 * r, collar + 0.14},
                  {0, p.height_m}},
                 6, 50);
}

Mesh post(const FenceParams& p) {
    const double r = 3.2 * p.bar_radius_m, top = p.height_m + 0.02;
    std::vector<Vec2d> profile{{0, 0},        {2.6 * r, 0},    {2.6 * r, 0.03},       {1.3 * r, 0.06},
                               {r, 0.10},     {r, top - 0.06}, {1.6 * r, top - 0.05}, {1.6 * r, top - 0.02},
                               {0.8 * r, top}};
    const double ball = 1.9 * r;
    for (int i = 3; i < 12; ++i) {
        const Vec2d c = on_circle(0.5 * i / 12);
        profile.push_back({ball * c.y, top + 0.8 * ball - ball * c.x});
    }
    profile.push_back({0, top + 1.8 * ball});
    return lathe(profile, 16, 40);
}

}  // namespace

GeneratedModel fence(const FenceParams& p) {
    CHECK(p.length_m > 0.2 && p.height_m > 0.6 && p.bar_radius_m > 0.001 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {material_slot("iron", 46, 48, 50, 0.45f)};
    model.materials[0].metallic = 0.6f;
    const double half = 0.5 * p.length_m;
    const int fields =
        static_cast<int>(std::floor(p.length_m / p.post_every_m + 0.5)) + (p.length_m < 0.5 * p.post_every_m);
    const Mesh one_post = post(p), one_bar = bar(p);
    for (int i = 0; i <= fields; ++i) {
        add_part(model.mesh, one_post, translation(-half + p.length_m * i / fields, 0, 0));
    }
    const int bars = static_cast<int>(std::floor(p.length_m / fields / p.spacing_m));
    for (int field = 0; field < fields; ++field) {
        for (int i = 1; i < bars; ++i) {
            const double x = -half + p.length_m * (field + static_cast<double>(i) / bars) / fields;
            add_part(model.mesh, one_bar, translation(x, 0, 0));
        }
    }
    const double thick = 1.5 * p.bar_radius_m;
    for (const double y : {0.12, p.height_m - 0.36, p.height_m - 0.24}) {
        add_part(model.mesh, box({-half, y, -0.7 * thick}, {half, y + 2 * thick, 0.7 * thick}), {});
    }
    // Rings between the two upper rails.
    const double ring = 0.5 * (0.12 - 2 * thick) - 0.002;
    if (ring > 0.012) {
        const Mesh one = torus(ring, 0.35 * ring, 10, 5);
        for (int k = 0; k < fields * bars; ++k) {
            const double x = -half + p.length_m * (k + 0.5) / (fields * bars);
            add_part(model.mesh, one, translation(x, p.height_m - 0.30 + thick, 0) * rotation_x(90));
        }
    }
    return model;
}

}  // namespace obscura
