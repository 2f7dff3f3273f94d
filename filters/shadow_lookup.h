#pragma once
// From a light and its shadow map or trees to what the lookups read, and one lookup with everything it saw.

#include <span>
#include <vector>

#include "core/scene.h"
#include "filters/pcf.h"
#include "filters/pcf_place.h"
#include "hierarchy/shadow_tree.h"
#include "raster/shadow_map.h"

namespace obscura {

struct PcfParams {
    int side = 3;  ///< of the kernel, texels: odd, to 5 (maps) or max_tree_pcf_side (trees)
    double normal_offset_texels = 0;  ///< of receivers on open components, beyond what rounding asks for
};

/// Where a light's lookups fall on maps with these views; without stored depths, for pcf_place(). `eye`: the
/// point that receivers are relative to.
PcfLight pcf_light(const Light& light, const PcfParams& params, std::span<const LightView> views, Vec3d eye);

/// `map` must outlive the result.
PcfLight pcf_light(const Light& light, const PcfParams& params, const ShadowMap& map, Vec3d eye);

/// The same with trees of the light's views, one or six, square; they must outlive the result.
PcfLight pcf_light(const Light& light, const PcfParams& params, std::span<const ShadowTree> trees, Vec3d eye);

/// Turns a light with trees, or still without, to hierarchical filtering, for pictures of that camera.
void filter_hierarchically(PcfLight& light, const CameraRays& camera);

namespace ref {

/// One texel that a lookup asked, or a square of 2^level texels.
struct PcfTap {
    std::int32_t x = 0, y = 0;  ///< in squares of that level
    int level = 0;
    float weight = 0;
    bool inside = false;  ///< of the map; outside (parallel light only) counts as lit
    float receiver = 0;   ///< depth of the receiver's plane there, at most that of the receiver
    float stored = 1;
    bool lit = true;
};

/// Nodes of a tree that one lookup visits when nothing is known from its neighbours.
struct PcfSteps {
    int naive = 0;   ///< every tap from the root
    int shared = 0;  ///< the taps' common way once, and from tap to tap what is new
};

/// Everything about the lookup of sample `at`.
struct PcfTrace {
    /// False: nothing there, faces away (visibility 0), or before the near plane (1).
    bool looked_up = false;
    int view = 0;
    double X = 0, Y = 0;       ///< texels
    float depth = 0;           ///< of the receiver
    float tap_texels = 1;      ///< as PcfPlace has it
    std::vector<PcfTap> taps;  ///< side x side; hierarchical between two levels: those of the coarser follow
    float visibility = 0;
    PcfSteps steps;  ///< trees only
};
PcfTrace trace_pcf(const SurfaceBlock& surface, const PcfLight& light, int at);

/// trace_pcf(...).steps alone: what a picture of the paper's figure 6 shows of every sample.
PcfSteps pcf_steps(const SurfaceBlock& surface, const PcfLight& light, int at);

}  // namespace ref
}  // namespace obscura
