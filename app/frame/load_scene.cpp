#include "app/frame/load_scene.h"

#include <fmt/format.h>

#include "app/frame/memory.h"
#include "app/frame/shadow_cache.h"
#include "app/scene/validate.h"
#include "core/error.h"
#include "optics/pixel_integrals.h"

namespace obscura {
namespace {

/// Refuses shadow caches that cannot be read, at the place that names them; their files are read, too.
void check_caches(const SceneDocument& document, const FileAccess& access) {
    for (const SceneTable* light : subtables(document.root, "light")) {
        const SceneEntry* cache = subtable(*light, "shadow").find("cache");
        if (cache == nullptr) continue;
        const std::string& folder = std::get<std::string>(cache->value.data);
        try {
            const auto place = shadow_cache_folder(access, folder);
            if (access.read) access.read->add(shadow_cache_file(place, text(*light, "id")));
        } catch (const InputError& error) {
            fail_at(cache->value.place, document.sources, fmt::format("'{}': {}", folder, error.message));
        }
    }
}

/// What `estimate` gives; a lens whose pattern is out of reach is told at the place that describes it.
template <class Estimate>
MemoryEstimate estimated(const SceneDocument& document, Estimate&& estimate) {
    try {
        return estimate();
    } catch (const PatternLimit& error) {
        const Place place = document.root.find("optics")->place;
        const std::size_t source = place.source >= 0 ? static_cast<std::size_t>(place.source) : 0;
        throw LimitError(
            InputError(document.sources.at(source), place.line, place.column, error.what()).what());
    }
}

}  // namespace

Scene load_scene(const SceneDocument& document, const FileAccess& access) {
    const Limits limits = limits_of(document);
    check_memory(estimated(document, [&] { return estimate_memory(document); }), limits, document.sources[0]);
    Scene scene = build_scene(document, access);
    check_caches(document, access);
    check_memory(estimated(document, [&] { return estimate_memory(scene); }), limits, document.sources[0]);
    return scene;
}

}  // namespace obscura
