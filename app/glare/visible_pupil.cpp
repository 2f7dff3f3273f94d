#include "app/glare/visible_pupil.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/coverage.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr double own_surface = 1e-4;  // of the light's distance

/// A corner projected from the light: texels are (x / w, y / w). `depth` is in front of the pupil.
struct Corner {
    double x = 0, y = 0, w = 0, depth = 0;
};

/// A triangle clipped by six planes has nine corners at most.
struct Polygon {
    std::array<Corner, 9> corner;
    int count = 0;
};

Corner blend(const Corner& a, const Corner& b, double t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.w + (b.w - a.w) * t,
            a.depth + (b.depth - a.depth) * t};
}

/// Keeps what has distance >= 0 (Sutherland and Hodgman: Reentrant polygon clipping, 1974).
template <class Distance>
Polygon clipped(const Polygon& from, Distance&& distance) {
    Polygon to;
    for (int i = 0; i < from.count; ++i) {
        const Corner& a = from.corner[static_cast<std::size_t>(i)];
        const Corner& b = from.corner[static_cast<std::size_t>((i + 1) % from.count)];
        const double da = distance(a), db = distance(b);
        if (da >= 0) to.corner[static_cast<std::size_t>(to.count++)] = a;
        if ((da >= 0) != (db >= 0))
            to.corner[static_cast<std::size_t>(to.count++)] = blend(a, b, da / (da - db));
    }
    return to;
}

/// Texels of one corner fan, by the rasterizer's edge functions.
void hide(const Polygon& polygon, Image<std::uint8_t>& open) {
    std::array<std::int32_t, 9> x{}, y{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) {
        const Corner& c = polygon.corner[i];
        x[i] = static_cast<std::int32_t>(std::floor(c.x / c.w * subtexel_one + 0.5));
        y[i] = static_cast<std::int32_t>(std::floor(c.y / c.w * subtexel_one + 0.5));
    }
    for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(polygon.count); ++i) {
        TriangleRecord t{};
        const std::array<std::size_t, 3> order = {0, i, i + 1};
        const std::int64_t area =
            std::int64_t{x[i] - x[0]} * (y[i + 1] - y[0]) - std::int64_t{x[i + 1] - x[0]} * (y[i] - y[0]);
        if (area == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t from = order[area > 0 ? k : 2 - k];
            t.x[k] = x[from];
            t.y[k] = y[from];
        }
        const int x0 = std::max(std::min({t.x[0], t.x[1], t.x[2]}) / subtexel_one, 0);
        const int y0 = std::max(std::min({t.y[0], t.y[1], t.y[2]}) / subtexel_one, 0);
        const int x1 = std::min(std::max({t.x[0], t.x[1], t.x[2]}) / subtexel_one, open.width - 1);
        const int y1 = std::min(std::max({t.y[0], t.y[1], t.y[2]}) / subtexel_one, open.height - 1);
        for (int row = y0; row <= y1; ++row) {
            for (int column = x0; column <= x1; ++column) {
                if (covers(t, column, row)) open(column, row) = 0;
            }
        }
    }
}

}  // namespace

PupilPlane pupil_plane(const Camera& camera, double side_m, Vec3d offset_m) {
    const Basis basis = look_basis(normalize(camera.look_at - camera.eye), camera.up);
    return {camera.eye + offset_m, basis.right, -basis.up, basis.forward, side_m, camera.near_m};
}

std::vector<std::uint32_t> between(const Mesh& mesh, const PupilPlane& pupil, Vec3d centre, double radius) {
    // Balls around the pupil and the lights; what is between lies in their hull, at most `wide` from the axis
    // at its own height, stretched by the cone's slope.
    const double first = pupil.side_m * 0.7072;
    const Vec3d axis = centre - pupil.centre;
    const double far = length(axis);
    std::vector<std::uint32_t> found;
    const double slope = far > 0 ? (radius - first) / far : 2;
    const double stretch = std::fabs(slope) < 1 ? 1 / std::sqrt(1 - slope * slope) : 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const Vec3d a = to_double(mesh.positions[t.v[0]]), b = to_double(mesh.positions[t.v[1]]),
                    c = to_double(mesh.positions[t.v[2]]);
        const Vec3d middle = (a + b + c) * (1.0 / 3);
        const double reach = std::max({length(a - middle), length(b - middle), length(c - middle)});
        const Vec3d from = middle - pupil.centre;
        const double at = dot(from, axis) / (far * far);
        const double end = std::clamp(at + (slope > 0 ? 1 : -1) * reach / far, 0.0, 1.0);
        const double wide = (first + (radius - first) * end) * stretch;
        const double off = length(from - axis * std::clamp(at, 0.0, 1.0));
        if (stretch == 0 || off <= wide + reach) found.push_back(static_cast<std::uint32_t>(i));
    }
    return found;
}

Image<std::uint8_t> visible_pupil(const Mesh& mesh, std::span<const std::uint32_t> triangles,
                                  const PupilPlane& pupil, Vec3d point, int size) {
    Image<std::uint8_t> open(size, size, 1);
    const auto local = [&](Vec3d p) {
        const Vec3d d = p - pupil.centre;
        return Vec3d{dot(d, pupil.right), dot(d, pupil.down), dot(d, pupil.forward)};
    };
    const Vec3d light = local(point);
    const double per_m = size / pupil.side_m;
    for (const std::uint32_t index : triangles) {
        const Triangle& t = mesh.triangles[index];
        Polygon polygon;
        polygon.count = 3;
        for (std::size_t k = 0; k < 3; ++k) {
            // The line from the light through v meets the pupil's plane at (light.z v - v.z light) / (light.z
            // - v.z).
            const Vec3d v = local(to_double(mesh.positions[t.v[k]]));
            const double w = light.z - v.z;
            polygon.corner[k] = {(light.z * v.x - v.z * light.x) * per_m + 0.5 * size * w,
                                 (light.z * v.y - v.z * light.y) * per_m + 0.5 * size * w, w, v.z};
        }
        polygon = clipped(polygon, [&](const Corner& c) { return c.w - own_surface * light.z; });
        polygon = clipped(polygon, [&](const Corner& c) { return c.depth - pupil.near_m; });
        polygon = clipped(polygon, [](const Corner& c) { return c.x; });
        polygon = clipped(polygon, [](const Corner& c) { return c.y; });
        polygon = clipped(polygon, [&](const Corner& c) { return size * c.w - c.x; });
        polygon = clipped(polygon, [&](const Corner& c) { return size * c.w - c.y; });
        if (polygon.count >= 3) hide(polygon, open);
    }
    return open;
}

}  // namespace obscura
