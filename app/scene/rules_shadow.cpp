#include "app/scene/rules_shadow.h"

#include <fmt/format.h>

#include "app/scene/keys.h"
#include "app/scene/scene.h"
#include "app/scene/validate.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

constexpr const char* compressed_keys[] = {"scope",  "filter",     "max_magnification",
                                           "layout", "top_levels", "cache"};
constexpr std::int64_t dense_default = 4096, most_dense_filter_px = 5;

void set_default(SceneTable& table, const char* key, SceneValue value) {
    if (!table.has(key)) table.set(key, std::move(value));
}

void refuse_compressed_keys(const SceneTable& settings, const Sources& sources) {
    for (const char* key : compressed_keys) {
        if (settings.has(key)) {
            fail_at(settings.find(key)->place, sources,
                    fmt::format("'{}' needs method = \"compressed\"", key));
        }
    }
}

void complete_dense(SceneTable& settings, const Sources& sources) {
    set_default(settings, "resolution", value_of(dense_default));
    const SceneValue& resolution = settings.find("resolution")->value;
    if (std::holds_alternative<std::string>(resolution.data)) {
        fail_at(resolution.place, sources, "'resolution' = \"auto\" needs method = \"compressed\"");
    }
    const SceneValue& filter = settings.find("filter_px")->value;
    if (std::get<std::int64_t>(filter.data) > most_dense_filter_px) {
        fail_at(filter.place, sources,
                fmt::format("'filter_px' must be 1, 3 or 5 with method = \"map\", not {}",
                            std::get<std::int64_t>(filter.data)));
    }
    if (std::get<std::int64_t>(resolution.data) > most_dense_resolution) {
        fail_at(resolution.place, sources,
                fmt::format("'resolution' must be at most {} with method = \"map\"", most_dense_resolution));
    }
}

void complete_compressed(SceneTable& settings, const SceneEntry* cache, const Sources& sources) {
    static const ShadowSettings d;
    const bool own_cache = settings.has("cache");
    if (!own_cache && cache != nullptr) settings.set("cache", cache->value);
    const bool frame = settings.has("scope") && text(settings, "scope") == "frame";
    if (own_cache && frame) {
        fail_at(settings.find("cache")->place, sources, "'cache' needs scope = \"full\"");
    }
    // A cache for all lights is none for those that say scope = "frame".
    if (frame) settings.erase("cache");
    set_default(settings, "resolution", value_of("auto"));
    set_default(settings, "scope", value_of(settings.has("cache") ? "full" : "frame"));
    set_default(settings, "filter", value_of("pcf"));
    const bool automatic = std::holds_alternative<std::string>(settings.find("resolution")->value.data);
    if (automatic) {
        set_default(settings, "max_magnification", value_of(d.max_magnification));
    } else if (settings.has("max_magnification")) {
        fail_at(settings.find("max_magnification")->place, sources,
                "'max_magnification' needs resolution = \"auto\"");
    }
    set_default(settings, "layout", value_of("words24"));
    set_default(settings, "top_levels", value_of(std::int64_t{d.top_levels}));
}

/// Into the order of the schema, as a table is that was read with all its keys.
void order_keys(SceneTable& settings) {
    SceneTable ordered;
    for (const KeySpec& key : shadow_table().keys) {
        if (SceneEntry* entry = settings.find(key.name)) ordered.entries.push_back(std::move(*entry));
    }
    settings = std::move(ordered);
}

}  // namespace

void merge_shadows(SceneTable& root, const std::vector<std::string>& light_ids, const Sources& sources) {
    const SceneTable none;
    const SceneTable& shadows = root.has("shadow") ? subtable(root, "shadow") : none;
    const SceneEntry* cache = nullptr;
    for (const SceneEntry& entry : shadows.entries) {
        if (std::holds_alternative<SceneTable>(entry.value.data)) {
            require_known(entry.key, entry.place, light_ids, "light", sources);
        } else {
            cache = &entry;
        }
    }
    if (!root.has("light")) {
        root.erase("shadow");
        return;
    }
    for (SceneValue& item : std::get<SceneList>(root.find("light")->value.data)) {
        auto& light = std::get<SceneTable>(item.data);
        const SceneEntry* shadow = shadows.find(text(light, "id"));
        if (shadow != nullptr && shadow != cache) {
            if (place_of(light, "shadow").source >= 0) {
                fail_at(shadow->place, sources,
                        fmt::format("light '{}' has its own 'shadow'; set light.{}.shadow instead",
                                    shadow->key, shadow->key));
            }
            light.set("shadow", shadow->value);
        }
        auto& settings = std::get<SceneTable>(light.find("shadow")->value.data);
        set_default(settings, "receivers", value_of(text(subtable(root, "render"), "receivers").c_str()));
        const std::string method = text(settings, "method");
        if (method != "compressed") refuse_compressed_keys(settings, sources);
        if (method == "map") complete_dense(settings, sources);
        if (method == "compressed") complete_compressed(settings, cache, sources);
        order_keys(settings);
    }
    root.erase("shadow");
}

}  // namespace obscura
