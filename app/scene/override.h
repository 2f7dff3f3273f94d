#pragma once
// -D key=value: values that replace or complete those of a scene file.

#include <string>
#include <vector>

#include "app/scene/value.h"

namespace obscura {

/// Puts "dotted.key=value" into the raw tree; its places get `source`. The schema judges the result later.
/// Throws InputError named "-D dotted.key=value".
void apply_override(SceneTable& root, const std::string& text, int source);

}  // namespace obscura
