#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

enum Slot : std::uint32_t { wall, trim };

/// Heights of a column's parts, from the floor up to the springing line.
struct Order {
    double plinth, base, shaft, capital, abacus, springing;
};

Order order_of(const ArcadeParams& p) {
    const double r = p.column_radius_m, impost = 0.16;
    Order o{};
    o.plinth = 0.55 * r;
    o.base = o.plinth + 0.95 * r;
    o.springing = p.column_m;
    o.abacus = p.column_m - impost;
    o.capital = o.abacus - 0.11;
    o.shaft = o.capital - 1.9 * r;
    return o;
}

void add_torus_profile(std::vector<Vec2d>& profile, double radius, double low, double high, int steps) {
    // A half round from (radius, low) to (radius, high), bulging outwards.
    const double half = 0.5 * (high - low);
    for (int i = 0; i <= steps; ++i) {
        const Vec2d c = on_circle(-0.25 + 0.5 * i / steps);
        profile.push_back({radius + half * c.x, low + half + half * c.y});
    }
}

/// Attic base, shaft with entasis, astragal and a bell capital, as one turned stone.
Mesh column(const ArcadeParams& p, const Order& o) {
    const double r = p.column_radius_m, top = 0.86 * r, base = o.base - o.plinth;
    std::vector<Vec2d> profile{{0, o.plinth - 0.01}, {1.3 * r, o.plinth - 0.01}};
    add_torus_profile(profile, 1.28 * r, o.plinth, o.plinth + 0.42 * base, 6);
    profile.push_back({1.14 * r, o.plinth + 0.52 * base});
    profile.push_back({1.10 * r, o.plinth + 0.62 * base});
    add_torus_profile(profile, 1.12 * r, o.plinth + 0.68 * base, o.plinth + 0.90 * base, 5);
    profile.push_back({1.05 * r, o.base});
    // Entasis: straight for a third, then a gentle curve to the neck.
    profile.push_back({r, o.base + 0.25 * r});
    for (int i = 1; i <= 7; ++i) {
        const double t = i / 7.0;
        profile.push_back({r - (r - top) * t * t, o.base + 0.25 * r + (o.shaft - o.base - 0.45 * r) * t});
    }
    add_torus_profile(profile, 1.01 * top, o.shaft - 0.16 * r, o.shaft + 0.08 * r, 5);
    profile.push_back({top, o.shaft + 0.16 * r});
    // The bell opens towards the abacus.
    for (int i = 1; i <= 6; ++i) {
        const double t = i / 6.0;
        const double y = o.shaft + 0.16 * r + (o.capital - o.shaft - 0.36 * r) * t;
        profile.push_back({top + 0.42 * r * t * t * t, y});
    }
    add_torus_profile(profile, top + 0.43 * r, o.capital - 0.16 * r, o.capital, 4);
    profile.push_back({top + 0.36 * r, o.capital + 0.02});
    profile.push_back({0, o.capital + 0.02});
    return lathe(profile, 12 + 12 * p.smoothness, 40);
}

/// Sixteen leaves that hug the bell and curl away under the abacus.
void add_capital_leaves(Mesh& mesh, const ArcadeParams& p, const Order& o, const Affine& at) {
    const double r = p.column_radius_m, top = 0.86 * r, height = o.capital - o.shaft;
    for (int i = 0; i < 16; ++i) {
        const bool upper = i % 2;
        const double low = upper ? 0.42 : 0.14, reach = upper ? 0.50 : 0.30, tip = upper ? 0.80 : 0.56;
        const std::vector<TubePoint> path{{{top + 0.01 * r, o.shaft + low * height, 0}, 0.075 * r},
                                          {{top + 0.09 * r, o.shaft + (low + 0.2) * height, 0}, 0.115 * r},
                                          {{top + 0.6 * reach * r, o.shaft + tip * height, 0}, 0.10 * r},
                                          {{top + reach * r, o.shaft + (tip - 0.05) * height, 0}, 0.05 * r}};
        add_part(mesh, tube(path, 5), at * rotation_y(22.5 * i), trim);
    }
}

void add_column(Mesh& mesh, const ArcadeParams& p, const Order& o, double x) {
    const double r = p.column_radius_m, block = 0.5 * p.wall_m;
    const Affine at = translation(x, 0, 0);
    add_part(mesh, box({-1.55 * r, 0, -1.55 * r}, {1.55 * r, o.plinth, 1.55 * r}), at, trim);
    add_part(mesh, column(p, o), at, trim);
    add_capital_leaves(mesh, p, o, at);
    // Abacus and impost: a slab, a cavetto-like step, and the block that the arches spring from.
    add_part(mesh, box({-1.55 * r, o.capital, -1.55 * r}, {1.55 * r, o.capital + 0.05, 1.55 * r}), at, trim);
    add_part(mesh, box({-1.4 * r, o.capital + 0.04, -block}, {1.4 * r, o.abacus, block}), at, trim);
    add_part(
        mesh,
        box({-1.4 * r - 0.03, o.abacus - 0.01, -block - 0.03}, {1.4 * r + 0.03, o.springing, block + 0.03}),
        at, trim);
}

/// Points of the half circle about (x, y), from its left foot over the crown to its right foot.
std::vector<Vec2d> half_circle(double x, double y, double radius, int segments) {
    std::vector<Vec2d> arc;
    for (int i = 0; i <= segments; ++i) {
        const Vec2d c = on_circle(0.5 - 0.5 * i / segments);
        arc.push_back({x + radius * c.x, y + radius * c.y});
    }
    return arc;
}

/// The wall over all arches: its underside follows them, its top is level.
Mesh spandrels(const ArcadeParams& p, double radius, double springing, double top, double half_length) {
    std::vector<Vec2d> lower{{-half_length, springing}};
    for (int bay = 0; bay < p.bays; ++bay) {
        const double x = (bay - 0.5 * (p.bays - 1)) * p.bay_m;
        for (const Vec2d q : half_circle(x, springing, radius, 16 + 8 * p.smoothness))
            lower.push_back(q);
    }
    lower.push_back({half_length, springing});
    std::vector<Vec2d> upper;
    upper.reserve(lower.size());
    for (const Vec2d q : lower)
        upper.push_back({q.x, top});
    return strip(lower, upper, -0.5 * p.wall_m, 0.5 * p.wall_m, 20);
}

/// Archivolt of two steps, keystone and spandrel roundels, on the front and on the back.
void add_arch_trim(Mesh& mesh, const ArcadeParams& p, double x, double radius, double springing) {
    const int segments = 16 + 8 * p.smoothness;
    const auto ring = [&](double inner, double outer) {
        return strip(half_circle(0, 0, inner, segments), half_circle(0, 0, outer, segments), -0.1, 0, 20);
    };
    const std::vector<Vec2d> key{
        {-0.065, radius - 0.05}, {0.065, radius - 0.05}, {0.10, radius + 0.27}, {-0.10, radius + 0.27}};
    for (const double turn : {0.0, 180.0}) {
        const Affine face = rotation_y(turn) * translation(turn > 0 ? -x : x, springing, 0.5 * p.wall_m);
        add_part(mesh, ring(radius - 0.012, radius + 0.11), face * translation(0, 0, 0.025), trim);
        add_part(mesh, ring(radius + 0.10, radius + 0.19), face * translation(0, 0, 0.05), trim);
        add_part(mesh, extrude(key, -0.1, 0.09), face, trim);
    }
}

void add_roundel(Mesh& mesh, const ArcadeParams& p, double x, double y, double radius) {
    const Affine at = translation(x, y, 0.5 * p.wall_m) * rotation_x(90);
    add_part(mesh, torus(radius, std::min(0.03, 0.35 * radius), 32, 10), at * translation(0, 0.005, 0), trim);
    add_part(
        mesh,
        lathe({{0, -0.05}, {0.62 * radius, -0.05}, {0.62 * radius, 0.008}, {0.3 * radius, 0.04}, {0, 0.05}},
              32),
        at, trim);
}

}  // namespace

GeneratedModel arcade(const ArcadeParams& p) {
    CHECK(p.bays >= 1 && p.smoothness >= 1 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {material_slot("wall", 222, 196, 158, 0.9f),
                       material_slot("trim", 232, 214, 184, 0.75f)};
    const Order o = order_of(p);
    const double pier = 1.4 * p.column_radius_m;  // half the impost's width: what the arches leave free
    const double radius = 0.5 * p.bay_m - pier, half_length = 0.5 * p.bays * p.bay_m + pier;
    const double top = o.springing + radius + p.above_m;

    for (int i = 0; i <= p.bays; ++i)
        add_column(model.mesh, p, o, (i - 0.5 * p.bays) * p.bay_m);
    add_part(model.mesh, spandrels(p, radius, o.springing - 0.002, top, half_length), {}, wall);
    for (int bay = 0; bay < p.bays; ++bay) {
        add_arch_trim(model.mesh, p, (bay - 0.5 * (p.bays - 1)) * p.bay_m, radius, o.springing);
    }
    const double roundel = 0.19 * radius;
    for (int i = 1; i < p.bays; ++i) {
        add_roundel(model.mesh, p, (i - 0.5 * p.bays) * p.bay_m, o.springing + 0.86 * radius, roundel);
    }
    // Cornice: fillet, ovolo, fascia, top fillet.
    const std::vector<Vec2d> profile{{-0.1, 0},     {0.03, 0},    {0.03, 0.05},  {0.055, 0.06},
                                     {0.09, 0.10},  {0.10, 0.15}, {0.17, 0.155}, {0.17, 0.22},
                                     {0.20, 0.225}, {0.20, 0.26}, {-0.1, 0.27}};
    add_part(model.mesh, moulding(profile, 2 * half_length, p.wall_m), translation(0, top - 0.2, 0), trim);
    return model;
}

}  // namespace obscura
