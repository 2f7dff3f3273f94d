#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "stereo/edit.h"

namespace obscura {
namespace {

/// 1 at ends[0] and before, 0 at ends[1] and past it, a smoothstep between, in either direction.
double smooth_fade(const std::array<double, 2>& ends, double x) {
    const double span = ends[1] - ends[0];
    if (span == 0) return x <= ends[0] ? 1 : 0;
    const double t = std::clamp((x - ends[0]) / span, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

}  // namespace

double fade_factor(const WeightFade& fade, const Vec3d& eye, const Vec3d& forward) {
    double factor = 1;
    if (fade.angle_deg) {
        const double lengths = std::sqrt(dot(forward, forward) * dot(fade.direction, fade.direction));
        const double cosine = lengths > 0 ? std::clamp(dot(forward, fade.direction) / lengths, -1.0, 1.0) : 1;
        factor *= smooth_fade(*fade.angle_deg, num::acos(cosine) * 180 / num::pi);
    }
    if (fade.distance_m) {
        const Vec3d away = eye - fade.position_m;
        factor *= smooth_fade(*fade.distance_m, std::sqrt(dot(away, away)));
    }
    return factor;
}

}  // namespace obscura
