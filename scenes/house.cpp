#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/facade.h"
#include "scenes/generators.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

enum Slot : std::uint32_t { plaster, trim, pane, shutter, roof, tile_pale };

struct Plan {
    HouseParams p;
    BodyParams body;
};

Plan plan_of(const HouseParams& p) {
    Plan plan{p, {}};
    BodyParams& b = plan.body;
    b.width_m = p.width_m, b.depth_m = p.depth_m, b.height_m = p.storeys * p.storey_m + 0.5;
    if (p.detail < 2) return plan;
    const double window = 0.40 * p.bay_m < 1.15 ? 0.40 * p.bay_m : 1.15;
    const auto count = [&](double length) { return static_cast<int>(std::floor(length / p.bay_m + 0.25)); };
    b.wide.columns = even_openings(p.width_m, count(p.width_m), window);
    if (p.fronts > 1) b.deep.columns = even_openings(p.depth_m, count(p.depth_m), window);
    for (int s = 0; s < p.storeys; ++s) {
        b.wide.rows.push_back({s * p.storey_m + 0.26 * p.storey_m, s * p.storey_m + 0.80 * p.storey_m});
    }
    b.deep.rows = b.wide.rows;
    return plan;
}

/// Louvred shutter leaf, hinged open: frame and slats, its hinge edge at x = 0, reaching to +x, on z = 0.
void add_shutter(Mesh& m, double width, double height, const Affine& at) {
    const double stile = 0.07, thick = 0.045;
    add_part(m, box({0, 0, 0.01}, {stile, height, 0.01 + thick}), at, shutter);
    add_part(m, box({width - stile, 0, 0.01}, {width, height, 0.01 + thick}), at, shutter);
    for (const double y : {0.0, 0.5 * height - 0.05, height - 0.1}) {
        add_part(m, box({0.5 * stile, y, 0.015}, {width - 0.5 * stile, y + 0.1, 0.005 + thick}), at, shutter);
    }
    const int slats = static_cast<int>(height / 0.085);
    for (int i = 1; i < slats; ++i) {
        const Affine tilt = translation(0, height * i / slats, 0.01 + 0.5 * thick) * rotation_x(40);
        add_part(m, box({0.5 * stile, -0.028, -0.006}, {width - 0.5 * stile, 0.028, 0.006}), at * tilt,
                 shutter);
    }
}

/// Sill, lintel, glazing bars and shutters of one window; `at` takes (along the front, up, out of it) to the
/// world.
void add_window(Mesh& m, const Plan& plan, Vec2d u, Vec2d v, const Affine& at, double swing) {
    const double w = u.y - u.x, h = v.y - v.x, in = plan.body.reveal_m;
    const Affine here = at * translation(u.x, v.x, 0);
    add_part(
        m,
        extrude({{-0.1, -0.10}, {0.12, -0.10}, {0.14, -0.06}, {0.14, -0.02}, {-0.1, 0.015}}, -0.1, w + 0.1),
        here * rotation_y(-90) * scaling({1, 1, -1}), trim);
    add_part(m,
             extrude({{-0.1, -0.005}, {0.05, -0.005}, {0.05, 0.14}, {0.11, 0.19}, {0.11, 0.23}, {-0.1, 0.26}},
                     -0.12, w + 0.12),
             here * translation(0, h, 0) * rotation_y(-90) * scaling({1, 1, -1}), trim);
    if (plan.p.detail < 4) return;
    const double z0 = -in - 0.01, z1 = -in + 0.05;
    for (const double x : {-0.01, w - 0.05})
        add_part(m, box({x, -0.01, z0}, {x + 0.06, h + 0.01, z1}), here, trim);
    add_part(m, box({0.5 * w - 0.04, 0, z0}, {0.5 * w + 0.04, h, z1 + 0.01}), here, trim);
    for (const double y : {0.0, 0.36 * h, 0.68 * h, h - 0.06}) {
        add_part(m, box({0, y, z0 + 0.002}, {w, y + 0.05, z1 - 0.01}), here, trim);
    }
    add_shutter(m, 0.5 * w, h,
                here * translation(-0.012, 0, 0.02) * rotation_y(-180 + swing) * scaling({1, 1, -1}));
    add_shutter(m, 0.5 * w, h, here * translation(w + 0.012, 0, 0.02) * rotation_y(-0.6 * swing));
}

/// Hip roof with eaves: slab below, hips above, as one closed solid.
Mesh hip_roof(double w, double d, double eaves, double rise) {
    const double x = 0.5 * w + eaves, z = 0.5 * d + eaves, ridge = x > z ? x - z : 0.02;
    const Vec3d low[4] = {{-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z}};
    const Vec3d high[4] = {{-x, 0.14, z}, {x, 0.14, z}, {x, 0.14, -z}, {-x, 0.14, -z}};
    const Vec3d left{-ridge, 0.14 + rise, 0}, right{ridge, 0.14 + rise, 0};
    Mesh m;
    for (int k = 0; k < 4; ++k)
        add_facet(m, {low[k], low[(k + 1) % 4], high[(k + 1) % 4], high[k]});
    add_facet(m, {low[3], low[2], low[1], low[0]});
    add_facet(m, {high[0], high[1], right, left});
    add_facet(m, {high[1], high[2], right});
    add_facet(m, {high[2], high[3], left, right});
    add_facet(m, {high[3], high[0], left});
    return m;
}

void add_roof(Mesh& m, const HouseParams& p, double top, Random& random) {
    const std::vector<Vec2d> cornice{{-0.2, 0},    {0.03, 0},    {0.03, 0.07}, {0.08, 0.09}, {0.12, 0.15},
                                     {0.20, 0.17}, {0.20, 0.25}, {0.24, 0.26}, {0.24, 0.32}, {-0.2, 0.33}};
    if (p.detail >= 1)
        add_part(m, moulding(cornice, p.width_m, p.depth_m), translation(0, top - 0.32, 0), trim);
    if (p.roof_m > 0) {
        add_part(m, hip_roof(p.width_m, p.depth_m, 0.5, p.roof_m), translation(0, top - 0.01, 0), roof);
    } else {
        add_part(m,
                 moulding({{-0.3, -0.05},
                           {0.0, -0.05},
                           {0.0, 0.7},
                           {0.05, 0.71},
                           {0.05, 0.79},
                           {-0.35, 0.80},
                           {-0.35, 0.71},
                           {-0.3, 0.70}},
                          p.width_m, p.depth_m),
                 translation(0, top, 0), plaster);
    }
    for (int i = 0; i < 1 + (p.width_m > 9); ++i) {
        const double x = (i ? 0.27 : -0.3) * p.width_m + random.range(-0.5, 0.5),
                     z = random.range(-0.1, 0.1) * p.depth_m, h = top + 0.75 * p.roof_m + 1.1;
        add_part(m, box({x - 0.35, top - 0.2, z - 0.28}, {x + 0.35, h, z + 0.28}), {}, plaster);
        add_part(m, box({x - 0.41, h - 0.02, z - 0.34}, {x + 0.41, h + 0.08, z + 0.34}), {}, trim);
        for (const double s : {-0.17, 0.17})
            add_part(m, frustum(0.10, 0.085, 0.3, 12), translation(x + s, h + 0.06, z), tile_pale);
    }
}

}  // namespace

GeneratedModel house(const HouseParams& p) {
    CHECK(p.width_m > 3 && p.depth_m > 3 && p.storeys >= 1 && p.storey_m > 2 && p.bay_m > 1.2 &&
          p.roof_m >= 0 && p.detail >= 0);
    GeneratedModel model;
    model.materials = {
        material_slot("plaster", 226, 190, 140, 0.9f), material_slot("trim", 236, 222, 196, 0.8f),
        material_slot("pane", 40, 48, 56, 0.08f),      material_slot("shutter", 86, 116, 104, 0.6f),
        material_slot("roof", 178, 104, 74, 0.85f),    material_slot("chimney_pot", 200, 130, 96, 0.85f)};
    Random random(static_cast<std::uint64_t>(p.seed));
    const Plan plan = plan_of(p);
    const Mesh body = building_body(plan.body, plaster, pane);
    add_parts(model.mesh, body, {}, 0);
    add_roof(model.mesh, p, plan.body.height_m, random);
    if (p.detail >= 1) {
        for (int s = 1; s < p.storeys; ++s) {
            add_part(model.mesh,
                     moulding({{-0.1, 0}, {0.05, 0}, {0.05, 0.10}, {0.09, 0.13}, {0.09, 0.17}, {-0.1, 0.19}},
                              p.width_m, p.depth_m),
                     translation(0, s * p.storey_m, 0), trim);
        }
        add_part(model.mesh,
                 moulding({{-0.1, -0.1}, {0.06, -0.1}, {0.06, 0.42}, {0.0, 0.46}, {-0.1, 0.46}}, p.width_m,
                          p.depth_m),
                 {}, trim);
    }
    if (p.detail < 3) return model;
    for (int side = 0; side < std::min(p.fronts, 4); ++side) {
        const bool wide = side % 2 == 0;
        const double length = wide ? p.width_m : p.depth_m, out = 0.5 * (wide ? p.depth_m : p.width_m);
        const Affine front = rotation_y(90 * side) * translation(-0.5 * length, 0, out);
        for (const Vec2d u : (wide ? plan.body.wide : plan.body.deep).columns) {
            for (const Vec2d v : plan.body.wide.rows) {
                add_window(model.mesh, plan, u, v, front,
                           random.chance(0.75) ? random.range(6, 14) : random.range(40, 100));
            }
        }
    }
    return model;
}

}  // namespace obscura
