#pragma once
// What [optics] must agree with.

#include <string>
#include <vector>

#include "app/scene/value.h"

namespace obscura {

/// Judges [optics], when there is one, against the camera: perspective, and one definition of the lens.
void check_optics(const SceneTable& root, const std::vector<std::string>& sources);

/// The same at one frame: pixels and focal lengths that nothing has fail, and so do a focal length and a
/// sensor's width that do not fit the angle of view.
void check_lens(const SceneTable& optics, const SceneTable& camera, Size2 size_px,
                const std::vector<std::string>& sources);

}  // namespace obscura
