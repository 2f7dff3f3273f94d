#include "scenes/build.h"

#include <cmath>

#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

/// Linear value of an 8-bit sRGB one (IEC 61966-2-1).
float linear_of_srgb8(int value) {
    const double s = value / 255.0;
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : num::pow((s + 0.055) / 1.055, 2.4));
}

/// Cofactors of the linear part: they carry normals, whatever the move does to lengths.
Vec3d transform_normal(const Affine& a, Vec3d n) {
    const Vec3d x{a.m[0][0], a.m[1][0], a.m[2][0]}, y{a.m[0][1], a.m[1][1], a.m[2][1]},
        z{a.m[0][2], a.m[1][2], a.m[2][2]};
    const double side = determinant(a) < 0 ? -1.0 : 1.0;
    return normalize((cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * side);
}

void add_moved(Mesh& to, const Mesh& part, const Affine& move) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const Vec3f p : part.positions)
        to.positions.push_back(stored(transform_point(move, to_double(p))));
    for (const Vec3f n : part.normals)
        to.normals.push_back(to_float(transform_normal(move, to_double(n))));
    to.uvs.insert(to.uvs.end(), part.uvs.begin(), part.uvs.end());
    const bool mirrored = determinant(move) < 0;
    for (const Triangle& t : part.triangles) {
        to.triangles.push_back(
            {{first + t.v[0], first + t.v[mirrored ? 2 : 1], first + t.v[mirrored ? 1 : 2]}});
    }
    to.object.resize(to.triangles.size(), 0);
}

}  // namespace

Affine translation(Vec3d o) {
    return {{{1, 0, 0, o.x}, {0, 1, 0, o.y}, {0, 0, 1, o.z}}};
}
Affine translation(double x, double y, double z) {
    return translation(Vec3d{x, y, z});
}
Affine scaling(Vec3d f) {
    return {{{f.x, 0, 0, 0}, {0, f.y, 0, 0}, {0, 0, f.z, 0}}};
}

Vec2d on_circle(double turns) {
    return {num::cos_deg(360.0 * turns), num::sin_deg(360.0 * turns)};
}

Affine rotation_x(double degrees) {
    const Vec2d r = on_circle(degrees / 360.0);
    return {{{1, 0, 0, 0}, {0, r.x, -r.y, 0}, {0, r.y, r.x, 0}}};
}
Affine rotation_y(double degrees) {
    const Vec2d r = on_circle(degrees / 360.0);
    return {{{r.x, 0, r.y, 0}, {0, 1, 0, 0}, {-r.y, 0, r.x, 0}}};
}
Affine rotation_z(double degrees) {
    const Vec2d r = on_circle(degrees / 360.0);
    return {{{r.x, -r.y, 0, 0}, {r.y, r.x, 0, 0}, {0, 0, 1, 0}}};
}

Affine rotation_to(Vec3d up) {
    // Rodrigues' formula for the turn Y -> up about their common normal; a half turn has no such normal.
    if (up.y < -0.999999) return rotation_x(180);
    const double x = up.x, z = up.z, k = 1.0 / (1.0 + up.y);
    return {{{1 - x * x * k, x, -x * z * k, 0}, {-x, up.y, -z, 0}, {-x * z * k, z, 1 - z * z * k, 0}}};
}

Vec2f facet_uv(Vec3d p, Vec3d n) {
    const Vec3d level = n.y > 0.999 || n.y < -0.999 ? Vec3d{1, 0, 0} : normalize(cross(Vec3d{0, 1, 0}, n));
    const Vec3d uphill = cross(n, level);
    return {static_cast<float>(dot(p, level)), static_cast<float>(dot(p, uphill))};
}

void add_facet(Mesh& mesh, const std::vector<Vec3d>& corners, std::uint32_t material) {
    CHECK(corners.size() >= 3);
    Vec3d area{};
    for (std::size_t i = 2; i < corners.size(); ++i) {
        area = area + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    }
    CHECK(dot(area, area) > 0);
    const Vec3d normal = normalize(area);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d p : corners) {
        mesh.positions.push_back(stored(p));
        mesh.normals.push_back(to_float(normal));
        mesh.uvs.push_back(facet_uv(p, normal));
    }
    for (std::uint32_t i = 2; i < corners.size(); ++i) {
        mesh.triangles.push_back({{first, first + i - 1, first + i}});
        mesh.material.push_back(material);
        mesh.object.push_back(0);
    }
}

void add_facet(Mesh& mesh, std::initializer_list<Vec3d> corners, std::uint32_t material) {
    add_facet(mesh, std::vector<Vec3d>(corners), material);
}

void add_part(Mesh& to, const Mesh& part, const Affine& move, std::uint32_t material) {
    add_moved(to, part, move);
    to.material.resize(to.triangles.size(), material);
}

void add_parts(Mesh& to, const Mesh& part, const Affine& move, std::uint32_t first_material) {
    add_moved(to, part, move);
    for (const std::uint32_t m : part.material)
        to.material.push_back(first_material + m);
}

Material material_slot(const char* name, int red, int green, int blue, float roughness) {
    Material m;
    m.name = name;
    m.base_color = {linear_of_srgb8(red), linear_of_srgb8(green), linear_of_srgb8(blue)};
    m.roughness = roughness;
    return m;
}

}  // namespace obscura
