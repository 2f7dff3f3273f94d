#include "app/scene/named_files.h"

#include <algorithm>
#include <string>

#include "app/scene/keys.h"
#include "app/scene/schema.h"
#include "app/scene/validate.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

struct Search {
    const fs::path& folder;
    std::vector<fs::path> found;

    void add(std::string name) {
        found.push_back(folder / name);
        if (name.find('\\') == std::string::npos) return;
        std::replace(name.begin(), name.end(), '\\', '/');
        found.push_back(folder / name);
    }
    void in_keys(const SceneTable& table, const std::vector<KeySpec>& keys) {
        for (const KeySpec& key : keys)
            if (const SceneEntry* entry = table.find(key.name)) in_value(entry->value, key);
    }
    void in_table(const SceneTable& table, const TableSpec& spec) {
        in_keys(table, spec.keys);
        if (const VariantSpec* variant = variant_of(table, spec)) in_keys(table, variant->keys);
    }
    void in_value(const SceneValue& value, const KeySpec& key) {
        if (key.type == KeyType::file && !key.folder && !key.written) add(std::get<std::string>(value.data));
        if (key.type == KeyType::table) in_table(std::get<SceneTable>(value.data), *key.table);
        if (key.type == KeyType::table_list) {
            for (const SceneValue& item : std::get<SceneList>(value.data))
                in_table(std::get<SceneTable>(item.data), *key.table);
        }
        if (key.type == KeyType::table_map) {
            for (const SceneEntry& entry : std::get<SceneTable>(value.data).entries)
                if (const auto* table = std::get_if<SceneTable>(&entry.value.data))
                    in_table(*table, *key.table);
        }
    }
};

}  // namespace

std::vector<fs::path> named_files(const SceneDocument& document) {
    Search search{document.folder, {}};
    search.in_table(document.root, scene_schema_root());
    return std::move(search.found);
}

}  // namespace obscura
