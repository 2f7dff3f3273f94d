#pragma once
// The shadows of one light, ready for lookups: a dense map, a tree per view, casters in order, a stack or a
// day.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/frame/light_shadow_stats.h"
#include "app/scene/scene.h"
#include "hierarchy/shadow_tree.h"
#include "hierarchy/stack/stack.h"
#include "hierarchy/terrain/day_shadow.h"
#include "raster/exact/casters.h"
#include "raster/shadow_map.h"

namespace obscura {

struct LightShadow {
    SceneLight light;  ///< what it was made for; its resolution as found
    Camera camera;     ///< and for this picture, when scope is "frame"
    RenderSettings render;
    Region seen;                        ///< the picture with its margin
    Bounds casters;                     ///< caster_box() for the light's direction, when it is parallel
    ShadowMap map;                      ///< method "map",
    std::vector<ShadowTree> trees;      ///< "compressed"
    std::vector<Casters> exact;         ///< "exact", and "day" of what is not its ground
    std::optional<ShadowStack> stack;   ///< "stack"
    std::shared_ptr<const DaySun> day;  ///< or "day"
    LightShadowStats stats;

    bool empty() const { return map.views.empty() && trees.empty() && exact.empty() && !stack && !day; }
    const LightView& view(int i) const {
        const auto at = static_cast<std::size_t>(i);
        return !exact.empty() ? exact[at].view : trees.empty() ? map.views[at] : trees[at].view;
    }
};

/// Whether what was made for `a` serves `b`: all that reaches a shadow is equal.
bool same_shadow(const SceneLight& a, const SceneLight& b);
/// Whether lookups of one picture are those of the other.
bool same_picture(const LightShadow& shadow, const Camera& camera, const RenderSettings& render,
                  const Region& seen);

}  // namespace obscura
