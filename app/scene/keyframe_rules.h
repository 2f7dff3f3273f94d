#pragma once
// What keyframes of one target must satisfy.

#include <string>
#include <vector>

#include "app/scene/schema.h"
#include "app/scene/value.h"

namespace obscura {

/// Every key must be one that `target` has, or an animated one of `further` (keys without a default); frames
/// must rise. `what` the target is: "[camera]". Throws InputError.
void check_keyframes(const std::vector<const SceneTable*>& keyframes, const SceneTable& target,
                     const std::string& what, const std::vector<KeySpec>& further,
                     const std::vector<std::string>& sources);

}  // namespace obscura
