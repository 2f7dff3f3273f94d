#include "scenes/shapes.h"

#include "core/error.h"
#include "scenes/build.h"

namespace obscura {

Mesh box(Vec3d a, Vec3d b) {
    CHECK(a.x < b.x && a.y < b.y && a.z < b.z);
    Mesh m;
    add_facet(m, {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});  // front, +Z
    add_facet(m, {{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}});
    add_facet(m, {{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}});
    add_facet(m, {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}});
    add_facet(m, {{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}});
    add_facet(m, {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}});
    return m;
}

Mesh box(Vec3d size) {
    return box(size * -0.5, size * 0.5);
}

Mesh plane(double width_m, double depth_m, int cells_x, int cells_z) {
    CHECK(width_m > 0 && depth_m > 0 && cells_x >= 1 && cells_z >= 1);
    Mesh m;
    for (int j = 0; j <= cells_z; ++j) {
        for (int i = 0; i <= cells_x; ++i) {
            const double u = static_cast<double>(i) / cells_x, v = static_cast<double>(j) / cells_z;
            const Vec3d p{(u - 0.5) * width_m, 0, (v - 0.5) * depth_m};
            m.positions.push_back(stored(p));
            m.normals.push_back({0, 1, 0});
            m.uvs.push_back({static_cast<float>(u * width_m), static_cast<float>((1 - v) * depth_m)});
        }
    }
    const auto row = static_cast<std::uint32_t>(cells_x + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells_z); ++j) {
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
            const std::uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
            m.triangles.push_back({{c, d, b}});
            m.triangles.push_back({{c, b, a}});
        }
    }
    m.material.assign(m.triangles.size(), 0);
    m.object.assign(m.triangles.size(), 0);
    return m;
}

Mesh sphere(double radius_m, int segments, int rings) {
    CHECK(radius_m > 0 && segments >= 3 && rings >= 2);
    std::vector<Vec2d> profile{{0, -radius_m}};
    for (int i = 1; i < rings; ++i) {
        const Vec2d c = on_circle(0.5 * i / rings);
        profile.push_back({radius_m * c.y, -radius_m * c.x});
    }
    profile.push_back({0, radius_m});
    return lathe(profile, segments, 180);
}

Mesh cylinder(double radius_m, double height_m, int segments) {
    return frustum(radius_m, radius_m, height_m, segments);
}

Mesh frustum(double base_radius_m, double top_radius_m, double height_m, int segments) {
    CHECK(base_radius_m >= 0 && top_radius_m >= 0 && base_radius_m + top_radius_m > 0 && height_m > 0);
    std::vector<Vec2d> profile{{0, 0}};
    if (base_radius_m > 0) profile.push_back({base_radius_m, 0});
    if (top_radius_m > 0) profile.push_back({top_radius_m, height_m});
    profile.push_back({0, height_m});
    return lathe(profile, segments);
}

Mesh torus(double radius_m, double tube_radius_m, int segments, int sides) {
    CHECK(tube_radius_m > 0 && tube_radius_m < radius_m && sides >= 3);
    std::vector<Vec2d> profile;
    for (int i = 0; i <= sides; ++i) {
        const Vec2d c = on_circle(static_cast<double>(i % sides) / sides);
        profile.push_back({radius_m + tube_radius_m * c.x, tube_radius_m * c.y});
    }
    return lathe(profile, segments, 180);
}

}  // namespace obscura
