#include "app/scene_file.h"

#include <fmt/format.h>

#include "app/scene_file_parse.h"
#include "app/scene_keys.h"
#include "app/scene_override.h"
#include "app/scene_precheck.h"
#include "app/scene_rules.h"
#include "app/scene_toml_text.h"
#include "app/scene_validate.h"

namespace obscura {

SceneDocument read_scene_text(std::string_view text, const std::string& filename,
                              const std::vector<std::string>& overrides) {
    SceneDocument document;
    document.sources.push_back(filename);
    precheck_scene_text(text, filename);
    SceneTable raw = parse_toml(text, filename, 0);
    for (const std::string& override_text : overrides) {
        apply_override(raw, override_text, static_cast<int>(document.sources.size()));
        document.sources.push_back("-D " + override_text);
    }
    document.root = validate_table(raw, Place{0, 0, 0}, scene_schema_root(), document.sources);
    apply_rules(document);
    return document;
}

std::string dump_scene(const SceneDocument& document) {
    return toml_document(document.root);
}

}  // namespace obscura
