#pragma once
// What one light's shadows are and what they took.

#include <cstdint>
#include <optional>
#include <string>

#include "app/scene/scene.h"
#include "hierarchy/build.h"

namespace obscura {

/// What was found for one light.
struct FoundResolution {
    int resolution = least_map_resolution;
    double magnification = 0;  ///< at that resolution, of the pixel that needs most; 0: no pixel asks
    bool capped = false;       ///< most_map_resolution does not suffice
    int x = -1, y = -1;        ///< that pixel
};

/// What one light's shadows are and what they took. Counts of trees are sums over the views.
struct LightShadowStats {
    std::string light;
    ShadowMethod method = ShadowMethod::map;
    ShadowCode code = ShadowCode::mh;       ///< compressed: what trees are written in,
    std::string code_text;                  ///< and in which of its ways, the first of them;
    std::string code_reason;                ///< and why, when the scene leaves that open
    ShadowScope scope = ShadowScope::full;  ///< what was built: a frame that asks for too much gets all
    int resolution = 0;
    std::int64_t views = 0;
    std::optional<FoundResolution> found;  ///< resolution "auto"
    bool kept = false;                     ///< from the frame before
    bool from_cache = false;               ///< read from a file
    int samples = 1;           ///< points of a light with a size that each pixel asks; maps of a stack
    float penumbra_px = 0;     ///< samples "auto": of the widest penumbra, up to most_auto_samples
    int anisotropy = 0;        ///< stack: of its octree
    std::int64_t casters = 0;  ///< exact: triangles, in all views together; day: those beside the ground
    std::string sun_text;      ///< day: the file's sun whose shadows are taken,
    double sun_off_deg = 0;    ///< and how far from the light it stands
    MultiresCounts nodes;
    std::uint64_t bytes = 0;  ///< of the map or the serialised trees, top grids included
    BuildStats build;
    std::int64_t needed = 0;  ///< scope "frame": squares that lookups read
    double encode_s = 0;      ///< serialising; build.setup_s and build.build_s come before
    double lookup_s = 0;      ///< in lookups, all threads together
};

}  // namespace obscura
