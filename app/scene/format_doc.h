#pragma once
// The scene format in Markdown, out of the same declarations that read it.

#include <string>

namespace obscura {

/// What app/scene/format.md holds; a test compares them. `obscura dump --format` prints it.
std::string scene_format_doc();

}  // namespace obscura
