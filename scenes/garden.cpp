// What stands about in a courtyard: lamp, planter, bench, fountain.

#include <cmath>

#include "core/error.h"
#include "scenes/foliage.h"
#include "scenes/generators.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

double lantern_base(const LampPostParams& p) {
    return p.height_m - 2.15 * p.lantern_m;
}

/// Eight-sided pedestal, turned shaft with rings, and a plate for the lantern.
void add_lamp_shaft(Mesh& mesh, const LampPostParams& p) {
    const double top = lantern_base(p);
    add_part(mesh,
             lathe({{0, 0},
                    {0.21, 0},
                    {0.21, 0.06},
                    {0.17, 0.09},
                    {0.155, 0.12},
                    {0.14, 0.52},
                    {0.165, 0.54},
                    {0.165, 0.58},
                    {0, 0.60}},
                   8, 20),
             {});
    std::vector<Vec2d> shaft{{0, 0.55},     {0.10, 0.55},  {0.105, 0.62}, {0.075, 0.70},
                             {0.055, 0.82}, {0.068, 0.86}, {0.068, 0.90}, {0.050, 0.93}};
    shaft.insert(shaft.end(),
                 {{0.038, top - 0.42}, {0.055, top - 0.40}, {0.055, top - 0.37}, {0.036, top - 0.34}});
    shaft.insert(shaft.end(), {{0.036, top - 0.12},
                               {0.07, top - 0.05},
                               {0.36 * p.lantern_m, top - 0.02},
                               {0.36 * p.lantern_m, top},
                               {0, top + 0.01}});
    add_part(mesh, lathe(shaft, 20, 30), {});
    // The bar that the lamplighter's ladder leaned on.
    for (const double side : {-1.0, 1.0}) {
        add_part(mesh, tube({{{0, top - 0.385, 0}, 0.012}, {{side * 0.24, top - 0.385, 0}, 0.012}}, 8), {});
        add_part(mesh, sphere(0.024, 12, 8), translation(side * 0.25, top - 0.385, 0));
    }
}

/// Cage of six bars that lean outwards, ring, roof, chimney and finial.
void add_lantern(Mesh& mesh, const LampPostParams& p) {
    const double low = lantern_base(p), high = low + 1.15 * p.lantern_m, r0 = 0.33 * p.lantern_m,
                 r1 = 0.5 * p.lantern_m;
    for (int i = 0; i < 6; ++i) {
        const Vec2d c = on_circle(i / 6.0), d = on_circle((i + 1) / 6.0);
        const Vec3d foot{r0 * c.x, low - 0.01, r0 * c.y}, head{r1 * c.x, high + 0.01, r1 * c.y};
        add_part(mesh, tube({{foot, 0.008}, {head, 0.008}}, 6), {});
        add_part(
            mesh,
            tube({{{r0 * c.x, low + 0.012, r0 * c.y}, 0.009}, {{r0 * d.x, low + 0.012, r0 * d.y}, 0.009}}, 6),
            {});
        add_part(mesh, tube({{head, 0.011}, {{r1 * d.x, high + 0.01, r1 * d.y}, 0.011}}, 6), {});
    }
    const double rim = 1.12 * r1;
    add_part(mesh,
             lathe({{0, high + 0.005},
                    {rim, high + 0.005},
                    {rim, high + 0.02},
                    {0.42 * rim, high + 0.5 * p.lantern_m},
                    {0, high + 0.5 * p.lantern_m}},
                   6, 10),
             rotation_y(0));
    const double y = high + 0.5 * p.lantern_m - 0.01, q = 0.3 * rim;
    add_part(mesh,
             lathe({{0, y},
                    {q, y},
                    {q, y + 0.05},
                    {1.5 * q, y + 0.06},
                    {1.4 * q, y + 0.085},
                    {0.3 * q, y + 0.13},
                    {0.5 * q, y + 0.16},
                    {0, p.height_m}},
                   16, 30),
             {});
}

/// A ball of leaves.
void add_shrub(Mesh& mesh, Vec3d centre, double radius_m, int leaves, std::uint32_t slot, Random& random) {
    for (int i = 0; i < leaves; ++i) {
        const Vec3d d = random_direction(random);
        const double depth = radius_m * std::sqrt(std::sqrt(random.range(0.05, 1.0)));
        const Vec3d along = normalize(d + random_direction(random) * 0.8);
        const Vec3d up = normalize(d + random_direction(random) * 0.6);
        if (std::fabs(dot(along, up)) > 0.97) continue;
        add_leaf(mesh, centre + d * depth, along, up, random.range(0.055, 0.09),
                 slot + (random.chance(0.35) ? 1u : 0u));
    }
}

}  // namespace

double lamp_light_height(const LampPostParams& p) {
    return lantern_base(p) + 0.62 * p.lantern_m;
}

GeneratedModel lamp_post(const LampPostParams& p) {
    CHECK(p.lantern_m > 0.15 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {material_slot("iron", 40, 46, 44, 0.4f), material_slot("bulb", 255, 244, 224, 0.3f)};
    model.materials[0].metallic = 0.5f;
    add_lamp_shaft(model.mesh, p);
    add_lantern(model.mesh, p);
    const double y = lamp_light_height(p);
    add_part(model.mesh,
             lathe({{0, lantern_base(p)}, {0.03, lantern_base(p)}, {0.018, y - 0.05}, {0, y - 0.045}}, 12),
             {});
    add_part(model.mesh, sphere(0.04, 16, 12), translation(0, y, 0), 1);
    return model;
}

GeneratedModel planter(const PlanterParams& p) {
    CHECK(p.radius_m > 0.12 && p.height_m > 0.15 && p.shrub_m >= 0 && p.leaves >= 0);
    GeneratedModel model;
    model.materials = {material_slot("terracotta", 186, 108, 74, 0.85f),
                       material_slot("earth", 70, 54, 42, 1.0f), material_slot("leaf", 62, 96, 44, 0.55f),
                       material_slot("young_leaf", 92, 124, 56, 0.55f)};
    model.materials[2].translucency = model.materials[3].translucency = 0.25f;
    const double r = p.radius_m, h = p.height_m, inner = h - 0.06;
    add_part(model.mesh,
             lathe({{0, 0},
                    {0.62 * r, 0},
                    {0.66 * r, 0.02},
                    {0.80 * r, 0.45 * h},
                    {0.88 * r, 0.76 * h},
                    {0.93 * r, 0.78 * h},
                    {0.89 * r, 0.81 * h},
                    {0.90 * r, h - 0.085},
                    {0.98 * r, h - 0.08},
                    {r, h - 0.05},
                    {r, h - 0.015},
                    {0.97 * r, h},
                    {0.90 * r, h},
                    {0.86 * r, h - 0.02},
                    {0.85 * r, inner - 0.04},
                    {0, inner - 0.04}},
                   48, 40),
             {});
    add_part(model.mesh,
             lathe({{0, inner - 0.05},
                    {0.87 * r, inner - 0.05},
                    {0.87 * r, inner},
                    {0.4 * r, inner + 0.02},
                    {0, inner + 0.025}},
                   32),
             {}, 1);
    if (p.shrub_m > 0) {
        Random random(static_cast<std::uint64_t>(p.seed));
        const Vec3d centre{0, h + 0.80 * p.shrub_m, 0};
        add_part(
            model.mesh,
            tube({{{0, inner - 0.02, 0}, 0.02}, {{0.01, h + 0.3 * p.shrub_m, 0.01}, 0.016}, {centre, 0.008}},
                 6),
            {}, 1);
        add_shrub(model.mesh, centre, p.shrub_m, p.leaves, 2, random);
    }
    return model;
}

GeneratedModel hedge(const HedgeParams& p) {
    CHECK(p.length_m > 0.2 && p.height_m > 0.2 && p.depth_m > 0.1 && p.leaves >= 0);
    GeneratedModel model;
    model.materials = {material_slot("core", 30, 44, 24, 1.0f), material_slot("leaf", 64, 96, 44, 0.55f),
                       material_slot("young_leaf", 88, 120, 54, 0.55f)};
    model.materials[1].translucency = model.materials[2].translucency = 0.25f;
    const Vec3d half{0.5 * p.length_m, p.height_m, 0.5 * p.depth_m};
    add_part(model.mesh,
             box({-half.x + 0.04, -0.05, -half.z + 0.04}, {half.x - 0.04, half.y - 0.04, half.z - 0.04}), {});
    // Leaves over the top, the long sides and the ends, by their areas.
    const double top = p.length_m * p.depth_m, side = p.length_m * p.height_m, end = p.depth_m * p.height_m;
    Random random(static_cast<std::uint64_t>(p.seed));
    for (int i = 0; i < p.leaves; ++i) {
        const double pick = random.range(0, top + 2 * side + 2 * end), sign = random.chance(0.5) ? 1.0 : -1.0;
        Vec3d at{random.range(-half.x, half.x), random.range(0.0, half.y), random.range(-half.z, half.z)},
            out{0, 1, 0};
        if (pick < top) {
            at.y = half.y;
        } else if (pick < top + 2 * side) {
            at.z = sign * half.z, out = {0, 0, sign};
        } else {
            at.x = sign * half.x, out = {sign, 0, 0};
        }
        const Vec3d along = normalize(out * 0.7 + random_direction(random));
        const Vec3d up = normalize(out + Vec3d{0, 0.6, 0} + random_direction(random) * 0.5);
        if (std::fabs(dot(along, up)) > 0.97) continue;
        add_leaf(model.mesh, at - out * 0.05, along, up, random.range(0.07, 0.12),
                 random.chance(0.3) ? 2 : 1);
    }
    return model;
}

GeneratedModel bench(const BenchParams& p) {
    CHECK(p.length_m > 0.6 && p.height_m > 0.25 && p.depth_m > 0.2);
    GeneratedModel model;
    model.materials = {material_slot("stone", 214, 202, 182, 0.8f)};
    const double d = 0.5 * p.depth_m, h = p.height_m, l = 0.5 * p.length_m;
    // Seat: a rounded slab along X.
    std::vector<Vec2d> seat{{-d + 0.02, h - 0.09}, {d - 0.02, h - 0.09}};
    for (int i = 1; i < 8; ++i) {
        const Vec2d c = on_circle(-0.25 + 0.5 * i / 8);
        seat.push_back({d - 0.02 + 0.035 * c.x, h - 0.045 + 0.045 * c.y});
    }
    seat.insert(seat.end(), {{d - 0.02, h}, {-d + 0.02, h}});
    for (int i = 1; i < 8; ++i) {
        const Vec2d c = on_circle(0.25 + 0.5 * i / 8);
        seat.push_back({-d + 0.02 + 0.035 * c.x, h - 0.045 + 0.045 * c.y});
    }
    add_part(model.mesh, extrude(seat, -l, l), rotation_y(90));
    // Supports: a waisted profile, on a foot.
    std::vector<Vec2d> side{{-0.8 * d, 0}, {0.8 * d, 0}};
    for (int i = 0; i <= 8; ++i) {
        const double t = i / 8.0;
        side.push_back({(0.72 - 0.9 * t * (1 - t)) * d, 0.05 + t * (h - 0.13)});
    }
    for (int i = 8; i >= 0; --i) {
        const double t = i / 8.0;
        side.push_back({-(0.72 - 0.9 * t * (1 - t)) * d, 0.05 + t * (h - 0.13)});
    }
    for (const double x : {-0.68 * l, 0.68 * l}) {
        add_part(model.mesh, extrude(side, -0.07, 0.07), translation(x, 0, 0) * rotation_y(90));
    }
    return model;
}

GeneratedModel fountain(const FountainParams& p) {
    CHECK(p.radius_m > 0.6 && p.height_m > 1.55 && p.segments >= 8);
    GeneratedModel model;
    model.materials = {material_slot("stone", 216, 204, 184, 0.75f),
                       material_slot("water", 38, 66, 66, 0.06f)};
    const double r = p.radius_m, h = p.height_m, bowl = 0.62 * h, rim = 0.46 * r;
    // Basin wall: one ring profile with step, die and rounded coping.
    std::vector<Vec2d> basin{{r - 0.16, -0.05}, {r + 0.18, -0.05}, {r + 0.18, 0.10}, {r + 0.06, 0.11},
                             {r + 0.02, 0.15},  {r, 0.42},         {r + 0.06, 0.45}};
    for (int i = 0; i <= 6; ++i) {
        const Vec2d c = on_circle(-0.25 + 0.5 * i / 6);
        basin.push_back({r + 0.06 + 0.05 * c.x, 0.51 + 0.05 * c.y});
    }
    basin.insert(basin.end(),
                 {{r - 0.22, 0.56}, {r - 0.24, 0.54}, {r - 0.24, 0.47}, {r - 0.16, 0.44}, {r - 0.16, -0.05}});
    add_part(model.mesh, lathe(basin, p.segments, 40), {});
    add_part(model.mesh, lathe({{0, -0.04}, {r - 0.1, -0.04}, {r - 0.1, 0.36}, {0, 0.36}}, p.segments), {},
             1);
    // Baluster, bowl and finial are turned from one stone.
    const double b = 0.13 * r;
    std::vector<Vec2d> stem{{0, 0.02},       {1.9 * b, 0.02}, {1.9 * b, 0.44},
                            {1.5 * b, 0.50}, {0.9 * b, 0.56}, {0.8 * b, 0.60}};
    for (int i = 0; i <= 10; ++i) {
        const double t = i / 10.0;
        const Vec2d c = on_circle(0.5 * t);
        stem.push_back({(0.62 + 0.75 * c.y * (1 - 0.55 * t)) * b, 0.62 + t * (bowl - 0.86)});
    }
    stem.insert(stem.end(), {{0.95 * b, bowl - 0.22}, {0.95 * b, bowl - 0.19}, {0.6 * b, bowl - 0.17}});
    for (int i = 1; i <= 8; ++i) {
        const Vec2d c = on_circle(0.25 * i / 8);
        stem.push_back({0.6 * b + (rim - 0.6 * b) * c.y, bowl - 0.01 - 0.15 * c.x});
    }
    stem.insert(stem.end(), {{rim + 0.025, bowl + 0.01},
                             {rim + 0.02, bowl + 0.035},
                             {rim - 0.05, bowl + 0.03},
                             {0.6 * rim, bowl - 0.05},
                             {0.7 * b, bowl - 0.08}});
    stem.insert(stem.end(),
                {{0.5 * b, bowl + 0.12}, {0.75 * b, h - 0.32}, {0.75 * b, h - 0.29}, {0.35 * b, h - 0.26}});
    for (int i = 2; i < 10; ++i) {
        const Vec2d c = on_circle(0.5 * i / 10);
        stem.push_back({0.85 * b * c.y, h - 0.13 - 0.11 * c.x});
    }
    stem.push_back({0, h});
    add_part(model.mesh, lathe(stem, p.segments, 40), {});
    add_part(
        model.mesh,
        lathe({{0, bowl - 0.07}, {0.55 * rim, bowl - 0.07}, {rim - 0.05, bowl + 0.012}, {0, bowl + 0.012}},
              p.segments),
        {}, 1);
    return model;
}

}  // namespace obscura
