// What stands in a town, in levels of detail: 0 bodies and roofs, 1 cornices, chimneys and huts, 2 windows,
// 3 sills and storey bands, 4 lintels and glazing bars, 5 dentils and balconies, 6 railings, gutters and
// vents.

#include "scenes/city_building.h"

#include <algorithm>
#include <cmath>

#include "scenes/build.h"
#include "scenes/facade.h"
#include "scenes/foliage.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

using namespace city_slot;

/// One storeyed box of a building; towers are piles of them.
struct Tier {
    double width_m, depth_m, base_m;
    int storeys;
    double storey_m, plinth_m;
    bool side_windows;
    double height() const { return plinth_m + storeys * storey_m + 0.4; }
};

BodyParams body_of(const Tier& t, int level) {
    BodyParams b;
    b.width_m = t.width_m, b.depth_m = t.depth_m, b.height_m = t.height();
    if (level < 2) return b;
    const double window = 1.15;
    const auto count = [&](double length) { return std::max(1, static_cast<int>(std::floor(length / 2.7))); };
    b.wide.columns = even_openings(t.width_m, count(t.width_m), window);
    if (t.side_windows) b.deep.columns = even_openings(t.depth_m, count(t.depth_m), window);
    for (int s = 0; s < t.storeys; ++s) {
        const double floor = t.plinth_m + s * t.storey_m;
        b.wide.rows.push_back({floor + 0.28 * t.storey_m, floor + 0.82 * t.storey_m});
    }
    b.deep.rows = b.wide.rows;
    return b;
}

/// Balcony before a window: slab, and from level 6 a railing of thin bars.
void add_balcony(Mesh& m, const Affine& here, double w, int level) {
    const double x0 = -0.25, x1 = w + 0.25, deep = 0.95;
    add_part(m, box({x0, -0.62, -0.1}, {x1, -0.50, deep}), here, trim);
    if (level < 6) return;
    for (const double x : {x0 + 0.04, x1 - 0.08})
        add_part(m, box({x, 0.42, -0.05}, {x + 0.04, 0.46, deep - 0.05}), here, metal);
    add_part(m, box({x0 + 0.04, 0.42, deep - 0.09}, {x1 - 0.04, 0.46, deep - 0.05}), here, metal);
    const int bars = static_cast<int>((x1 - x0) / 0.14);
    for (int i = 0; i <= bars; ++i) {
        const double x = x0 + 0.05 + (x1 - x0 - 0.13) * i / bars;
        add_part(m, box({x, -0.52, deep - 0.085}, {x + 0.02, 0.43, deep - 0.065}), here, metal);
    }
}

void add_window_trim(Mesh& m, const BodyParams& b, Vec2d u, Vec2d v, const Affine& front, int level,
                     bool balcony) {
    const double w = u.y - u.x, h = v.y - v.x, in = b.reveal_m;
    const Affine here = front * translation(u.x, v.x, 0);
    if (!balcony || level < 5) add_part(m, box({-0.10, -0.12, -0.1}, {w + 0.10, 0.015, 0.10}), here, trim);
    if (level >= 4) {
        add_part(m, box({-0.12, h - 0.01, -0.1}, {w + 0.12, h + 0.24, 0.05}), here, trim);
        add_part(m, box({0.5 * w - 0.035, -0.005, -in - 0.02}, {0.5 * w + 0.035, h + 0.005, -in + 0.05}),
                 here, trim);
        add_part(m, box({-0.005, 0.62 * h, -in - 0.02}, {w + 0.005, 0.62 * h + 0.06, -in + 0.04}), here,
                 trim);
    }
    if (level >= 5 && balcony) add_balcony(m, here, w, level);
    if (level >= 6) {
        add_part(m, box({-0.16, h + 0.22, -0.1}, {w + 0.16, h + 0.30, 0.11}), here, trim);
        for (const double x : {-0.01, w - 0.045})
            add_part(m, box({x, -0.01, -in - 0.02}, {x + 0.055, h + 0.01, -in + 0.045}), here, trim);
    }
}

/// Profiled cornice around the top; level 5 hangs dentils under it.
void add_cornice(Mesh& m, const Tier& t, int level, double top) {
    const Affine at = translation(0, top - 0.5, 0);
    add_part(m,
             moulding({{-0.15, 0}, {0.08, 0.02}, {0.22, 0.22}, {0.30, 0.24}, {0.30, 0.44}, {-0.15, 0.46}},
                      t.width_m, t.depth_m),
             at, trim);
    if (level < 5) return;
    for (int side = 0; side < 4; ++side) {
        const double length = side % 2 ? t.depth_m : t.width_m,
                     out = 0.5 * (side % 2 ? t.width_m : t.depth_m);
        if (side % 2 && !t.side_windows) continue;
        const int count = static_cast<int>(length / 0.7);
        for (int i = 0; i < count; ++i) {
            const double x = -0.5 * length + length * (i + 0.5) / count;
            add_part(m, box({x - 0.11, -0.16, out - 0.05}, {x + 0.11, 0.10, out + 0.13}),
                     at * rotation_y(90 * side), trim);
        }
    }
}

void add_tier(Mesh& m, const Tier& t, int level, std::uint32_t tint, Random random) {
    const Affine base = translation(0, t.base_m, 0);
    const BodyParams b = body_of(t, level);
    Mesh body = building_body(b, tint, pane);
    // Some rooms are lit. A pane is one facet of two triangles.
    for (std::size_t i = 0; i + 1 < body.triangles.size(); ++i) {
        if (body.material[i] == pane && body.material[i + 1] == pane) {
            const bool lit = random.chance(0.14);
            body.material[i] = body.material[i + 1] = lit ? pane_lit : pane;
            ++i;
        }
    }
    add_parts(m, body, base, 0);
    if (level >= 1) add_cornice(m, t, level, t.base_m + t.height());
    if (level < 3) return;
    add_part(m, moulding({{-0.1, 0}, {0.07, 0.01}, {0.07, 0.16}, {-0.1, 0.18}}, t.width_m, t.depth_m),
             base * translation(0, t.plinth_m + t.storey_m, 0), trim);
    for (int side = 0; side < 4; ++side) {
        const bool wide = side % 2 == 0;
        const double length = wide ? t.width_m : t.depth_m, out = 0.5 * (wide ? t.depth_m : t.width_m);
        const Affine front = base * rotation_y(90 * side) * translation(-0.5 * length, 0, out);
        const std::vector<Vec2d>& columns = (wide ? b.wide : b.deep).columns;
        const std::size_t balconies =
            columns.empty() ? 0 : static_cast<std::size_t>(random.index(static_cast<int>(columns.size())));
        for (std::size_t i = 0; i < columns.size(); ++i) {
            for (std::size_t j = 0; j < b.wide.rows.size(); ++j) {
                add_window_trim(m, b, columns[i], b.wide.rows[j], front, level,
                                side == 0 && j > 0 && i % 3 == balconies % 3);
            }
        }
    }
}

void add_chimney(Mesh& m, double x, double z, double low, double high, int level) {
    add_part(m, box({x - 0.4, low, z - 0.3}, {x + 0.4, high, z + 0.3}), {}, facade + 1);
    if (level >= 3)
        add_part(m, box({x - 0.46, high - 0.01, z - 0.36}, {x + 0.46, high + 0.1, z + 0.36}), {}, trim);
    if (level >= 4) {
        for (const double s : {-0.18, 0.18})
            add_part(m, frustum(0.11, 0.09, 0.4, 8), translation(x + s, high + 0.08, z), roof_tile);
    }
}

/// Saddle roof with its ridge along the street, thick eaves, and from level 5 dormers.
void add_saddle_roof(Mesh& m, const Tier& t, int level, Random& random) {
    const double top = t.base_m + t.height() - 0.02, d = 0.5 * t.depth_m + 0.35,
                 rise = d * random.range(0.6, 0.95), w = 0.5 * t.width_m;
    const std::uint32_t slot = random.chance(0.7) ? roof_tile : roof_slate;
    add_part(m, extrude({{-d, 0}, {d, 0}, {d, 0.12}, {0, rise}, {-d, 0.12}}, -w, w),
             translation(0, top, 0) * rotation_y(90), slot);
    if (level >= 1)
        add_chimney(m, random.range(-0.7, 0.7) * w, random.range(-0.3, 0.3) * d, top - 0.1, top + rise + 0.9,
                    level);
    if (level >= 4)
        add_part(m, tube({{{-w + 0.01, top + rise, 0}, 0.13}, {{w - 0.01, top + rise, 0}, 0.13}}, 8), {},
                 slot);
    if (level < 5) return;
    const int dormers = static_cast<int>(t.width_m / 3.8);
    for (int i = 0; i < dormers; ++i) {
        const double x = t.width_m * ((i + 0.5) / dormers - 0.5), z = 0.55 * d,
                     y = top + 0.12 + (rise - 0.12) * (1 - z / d) - 0.15;
        add_part(m, box({x - 0.6, y, 0.1 * d}, {x + 0.6, y + 1.35, z + 0.25}), {}, facade);
        add_part(m, box({x - 0.4, y + 0.35, z}, {x + 0.4, y + 1.2, z + 0.27}), {}, pane);
        add_part(m, extrude({{-0.75, 0}, {0.75, 0}, {0, 0.55}}, 0.05 * d, z + 0.4),
                 translation(x, y + 1.33, 0), slot);
    }
    for (const double z : {-d, d})
        add_part(m, tube({{{-w, top + 0.05, z}, 0.07}, {{w, top + 0.05, z}, 0.07}}, 6), {}, metal);
}

/// Water tank on four legs: staves, conical lid, from level 4 hoops.
void add_tank(Mesh& m, double x, double z, double roof, int level) {
    const Affine at = translation(x, roof, z);
    for (const double sx : {-0.8, 0.8}) {
        for (const double sz : {-0.8, 0.8})
            add_part(m, box({sx - 0.08, -0.05, sz - 0.08}, {sx + 0.08, 1.9, sz + 0.08}), at, metal);
    }
    add_part(m, box({-1.1, 1.85, -1.1}, {1.1, 2.0, 1.1}), at, metal);
    add_part(m, frustum(1.25, 1.15, 2.3, 16), at * translation(0, 1.99, 0), wood);
    add_part(m, frustum(1.3, 0, 0.8, 16), at * translation(0, 4.27, 0), roof_slate);
    if (level < 4) return;
    for (const double y : {2.3, 3.0, 3.7})
        add_part(m, torus(1.24 - 0.04 * (y - 2), 0.035, 16, 4), at * translation(0, y, 0), metal);
}

/// Parapet, stair hut, tank, vents.
void add_flat_roof(Mesh& m, const Tier& t, int level, Random& random) {
    const double top = t.base_m + t.height(), w = 0.5 * t.width_m, d = 0.5 * t.depth_m;
    if (level < 1) return;
    add_part(m,
             moulding({{-0.30, -0.06}, {-0.01, -0.06}, {-0.01, 0.85}, {-0.30, 0.85}}, t.width_m, t.depth_m),
             translation(0, top, 0), trim);
    add_part(m, box({-w + 0.25, top - 0.05, -d + 0.25}, {w - 0.25, top + 0.03, d - 0.25}), {}, roof_flat);
    const double x = random.range(-0.4, 0.4) * w, z = random.range(-0.3, 0.1) * d;
    add_part(m, box({x - 1.4, top - 0.05, z - 1.2}, {x + 1.4, top + 2.5, z + 1.2}), {}, facade + 3);
    if (level >= 2 && t.storeys >= 4 && std::min(w, d) > 4)
        add_tank(m, x > 0 ? -0.5 * w : 0.5 * w, 0.35 * d, top, level);
    if (level < 3) return;
    for (int i = 0; i < 2 * (level - 2); ++i) {
        const double vx = random.range(-0.8, 0.8) * w, vz = random.range(-0.8, 0.8) * d,
                     s = random.range(0.25, 0.7);
        if (std::fabs(vx - x) < 2.2 && std::fabs(vz - z) < 2) continue;
        add_part(m, box({vx - s, top - 0.02, vz - s}, {vx + s, top + 1.4 * s, vz + s}), {}, metal);
        if (level >= 5)
            add_part(m, cylinder(0.7 * s, 0.12, 12), translation(vx, top + 1.4 * s - 0.02, vz), metal);
    }
}

/// A pile of tiers that step back, with a crown.
void add_tower(Mesh& m, const CityItem& item, int level, Random& random) {
    Tier t{item.width_m, item.depth_m, 0, 2 + random.index(2), 4.2, 1.0, true};
    const std::uint32_t tint = facade + 3 + static_cast<std::uint32_t>(random.index(3));
    const int tiers = 3 + random.index(2);
    double grip = 0.72;
    for (int i = 0; i < tiers; ++i) {
        add_tier(m, t, level, tint, random.fork(static_cast<std::uint64_t>(i)));
        if (i + 1 == tiers) break;
        if (level >= 1)
            add_part(m,
                     box({-0.5 * t.width_m + 0.2, t.base_m + t.height() - 0.05, -0.5 * t.depth_m + 0.2},
                         {0.5 * t.width_m - 0.2, t.base_m + t.height() + 0.03, 0.5 * t.depth_m - 0.2}),
                     {}, roof_flat);
        t.base_m += t.height() - 0.05;
        t.width_m *= grip, t.depth_m *= grip;
        t.storeys = i == 0 ? 7 + random.index(9) : 3 + random.index(5), t.storey_m = 3.4, t.plinth_m = 0.3;
        grip = random.range(0.7, 0.86);
    }
    if (random.chance(0.5)) {
        const double top = t.base_m + t.height(), r = 0.42 * std::min(t.width_m, t.depth_m);
        add_part(m,
                 lathe({{0, -0.05},
                        {r, -0.05},
                        {r, 0.6},
                        {0.9 * r, 1.0},
                        {0.62 * r, 2.2 * r},
                        {0.12 * r, 3.2 * r},
                        {0, 5 * r}},
                       level < 3 ? 8 : 16),
                 translation(0, top, 0), roof_slate);
    } else {
        add_flat_roof(m, t, level, random);
    }
}

Mesh build_tree(const CityItem& item, int level) {
    Mesh m;
    if (level == 0) return m;
    Random random(item.seed);
    const double high = item.width_m < 5 ? random.range(5.0, 6.5) : random.range(7.0, 11.0),
                 r = (item.width_m < 5 ? 0.26 : 0.34) * high;
    add_part(
        m, tube({{{0, -0.05, 0}, 0.03 * high}, {{0.05, 0.5 * high, 0.02}, 0.018 * high}}, level < 4 ? 4 : 8),
        {}, bark);
    const int lumps = level < 3 ? 1 : level < 5 ? 4 : 7;
    for (int i = 0; i < lumps; ++i) {
        const Vec3d off = random_direction(random) * (lumps > 1 ? 0.5 * r : 0.0);
        const double size = lumps > 1 ? r * random.range(0.5, 0.75) : r;
        const int around = level < 2 ? 6 : level < 4 ? 9 : 14;
        add_part(m, sphere(size, around, around / 2 + 1),
                 translation(off.x, high - r + 0.8 * off.y, off.z) * rotation_y(random.range(0, 90)) *
                     scaling({1, 0.95, 1}),
                 leaf);
    }
    if (level < 6) return m;
    for (int i = 0; i < 700; ++i) {
        const Vec3d d = random_direction(random), along = normalize(d + random_direction(random) * 0.8);
        const Vec3d up = normalize(Vec3d{0, 1, 0} + random_direction(random) * 0.6);
        if (std::fabs(dot(along, up)) > 0.97) continue;
        add_leaf(m, Vec3d{0, high - r, 0} + d * (r * random.range(0.75, 1.12)), along, up,
                 random.range(0.25, 0.4), leaf);
    }
    return m;
}

Mesh build_lamp(int level) {
    Mesh m;
    if (level < 2) return m;
    add_part(m, frustum(0.09, 0.05, 4.6, level < 4 ? 6 : 12), {}, metal);
    add_part(m, box({-0.06, 4.5, -0.06}, {0.06, 4.62, 0.9}), {}, metal);
    add_part(m, box({-0.16, 4.42, 0.55}, {0.16, 4.54, 1.05}), {}, metal);
    if (level >= 4)
        add_part(m, lathe({{0, 0}, {0.18, 0}, {0.16, 0.5}, {0.08, 0.6}, {0, 0.62}}, 12), {}, metal);
    return m;
}

}  // namespace

Mesh build_city_item(const CityItem& item, int level) {
    if (item.kind == CityItemKind::tree) return build_tree(item, level);
    if (item.kind == CityItemKind::lamp) return build_lamp(level);
    Mesh m;
    Random random(item.seed);
    if (item.kind == CityItemKind::tower) {
        add_tower(m, item, level, random);
        return m;
    }
    const bool flat = item.kind == CityItemKind::slab;
    const std::uint32_t tint = facade + static_cast<std::uint32_t>(random.index(6));
    const int storeys = flat ? 4 + random.index(4) : 3 + random.index(3);
    const Tier t{item.width_m,           item.depth_m, 0, storeys, random.range(3.0, 3.5),
                 random.range(0.3, 0.9), item.detached};
    add_tier(m, t, level, tint, random.fork(7));
    if (flat) {
        add_flat_roof(m, t, level, random);
    } else {
        add_saddle_roof(m, t, level, random);
    }
    return m;
}

}  // namespace obscura
