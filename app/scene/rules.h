#pragma once
// What a scene must satisfy beyond its schema: rules about more than one key.

#include "app/scene/scene_file.h"

namespace obscura {

/// Checks references, unique ids and contradictions, and fills in defaults that depend on other keys:
/// the camera's angle of view, shadow.LIGHT moves into its light, receivers follow [render].
/// Throws InputError or LimitError.
void apply_rules(SceneDocument& document);

}  // namespace obscura
