#include <cmath>

#include "core/error.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

enum Slot : std::uint32_t { step, coping };

/// Wall that follows the flight, with a rounded coping, on the plane x = 0; z runs to -run.
void add_parapet(Mesh& mesh, const StairsParams& p, double x) {
    const double run = p.steps * p.going_m, rise = p.steps * p.rise_m, half = 0.14;
    // The profile lies in (x = -z, y), so that pushing it along its own z and turning it sets it upright.
    const Affine upright = translation(x, 0, 0) * rotation_y(90);
    const std::vector<Vec2d> wall{{0, 0}, {run, 0}, {run, rise + p.parapet_m}, {0, p.parapet_m}};
    add_part(mesh, extrude(wall, -half, half), upright, step);
    const double thick = 0.09, over = 0.05;
    const std::vector<Vec2d> cap{{-over, p.parapet_m - 0.01 - over * rise / run},
                                 {run, rise + p.parapet_m - 0.01},
                                 {run, rise + p.parapet_m + thick},
                                 {-over, p.parapet_m + thick - over * rise / run}};
    add_part(mesh, extrude(cap, -half - 0.04, half + 0.04), upright, coping);
    // Newel at the foot: pier, plate and ball.
    const double y = p.parapet_m + 0.22, w = 0.21;
    add_part(mesh, box({x - w, 0, -w}, {x + w, y, w}), {}, step);
    add_part(mesh, moulding({{-0.1, 0}, {0.03, 0}, {0.05, 0.03}, {0.05, 0.07}, {-0.1, 0.08}}, 2 * w, 2 * w),
             translation(x, y - 0.04, 0), coping);
    std::vector<Vec2d> ball{{0, -0.03}, {0.12, -0.03}, {0.12, 0.03}, {0.06, 0.06}};
    for (int i = 1; i < 16; ++i) {
        const Vec2d c = on_circle(0.5 * i / 16);
        if (c.y * 0.16 > 0.06 || i > 4) ball.push_back({0.16 * c.y, 0.20 - 0.16 * c.x});
    }
    ball.push_back({0, 0.36});
    add_part(mesh, lathe(ball, 32), translation(x, y + 0.03, 0), coping);
}

}  // namespace

GeneratedModel stairs(const StairsParams& p) {
    CHECK(p.steps >= 1 && p.width_m > 0 && p.rise_m > 0.05 && p.going_m > 0);
    GeneratedModel model;
    model.materials = {material_slot("step", 205, 186, 156, 0.85f),
                       material_slot("coping", 228, 212, 186, 0.7f)};
    const double half = 0.5 * p.width_m, tread = 0.045;
    // Body: the stepped profile, pushed across the flight.
    std::vector<Vec2d> profile{{0, 0}, {p.steps * p.going_m, 0}};
    for (int i = p.steps; i > 0; --i) {
        profile.push_back({i * p.going_m, i * p.rise_m - tread + 0.005});
        profile.push_back({(i - 1) * p.going_m, i * p.rise_m - tread + 0.005});
    }
    add_part(model.mesh, extrude(profile, -half - 0.1, half + 0.1), rotation_y(90), step);
    // Treads: slabs with a bevelled nosing. The last one reaches back under the landing.
    for (int i = 0; i < p.steps; ++i) {
        const double back = (i + 1) * p.going_m + 0.02, nose = i * p.going_m - 0.03;
        const std::vector<Vec2d> slab{{nose + 0.008, 0},     {back, 0},
                                      {back, tread},         {nose + 0.012, tread},
                                      {nose, tread - 0.012}, {nose, 0.008}};
        add_part(model.mesh, extrude(slab, -half - 0.05, half + 0.05),
                 translation(0, (i + 1) * p.rise_m - tread, 0) * rotation_y(90), coping);
    }
    if (p.parapet_m > 0) {
        add_parapet(model.mesh, p, -half - 0.14);
        add_parapet(model.mesh, p, half + 0.14);
    }
    return model;
}

}  // namespace obscura
