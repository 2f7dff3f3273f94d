#pragma once
// From a light and its shadow map to what the lookups read, and one lookup with everything it saw.

#include <vector>

#include "core/scene.h"
#include "filters/pcf.h"
#include "raster/shadow_map.h"

namespace obscura {

/// `map` must outlive the result. `eye`: the point that receivers are relative to.
PcfLight pcf_light(const Light& light, const ShadowMap& map, Vec3d eye);

namespace ref {

/// One texel that a lookup asked.
struct PcfTap {
    std::int32_t x = 0, y = 0;
    float weight = 0;
    bool inside = false;  ///< of the map; outside (parallel light only) counts as lit
    float receiver = 0;   ///< depth of the receiver's plane there, at most that of the receiver
    float stored = 1;
    bool lit = true;
};

/// Everything about the lookup of sample `at`.
struct PcfTrace {
    bool looked_up =
        false;  ///< false: nothing there, faces away (visibility 0), or before the near plane (1)
    int view = 0;
    double X = 0, Y = 0;  ///< texels
    float depth = 0;      ///< of the receiver
    std::vector<PcfTap> taps;
    float visibility = 0;
};
PcfTrace trace_pcf(const SurfaceBlock& surface, const PcfLight& light, int at);

}  // namespace ref
}  // namespace obscura
