#pragma once
// The shapes a [[mesh]] can ask for by name. Adding a generator is one entry in shapes.cpp or generators.cpp:
// its keys with ranges, defaults and words, how many triangles it will make, and the call.

#include <cstdint>
#include <functional>
#include <vector>

#include "app/scene/schema.h"
#include "scenes/build.h"

namespace obscura {

struct ShapeSpec {
    VariantSpec variant;                                           ///< name, description, keys
    std::function<std::int64_t(const SceneTable&)> max_triangles;  ///< a bound, known before anything is made
    std::function<GeneratedModel(const SceneTable&)> make;         ///< without materials: one default slot
    std::function<std::string(const SceneTable&)> problem =
        nullptr;  ///< what is wrong between keys; "" = nothing
};

/// All shapes but "file".
const std::vector<ShapeSpec>& shapes();

/// The shape of that name; null when there is none (or for "file").
const ShapeSpec* find_shape(std::string_view name);

/// Bound of the triangles that a validated [[mesh]] with its instances will have; 0 for files, which are
/// counted when they are read.
std::int64_t max_triangles(const SceneTable& mesh);

}  // namespace obscura
