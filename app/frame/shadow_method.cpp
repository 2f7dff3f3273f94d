#include "app/frame/shadow_method.h"

#include "app/frame/day_shadow.h"
#include "app/frame/dense_shadow.h"
#include "app/frame/exact_shadow.h"
#include "app/frame/stack_shadow.h"
#include "app/frame/tree_shadow.h"
#include "core/error.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

constexpr ShadowMethodRow rows[] = {
    {.method = ShadowMethod::map,
     .maps_middle = true,
     .whole_blocks = true,
     .uses_layers = true,
     .bytes = dense_shadow_bytes,
     .plan = dense_plan_text,
     .query = nullptr,
     .make = make_dense_shadow,
     .give = give_dense_shadow,
     .text = dense_shadow_text},
    {.method = ShadowMethod::compressed,
     .maps_middle = true,
     .whole_blocks = false,
     .uses_layers = true,
     .bytes = tree_shadow_bytes,
     .plan = tree_plan_text,
     .query = tree_resolution,
     .make = make_tree_shadow,
     .give = give_tree_shadow,
     .text = tree_shadow_text},
    {.method = ShadowMethod::exact,
     .maps_middle = false,
     .whole_blocks = false,
     .uses_layers = false,
     .bytes = exact_shadow_bytes,
     .plan = exact_plan_text,
     .query = nullptr,
     .make = make_exact_shadow,
     .give = give_exact_shadow,
     .text = exact_shadow_text},
    {.method = ShadowMethod::stack,
     .maps_middle = false,
     .whole_blocks = false,
     .uses_layers = true,
     .bytes = stack_shadow_bytes,
     .plan = stack_plan_text,
     .query = stack_resolution,
     .make = make_stack_shadow,
     .give = give_stack_shadow,
     .text = stack_shadow_text},
    {.method = ShadowMethod::day,
     .maps_middle = true,
     .whole_blocks = false,
     .uses_layers = false,
     .bytes = day_shadow_bytes,
     .plan = day_plan_text,
     .query = nullptr,
     .make = make_day_shadow,
     .give = give_day_shadow,
     .text = day_shadow_text},
};

}  // namespace

const ShadowMethodRow& row_of(ShadowMethod method) {
    for (const ShadowMethodRow& row : rows)
        if (row.method == method) return row;
    CHECK(false, "a light without shadows has none to make");
    return rows[0];
}

std::span<const ShadowMethodRow> shadow_methods() {
    return rows;
}

bool wants_auto(const SceneLight& light) {
    return light.shadow.resolution == auto_resolution && light.shadow.method != ShadowMethod::none &&
           row_of(light.shadow.method).query != nullptr;
}

Bounds casters_of(const Scene& scene, const Light& light) {
    return is_parallel(light.kind) ? caster_box(scene.mesh, light.direction) : Bounds{};
}

}  // namespace obscura
