#pragma once

#include "app/scene/build.h"

namespace obscura {

/// build_scene(), refused where the frame would not have the memory (before anything is loaded as far as the
/// document tells, and again once meshes and textures are there) or where a shadow cache is no folder that
/// may be used. Throws InputError, LimitError.
Scene load_scene(const SceneDocument& document, const FileAccess& access);

}  // namespace obscura
