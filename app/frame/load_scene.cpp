#include "app/frame/load_scene.h"

#include <fmt/format.h>

#include "app/frame/memory.h"
#include "app/frame/shadow_cache.h"
#include "app/scene/validate.h"
#include "core/error.h"

namespace obscura {
namespace {

/// Refuses shadow caches that cannot be read, at the place that names them.
void check_caches(const SceneDocument& document, const FileAccess& access) {
    for (const SceneTable* light : subtables(document.root, "light")) {
        const SceneEntry* cache = subtable(*light, "shadow").find("cache");
        if (cache == nullptr) continue;
        const std::string& folder = std::get<std::string>(cache->value.data);
        try {
            shadow_cache_folder(access, folder);
        } catch (const InputError& error) {
            fail_at(cache->value.place, document.sources, fmt::format("'{}': {}", folder, error.message));
        }
    }
}

}  // namespace

Scene load_scene(const SceneDocument& document, const FileAccess& access) {
    const Limits limits = limits_of(document);
    check_memory(estimate_memory(document), limits, document.sources[0]);
    Scene scene = build_scene(document, access);
    check_caches(document, access);
    check_memory(estimate_memory(scene), limits, document.sources[0]);
    return scene;
}

}  // namespace obscura
