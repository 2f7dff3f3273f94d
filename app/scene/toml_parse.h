#pragma once
// TOML text -> SceneTable.

#include <string>
#include <string_view>

#include "app/scene/value.h"

namespace obscura {

/// Parses `text`, which passed precheck_scene_text(). Entries keep the order of the file; every place gets
/// `source`. Throws InputError at the first syntax error or redefinition of a key.
SceneTable parse_toml(std::string_view text, const std::string& filename, int source);

}  // namespace obscura
