#include "app/scene/scene_file.h"

#include <fmt/format.h>

#include "app/models/file_access.h"
#include "app/scene/keys.h"
#include "app/scene/override.h"
#include "app/scene/precheck.h"
#include "app/scene/rules.h"
#include "app/scene/toml_parse.h"
#include "app/scene/toml_text.h"
#include "app/scene/validate.h"
#include "core/error.h"

namespace obscura {
namespace {

/// A scene file that is too large is bad input, whatever the limits say.
std::string read_scene_bytes(const std::filesystem::path& file, std::int64_t largest) {
    try {
        return read_file(file, largest);
    } catch (const LimitError&) {
        throw InputError(file.string(), fmt::format("scene file is larger than {} bytes", largest));
    }
}

}  // namespace

SceneDocument read_scene_text(std::string_view text, const std::string& filename,
                              const std::vector<std::string>& overrides) {
    SceneDocument document;
    document.sources.push_back(filename);
    precheck_scene_text(text, filename);
    SceneTable raw = parse_toml(text, filename, 0);
    if (raw.entries.empty()) throw InputError(filename, "no camera: the scene is empty");
    for (const std::string& override_text : overrides) {
        apply_override(raw, override_text, static_cast<int>(document.sources.size()));
        document.sources.push_back("-D " + override_text);
    }
    document.root = validate_table(raw, Place{0, 0, 0}, scene_schema_root(), document.sources);
    apply_rules(document);
    return document;
}

SceneDocument read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    constexpr std::int64_t largest = TextBounds{}.bytes;
    SceneDocument document = read_scene_text(read_scene_bytes(file, largest), file.string(), overrides);
    document.folder = file.has_parent_path() ? file.parent_path() : ".";
    return document;
}

std::string dump_scene(const SceneDocument& document) {
    return toml_document(document.root);
}

}  // namespace obscura
