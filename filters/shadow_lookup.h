#pragma once
// From a light and its shadow map to what the lookups read, and one lookup with everything it saw.

#include <span>
#include <vector>

#include "core/scene.h"
#include "filters/pcf.h"
#include "raster/shadow_map.h"

namespace obscura {

/// Where a light's lookups fall on maps with these views; without stored depths, for pcf_place().
PcfLight pcf_light(const Light& light, std::span<const LightView> views, Vec3d eye);

/// `map` must outlive the result. `eye`: the point that receivers are relative to.
PcfLight pcf_light(const Light& light, const ShadowMap& map, Vec3d eye);

namespace ref {

/// Where the lookup of a sample falls.
struct PcfPlace {
    /// nothing_there: not covered. turned_away: dark without a lookup. before_near: lit without one.
    enum Kind { nothing_there, turned_away, before_near, on_map } kind = nothing_there;
    int view = 0;
    double X = 0, Y = 0;             ///< texels, not farther off the map than 8
    float depth = 0;                 ///< of the receiver
    float slope_x = 0, slope_y = 0;  ///< of its plane: depth per texel
};
PcfPlace pcf_place(const SurfaceBlock& surface, const PcfLight& light, int at);

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
