#include "raster/camera_rays.h"

#include "core/num.h"
#include "core/vec_arrays.h"
#include "raster/view.h"

namespace obscura {

CameraRays camera_rays(const Camera& camera, int width, int height) {
    const Basis basis = look_basis(camera.look_at - camera.eye, camera.up);
    CameraRays rays{};
    set(rays.eye, camera.eye);
    rays.perspective = camera.kind == CameraKind::perspective;
    if (rays.perspective) {
        const double half = 0.5 * camera.vfov_deg * (num::pi / 180.0);
        const double tangent_per_pixel = num::sin(half) / (0.5 * height * num::cos(half));
        const Vec3d x = basis.right * tangent_per_pixel, y = basis.up * -tangent_per_pixel;
        set(rays.dir_x, x);
        set(rays.dir_y, y);
        set(rays.dir0, basis.forward + x * (-0.5 * width) + y * (-0.5 * height));
        rays.z_scale = static_cast<float>(-camera.near_m);
    } else {
        const double m_per_pixel = camera.height_m / height;
        const Vec3d x = basis.right * m_per_pixel, y = basis.up * -m_per_pixel;
        set(rays.dir0, basis.forward);
        set(rays.origin_x, x);
        set(rays.origin_y, y);
        set(rays.origin0, x * (-0.5 * width) + y * (-0.5 * height));
        rays.z_scale = static_cast<float>(orthographic_camera_range_m);
        rays.z_near = static_cast<float>(camera.near_m);
    }
    return rays;
}

}  // namespace obscura
