#pragma once
// The rays of a camera, relative to its eye: what turns a sample's depth back into a position. POD: kernels
// include this.

namespace obscura {

struct Camera;

/// The ray of picture position (X, Y), in pixels: origin0 + X origin_x + Y origin_y + z (dir0 + X dir_x + Y
/// dir_y), where z is the distance in metres along the view axis. Everything is relative to the eye.
/// Perspective: origins are 0. Orthographic: the direction is constant.
struct CameraRays {
    double dir0[3], dir_x[3], dir_y[3];
    double origin0[3], origin_x[3], origin_y[3];
    double eye[3];     ///< world position that positions are relative to
    float viewer[3];   ///< perspective: where surfaces are looked at from in shading; the eye itself: 0
    bool perspective;  ///< depth Z of the camera's View: z = z_scale / Z, or else z = z_scale Z + z_near
    float z_scale, z_near;
};

/// The rays of camera_view(camera, width, height).
CameraRays camera_rays(const Camera& camera, int width, int height);

/// Distance along the view axis, metres, from the depth that the view stores.
inline float view_distance(const CameraRays& rays, float depth) {
    return rays.perspective ? rays.z_scale / depth : rays.z_scale * depth + rays.z_near;
}

}  // namespace obscura
