#include "app/frame/shadow_method.h"

#include "app/frame/dense_shadow.h"
#include "app/frame/exact_shadow.h"
#include "app/frame/stack_shadow.h"
#include "app/frame/tree_shadow.h"
#include "core/error.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

constexpr ShadowMethodRow rows[] = {
    {ShadowMethod::map, nullptr, make_dense_shadow, give_dense_shadow, dense_shadow_text},
    {ShadowMethod::compressed, tree_resolution, make_tree_shadow, give_tree_shadow, tree_shadow_text},
    {ShadowMethod::exact, nullptr, make_exact_shadow, give_exact_shadow, exact_shadow_text},
    {ShadowMethod::stack, stack_resolution, make_stack_shadow, give_stack_shadow, stack_shadow_text},
};

}  // namespace

const ShadowMethodRow& row_of(ShadowMethod method) {
    for (const ShadowMethodRow& row : rows)
        if (row.method == method) return row;
    CHECK(false, "a light without shadows has none to make");
    return rows[0];
}

bool wants_auto(const SceneLight& light) {
    return light.shadow.resolution == auto_resolution && light.shadow.method != ShadowMethod::none &&
           row_of(light.shadow.method).query != nullptr;
}

Bounds casters_of(const Scene& scene, const Light& light) {
    return is_parallel(light.kind) ? caster_box(scene.mesh, light.direction) : Bounds{};
}

}  // namespace obscura
