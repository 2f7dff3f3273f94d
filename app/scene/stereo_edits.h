#pragma once
// The kinds of [[stereo.edit]] there are: one row each, its keys and how they are read.

#include <optional>
#include <string>
#include <vector>

#include "app/models/file_access.h"
#include "app/scene/scene.h"
#include "app/scene/scene_file.h"
#include "app/scene/schema.h"
#include "stereo/edit.h"

namespace obscura {

/// What an edit's keys mean depends on: names on the scene's objects, points and percent on its picture.
struct EditContext {
    const SceneDocument& document;
    const Scene& scene;  ///< set to the frame
    const FileAccess& access;
    double px = 1;  ///< pixels of the scene's picture per pixel of the document's
};

struct EditKindRow {
    const char* name;  ///< in scene files, and when it is told of
    const char* doc;
    std::vector<KeySpec> keys;
    /// What the edit asks for; nothing when a point of it is behind the camera.
    std::optional<decltype(StereoEdit::what)> (*read)(const EditContext& context, const SceneTable& edit);
};

/// In the order of StereoEdit::what.
const std::vector<EditKindRow>& stereo_edit_kinds();

/// The edit of a table, which is as it stands at the frame; nothing when a point of it is behind the camera.
/// Throws InputError: objects and material slots that the scene does not have, masks that cannot be read;
/// LimitError.
std::optional<StereoEdit> stereo_edit_of(const EditContext& context, const SceneTable& edit);

}  // namespace obscura
