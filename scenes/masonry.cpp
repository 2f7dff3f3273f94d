// Surfaces made of many pieces: flagstones, roof tiles, walls with openings, window frames.

#include <cmath>

#include "core/error.h"
#include "scenes/facade.h"
#include "scenes/generators.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// A stone with its upper edges bevelled: [x0, x1] x [z0, z1], from y0 up to y1.
void add_flagstone(Mesh& m, Vec3d a, Vec3d b, double bevel, std::uint32_t slot) {
    const double y = b.y - bevel, i = 0.8 * bevel;
    const Vec3d low[4] = {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}, {a.x, a.y, a.z}};
    const Vec3d shoulder[4] = {{a.x, y, b.z}, {b.x, y, b.z}, {b.x, y, a.z}, {a.x, y, a.z}};
    const Vec3d top[4] = {
        {a.x + i, b.y, b.z - i}, {b.x - i, b.y, b.z - i}, {b.x - i, b.y, a.z + i}, {a.x + i, b.y, a.z + i}};
    for (int k = 0; k < 4; ++k) {
        const int n = (k + 1) % 4;
        add_facet(m, {low[k], low[n], shoulder[n], shoulder[k]}, slot);
        add_facet(m, {shoulder[k], shoulder[n], top[n], top[k]}, slot);
    }
    add_facet(m, {top[0], top[1], top[2], top[3]}, slot);
    add_facet(m, {low[3], low[2], low[1], low[0]}, slot);
}

/// Cuts a length into pieces of about `piece`, each off by at most `play` of it.
std::vector<double> cuts(double length, double piece, double play, Random& random) {
    const int count = static_cast<int>(std::floor(length / piece + 0.5)) > 1
                          ? static_cast<int>(std::floor(length / piece + 0.5))
                          : 1;
    std::vector<double> lines{0};
    for (int i = 1; i < count; ++i)
        lines.push_back(length * (i + random.range(-play, play)) / count);
    lines.push_back(length);
    return lines;
}

}  // namespace

GeneratedModel pavement(const PavementParams& p) {
    CHECK(p.joint_m > 0 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {
        material_slot("joint", 96, 86, 74, 1.0f), material_slot("flag_light", 206, 190, 164, 0.8f),
        material_slot("flag", 192, 174, 146, 0.8f), material_slot("flag_dark", 172, 154, 130, 0.8f)};
    Random random(static_cast<std::uint64_t>(p.seed));
    const double w = 0.5 * p.width_m, d = 0.5 * p.depth_m, gap = 0.5 * p.joint_m;
    add_part(model.mesh, box({-w, -0.20, -d}, {w, -0.018, d}), {}, 0);
    const std::vector<double> rows = cuts(p.depth_m, p.stone_m, 0.16, random);
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
        const std::vector<double> columns = cuts(p.width_m, p.stone_m * random.range(1.0, 1.5), 0.28, random);
        for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
            const double top = random.range(-0.004, 0.0);
            add_flagstone(model.mesh, {-w + columns[i] + gap, -0.06, -d + rows[j] + gap},
                          {-w + columns[i + 1] - gap, top, -d + rows[j + 1] - gap}, 0.007,
                          1 + static_cast<std::uint32_t>(random.index(3)));
        }
    }
    return model;
}

GeneratedModel roof_tiles(const RoofTilesParams& p) {
    CHECK(p.slope_m > 0.4 && p.pitch_deg >= 0 && p.pitch_deg < 80 && p.tile_m > 0.05 && problem(p).empty(),
          problem(p));
    GeneratedModel model;
    model.materials = {material_slot("board", 120, 92, 70, 0.9f), material_slot("tile", 190, 112, 78, 0.85f),
                       material_slot("tile_pale", 206, 138, 100, 0.85f),
                       material_slot("tile_dark", 160, 88, 62, 0.85f)};
    Random random(static_cast<std::uint64_t>(p.seed));
    // Built lying flat (courses along X, up the slope towards -Z), then pitched about the eaves.
    const Affine pitch = rotation_x(p.pitch_deg);
    const double w = 0.5 * p.width_m;
    add_part(model.mesh, box({-w, -0.05, -p.slope_m}, {w, 0, 0.02}), pitch, 0);
    const int columns = static_cast<int>(std::floor(p.width_m / p.tile_m)),
              rows = static_cast<int>(std::ceil(p.slope_m / 0.36));
    const double step_x = p.width_m / columns, step_z = p.slope_m / rows;
    const auto half_pipe = [&](double radius, bool up) {
        std::vector<Vec2d> inner, outer;
        for (int i = 0; i <= 5; ++i) {
            const Vec2d c = on_circle(0.5 - 0.5 * i / 5);
            inner.push_back(c * (radius - 0.014)), outer.push_back(c * radius);
        }
        return up ? strip(inner, outer, 0, step_z + 0.05, 40) : Mesh{};
    };
    const Mesh cover = half_pipe(0.34 * step_x, true);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            // Each course rests on the head of the one below it, hence the small tilt.
            const Affine lie =
                translation(-w + i * step_x + random.range(-0.004, 0.004), 0.012, -(j + 1) * step_z) *
                rotation_x(2.6) * rotation_y(random.range(-0.7, 0.7));
            const double dice = random.uniform();
            add_part(model.mesh, cover, pitch * lie, dice < 0.55 ? 1 : dice < 0.8 ? 2 : 3);
        }
        // Pans: shallow slabs between the covers, stepped like them.
        for (int i = 0; i < columns; ++i) {
            const double x = -w + (i + 0.5) * step_x, half = 0.42 * step_x;
            const Affine lie = translation(x, 0.012, -(j + 1) * step_z) * rotation_x(2.6);
            add_part(model.mesh, box({-half, 0, 0}, {half, 0.014, step_z + 0.05}), pitch * lie,
                     random.chance(0.6) ? 1 : 3);
        }
    }
    return model;
}

GeneratedModel window_frame(const WindowParams& p) {
    CHECK(p.columns >= 1 && p.rows >= 1 && p.depth_m > 0 && p.bar_m > 0 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {material_slot("frame", 238, 234, 224, 0.5f)};
    const double w = p.width_m - 2 * p.frame_m, h = p.height_m - 2 * p.frame_m, d = 0.5 * p.depth_m;
    // A moulding lies flat around a rectangle; stood on edge it is a frame.
    const Affine upright = translation(0, 0.5 * p.height_m, 0) * rotation_x(90);
    const double f = p.frame_m;
    add_part(model.mesh,
             moulding({{0, -0.7 * d}, {0.25 * f, -d}, {f, -d}, {f, d}, {0.25 * f, d}, {0, 0.7 * d}}, w, h),
             upright);
    const double half = 0.5 * p.bar_m, deep = 0.5 * d;
    for (int i = 1; i < p.columns; ++i) {
        const double x = -0.5 * w + w * i / p.columns,
                     wide = p.columns % 2 == 0 && 2 * i == p.columns ? 1.5 * half : half;
        add_part(model.mesh, box({x - wide, 0.5 * f, -deep}, {x + wide, p.height_m - 0.5 * f, deep}), {});
    }
    for (int j = 1; j < p.rows; ++j) {
        const double y = f + h * j / p.rows;
        add_part(model.mesh,
                 box({-0.5 * w - 0.5 * f, y - half, -0.9 * deep}, {0.5 * w + 0.5 * f, y + half, 0.9 * deep}),
                 {});
    }
    return model;
}

GeneratedModel pierced_wall(const PiercedWallParams& p) {
    CHECK(p.openings >= 0 && p.sill_m > 0 && problem(p).empty(), problem(p));
    GeneratedModel model;
    model.materials = {material_slot("wall", 236, 228, 212, 0.9f)};
    WindowGrid grid;
    grid.columns = even_openings(p.width_m, p.openings, p.opening_width_m);
    if (p.openings > 0) grid.rows = {{p.sill_m, p.sill_m + p.opening_height_m}};
    model.mesh = pierced_slab(p.width_m, p.height_m, p.depth_m, grid);
    return model;
}

double opening_x(const PiercedWallParams& p, int i) {
    return p.width_m * ((i + 0.5) / p.openings - 0.5);
}

}  // namespace obscura
