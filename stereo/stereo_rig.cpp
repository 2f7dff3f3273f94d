#include "stereo/stereo_rig.h"

#include <limits>

#include "core/error.h"
#include "core/num.h"
#include "core/scene.h"

namespace obscura {
namespace {

constexpr double degrees = 180.0 / num::pi;

}  // namespace

DisparityLaw disparity_law(const StereoRig& rig, const Camera& camera, int height) {
    CHECK(camera.kind == CameraKind::perspective && rig.interaxial_m > 0 && rig.zero_parallax_m > 0);
    DisparityLaw law;
    law.focal_px = 0.5 * height / num::tan(camera.vfov_deg / (2 * degrees));
    law.scale = law.focal_px * rig.interaxial_m;
    law.offset = law.scale / rig.zero_parallax_m;
    return law;
}

// Lines of sight through the eyes at +-e/2 and the screen points at -+s/2 meet at the angle
// 2 atan((e + s) / 2v), s the disparity on the screen in metres; the screen itself is s = 0.

double vergence_deg(double disparity_px, int picture_width, const StereoRig& rig) {
    const double s = disparity_px * rig.screen_width_m / picture_width;
    const double v = 2 * rig.viewing_distance_m, e = rig.eye_separation_m;
    return 2 * degrees * (num::atan((e + s) / v) - num::atan(e / v));
}

double disparity_of_vergence(double vergence_deg, int picture_width, const StereoRig& rig) {
    const double v = 2 * rig.viewing_distance_m, e = rig.eye_separation_m;
    const double half = vergence_deg / (2 * degrees) + num::atan(e / v);
    // Eyes cannot turn in so far: beyond any disparity.
    if (half >= num::pi / 2) return std::numeric_limits<double>::infinity();
    const double s = v * num::tan(half) - e;
    return s * picture_width / rig.screen_width_m;
}

}  // namespace obscura
