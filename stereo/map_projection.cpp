#include "stereo/map_projection.h"

#include "core/error.h"
#include "raster/camera_rays.h"
#include "raster/view.h"

namespace obscura {

MapPoint MapProjection::project(Vec3f world) const {
    const Vec3d p = to_double(world);
    const Vec4d h = view.to_map * Vec4d{p.x, p.y, p.z, 1.0};
    return {h.x, h.y, h.w};
}

MapProjection map_projection(const Camera& camera, const MiddleView& view) {
    CHECK(camera.kind == CameraKind::perspective, "parallel rays have no disparity");
    CHECK(view.reduction == 1 && view.width() == view.picture_width + 2 * view.margin_px &&
              view.height() == view.picture_height,
          "vertices follow maps of full resolution");
    MapProjection p;
    // Margins widen the picture on both sides alike and leave the focal length, which goes by the height.
    p.view = camera_view(camera, view.width(), view.height());
    const CameraRays rays = camera_rays(camera, view.width(), view.height());
    p.eye = {rays.eye[0], rays.eye[1], rays.eye[2]};
    p.ray0 = {rays.dir0[0], rays.dir0[1], rays.dir0[2]};
    p.ray_x = {rays.dir_x[0], rays.dir_x[1], rays.dir_x[2]};
    p.ray_y = {rays.dir_y[0], rays.dir_y[1], rays.dir_y[2]};
    p.focal_px = 1.0 / length(p.ray_x);
    p.near_m = camera.near_m;
    return p;
}

}  // namespace obscura
