#include "stereo/comfort.h"

#include <algorithm>

namespace obscura {

ComfortZone comfort_of_percent(double nearest, double farthest, int picture_width) {
    return {nearest / 100 * picture_width, farthest / 100 * picture_width};
}

ComfortZone comfort_of_degrees(double nearest, double farthest, int picture_width, const StereoRig& rig) {
    return {disparity_of_vergence(nearest, picture_width, rig),
            disparity_of_vergence(farthest, picture_width, rig)};
}

ComfortZone common(const ComfortZone& a, const ComfortZone& b) {
    return {std::min(a.nearest_px, b.nearest_px), std::max(a.farthest_px, b.farthest_px)};
}

}  // namespace obscura
