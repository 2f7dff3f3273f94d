#pragma once
// What [stereo] and its edits must agree with.

#include <string>
#include <vector>

#include "app/scene/scene_file.h"

namespace obscura {

/// Judges [stereo], its edits and their keyframes, when there are any, at every frame: a perspective camera,
/// targets that the scene has, one unit for every quantity. Objects inside of files are not known yet.
/// `materials`: names of [material.NAME]. Throws InputError.
void check_stereo(const SceneDocument& document, const std::vector<std::string>& mesh_ids,
                  const std::vector<std::string>& materials);

}  // namespace obscura
