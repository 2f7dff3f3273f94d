#pragma once
// Rules of shadow settings: where they stand, which keys go together, what they default to.

#include <string>
#include <vector>

#include "app/scene/value.h"

namespace obscura {

/// Moves [shadow.LIGHT] and [shadow] into the lights they are for and completes them: each light's `shadow`
/// then has every key that its method reads. Throws InputError.
void merge_shadows(SceneTable& root, const std::vector<std::string>& light_ids,
                   const std::vector<std::string>& sources);

/// Why a light of a completed document casts its shadows as it does: "as asked", "'resolution' is of maps",
/// "one frame", ...
std::string shadow_method_reason(const SceneTable& root, const SceneTable& light);

}  // namespace obscura
