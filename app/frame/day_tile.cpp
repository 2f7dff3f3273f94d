#include "app/frame/day_tile.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

/// A point above a cell, held to the triangle that it was seen on.
GroundPlace place_on(const HeightField& field, std::uint32_t ground_triangle, double x, double y) {
    const auto cells_x = static_cast<std::uint32_t>(field.width() - 1);
    const std::uint32_t cell = ground_triangle / 2;
    const bool second = ground_triangle % 2 == 1;
    GroundPlace place{static_cast<int>(cell % cells_x), static_cast<int>(cell / cells_x), 0, 0};
    double u = std::clamp(x - place.cell_x, 0.0, 1.0), v = std::clamp(y - place.cell_y, 0.0, 1.0);
    if (field.diagonal == Diagonal::falling) {
        // The first lies north-east of the diagonal.
        if (!second && v > u) v = u;
        if (second && u > v) u = v;
    } else {
        // The first lies north-west of it.
        if (!second && u + v > 1) v = 1 - u;
        if (second && u + v < 1) v = 1 - u;
    }
    place.right = u;
    place.down = v;
    return place;
}

/// The same by its place alone.
GroundPlace place_at(const HeightField& field, double x, double y) {
    const auto cell = [](double at, int samples) {
        return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(samples - 2)));
    };
    GroundPlace place{cell(x, field.width()), cell(y, field.height()), 0, 0};
    place.right = std::clamp(x - place.cell_x, 0.0, 1.0);
    place.down = std::clamp(y - place.cell_y, 0.0, 1.0);
    return place;
}

}  // namespace

DayLight day_light(const DaySun& sun, const SceneTerrain& terrain, const Light& light, Vec3d eye) {
    const HeightField& field = *terrain.field;
    DayLight day;
    day.sun = &sun;
    day.eye =
        eye - terrain.middle_m +
        Vec3d{0.5 * (field.width() - 1) * field.cell_x_m, 0, 0.5 * (field.height() - 1) * field.cell_y_m};
    day.to_light = to_float(-normalize(light.direction));
    day.first_triangle = terrain.first_triangle;
    day.ground_triangles = terrain.ground_triangles;
    day.triangles = terrain.triangles;
    return day;
}

bool day_dark(const DayLight& light, std::uint32_t triangle, Vec3f point, Vec3f normal) {
    const HeightField& field = *light.sun->ground->field;
    const Vec3d p = light.eye + to_double(point);
    const double x = p.x / field.cell_x_m, y = p.z / field.cell_y_m;
    if (light.object != nullptr) {
        if (light.object[triangle] != light.own_object) return light.sun->rays.hidden({x, y, p.y});
        return normal.y > 0 && ground_dark(*light.sun, place_at(field, x, y));
    }
    const std::uint32_t own = triangle - light.first_triangle;
    if (triangle >= light.first_triangle && own < light.triangles) {
        if (own >= light.ground_triangles) return false;
        return ground_dark(*light.sun, place_on(field, own, x, y));
    }
    return light.sun->rays.hidden({x, y, p.y});
}

void darken_by_ground(const DayLight& light, const SurfaceBlock& s, float* visibility) {
    for (int i = 0; i < block_samples; ++i) {
        if ((s.covered[i / 16] >> (i % 16) & 1u) == 0 || visibility[i] == 0) continue;
        const bool thin = (s.thin[i / 16] >> (i % 16) & 1u) != 0;
        const Vec3f normal{s.gx[i], s.gy[i], s.gz[i]};
        const bool faces = dot(normal, light.to_light) > 0;
        if ((!faces && !thin) || day_dark(light, s.triangle[i], {s.px[i], s.py[i], s.pz[i]}, normal))
            visibility[i] = 0;
    }
}

}  // namespace obscura
