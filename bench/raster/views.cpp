#include "bench/raster/views.h"

#include "core/error.h"

namespace obscura {
namespace {

constexpr double degrees = 3.14159265358979323846 / 180.0;

Vec3d xyz(Vec4d p) {
    return {p.x, p.y, p.z};
}

/// Unit axes of a camera: right, down (rows grow downwards) and forward.
struct CameraAxes {
    Vec3d right, down, forward;
};

CameraAxes axes_of(const Camera& camera) {
    const Vec3d forward = normalize(camera.look_at - camera.eye);
    const Vec3d right = normalize(cross(forward, camera.up));
    return {right, cross(forward, right), forward};
}

/// Half the picture's height at distance 1.
double half_height(const Camera& camera) {
    CHECK(camera.kind == CameraKind::perspective);
    return std::tan(0.5 * camera.vfov_deg * degrees);
}

}  // namespace

RayGrid rays_of(const LightView& light) {
    CHECK(!light.perspective, "only orthographic light views are benchmarked");
    const Mat4 world = inverse(light.to_map);
    RayGrid grid;
    grid.origin = xyz(world * Vec4d{0.5, 0.5, 0.0, 1.0});
    grid.origin_dx = xyz(world * Vec4d{1, 0, 0, 0});
    grid.origin_dy = xyz(world * Vec4d{0, 1, 0, 0});
    grid.direction = xyz(world * Vec4d{0, 0, 1, 0});
    return grid;
}

RayGrid rays_of(const Camera& camera, int width, int height) {
    const CameraAxes axes = axes_of(camera);
    const double pixel = 2.0 * half_height(camera) / height;
    RayGrid grid;
    grid.origin = camera.eye;
    grid.direction_dx = axes.right * pixel;
    grid.direction_dy = axes.down * pixel;
    grid.direction =
        axes.forward + grid.direction_dx * (0.5 - 0.5 * width) + grid.direction_dy * (0.5 - 0.5 * height);
    return grid;
}

Mat4 clip_from_world(const LightView& light) {
    CHECK(!light.perspective, "only orthographic light views are benchmarked");
    const Mat4 clip_from_map{
        {{2.0 / light.width, 0, 0, -1}, {0, 2.0 / light.height, 0, -1}, {0, 0, 2, -1}, {0, 0, 0, 1}}};
    return clip_from_map * light.to_map;
}

Mat4 clip_from_world(const Camera& camera, int width, int height, double near_m, double far_m) {
    const CameraAxes axes = axes_of(camera);
    const double sy = 1.0 / half_height(camera);
    const double sx = sy * height / width;
    const double a = (far_m + near_m) / (far_m - near_m);
    const double b = -2.0 * far_m * near_m / (far_m - near_m);
    const auto row = [&](Vec3d axis, double scale, double offset) {
        return Vec4d{axis.x * scale, axis.y * scale, axis.z * scale, offset - dot(axis, camera.eye) * scale};
    };
    const Vec4d x = row(axes.right, sx, 0), y = row(axes.down, sy, 0);
    const Vec4d z = row(axes.forward, a, b), w = row(axes.forward, 1, 0);
    return Mat4{{{x.x, x.y, x.z, x.w}, {y.x, y.y, y.z, y.w}, {z.x, z.y, z.z, z.w}, {w.x, w.y, w.z, w.w}}};
}

}  // namespace obscura
