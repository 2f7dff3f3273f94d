#pragma once
// A sphere before a wall above a floor, seen by rays: the middle view and both eyes' pictures, exactly.
// Camera at the origin, x right, y down, z forward.

#include <cmath>
#include <limits>

#include "core/vec.h"
#include "stereo/middle_view.h"
#include "stereo/stereo_rig.h"

namespace obscura {

struct RayScene {
    int width = 320, height = 180, margin_px = 0;
    double focal_px = 300, interaxial_m = 0.2, zero_parallax_m = 4;
    Vec3d centre{0.2, 0.1, 4};
    double radius = 0.7;
    Vec3d wall_normal{0.1, 0, -1};  ///< through (0, 0, wall_z)
    double wall_z = 7, floor_y = 1.2;

    DisparityLaw law() const {
        const double scale = focal_px * interaxial_m;
        return {scale, scale / zero_parallax_m, focal_px};
    }

    struct Hit {
        double z = std::numeric_limits<double>::infinity();
        std::uint32_t object = nothing_seen;
        Vec3d point, normal;
    };

    /// First surface along eye + t direction, t > 1e-6; direction.z = 1, so that t is depth for eyes at z =
    /// 0.
    Hit trace(Vec3d eye, Vec3d direction) const {
        Hit hit;
        const auto take = [&](double t, std::uint32_t object, Vec3d normal) {
            if (!(t > 1e-6) || t >= hit.z) return;
            hit = {t, object, eye + direction * t, normalize(normal)};
            if (dot(hit.normal, direction) > 0) hit.normal = -hit.normal;
        };
        take(dot(Vec3d{0, 0, wall_z} - eye, wall_normal) / dot(direction, wall_normal), 0, wall_normal);
        if (direction.y > 0) take((floor_y - eye.y) / direction.y, 1, {0, -1, 0});
        const Vec3d to = eye - centre;
        const double a = dot(direction, direction), b = dot(to, direction), c = dot(to, to) - radius * radius;
        if (b * b >= a * c) {
            const double t = (-b - std::sqrt(b * b - a * c)) / a;
            take(t, 2, eye + direction * t - centre);
        }
        return hit;
    }

    /// Of the eye `side` (-1 left, 0 middle, 1 right) through column x, row y (centres at whole numbers) of
    /// its picture.
    Hit seen(int side, double x, double y) const {
        const double shear = side * law().offset / 2;  // the frustum meets the others at zero parallax
        return trace({side * interaxial_m / 2, 0, 0},
                     {(x + 0.5 - width / 2.0 - shear) / focal_px, (y + 0.5 - height / 2.0) / focal_px, 1});
    }

    /// True when the eye `side` sees a point: nothing before it, and within its picture.
    bool sees(int side, const Hit& hit) const {
        const Vec3d eye{side * interaxial_m / 2, 0, 0};
        const Vec3d way = (hit.point - eye) * (1 / hit.point.z);
        return trace(eye, way).z > hit.z * (1 - 1e-9);
    }

    MiddleView view() const {
        MiddleView v;
        v.picture_width = width;
        v.picture_height = height;
        v.margin_px = margin_px;
        const int columns = width + 2 * margin_px;
        v.depth_m = Image<float>(columns, height);
        v.normal = Image<Vec3f>(columns, height);
        v.object = v.material = v.triangle = Image<std::uint32_t>(columns, height);
        v.disparity = DisparityMap(columns, height);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < columns; ++x) {
                const Hit hit = seen(0, x - margin_px, y);
                v.depth_m(x, y) = static_cast<float>(hit.z);
                v.normal(x, y) = to_float(hit.normal);
                v.object(x, y) = v.material(x, y) = v.triangle(x, y) = hit.object;
                v.disparity(x, y) = law().at(hit.z);
            }
        }
        return v;
    }
};

}  // namespace obscura
