#pragma once
// A scene file from text to values: pre-checks, TOML, overrides, schema, rules. What comes out is complete
// and valid; building meshes and lights from it is build.h.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/value.h"

namespace obscura {

/// A validated scene, defaults included.
struct SceneDocument {
    SceneTable root;
    /// Names for error messages: the file, then "-D key=value" per override.
    std::vector<std::string> sources;
    std::filesystem::path folder;  ///< of the scene file: what its paths are relative to
};

/// Reads a scene out of `text`; `filename` is for messages. Overrides are "dotted.key=value", the value in
/// TOML (a bare word is a string). A list is entered by the `id` of an element or its number from 0. Throws
/// InputError (file:line:column: message) and LimitError (frames, image size).
SceneDocument read_scene_text(std::string_view text, const std::string& filename,
                              const std::vector<std::string>& overrides = {});

/// The same out of a file, which must be a regular one.
SceneDocument read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The effective scene as TOML, defaults included. Reading that gives the same document again.
std::string dump_scene(const SceneDocument& document);

}  // namespace obscura
