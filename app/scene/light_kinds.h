#pragma once
// The kinds of light there are: one row each. What raster must know of a kind stands beside its enumerator in
// core/scene.h: whether it is parallel, and how many views its shadow map has.

#include <string>
#include <vector>

#include "app/scene/key_row.h"
#include "core/scene.h"

namespace obscura {

struct LightKindRow {
    LightKind kind;
    const char* name;  ///< in scene files, and when it is told of
    const char* doc;
    KeyRows<Light> keys;
    /// Members that follow from several keys; the others are set already. Null: none.
    void (*finish)(const SceneTable& table, Light& light);
    /// Refuses keys that contradict one another, at the frame that the table is of. Null: none can.
    void (*check)(const SceneTable& table, const std::vector<std::string>& sources);
};

const std::vector<LightKindRow>& light_kinds();

const char* light_kind_name(LightKind kind);

/// The row that a [[light]] is of.
const LightKindRow& light_kind_of(const SceneTable& light);

}  // namespace obscura
