#include "app/frame/load_scene.h"

#include <fmt/format.h>

#include "app/frame/memory.h"
#include "app/frame/shadow_cache.h"
#include "app/frame/shadows.h"
#include "app/frame/stack_shadow.h"
#include "app/scene/validate.h"
#include "core/error.h"
#include "optics/pixel_integrals.h"

namespace obscura {
namespace {

/// Refuses shadow caches that cannot be read, at the place that names them, and those that would be written
/// over what the scene reads; then their files are read, too.
void check_caches(const SceneDocument& document, const FileAccess& access) {
    std::vector<std::filesystem::path> files;
    for (const SceneTable* light : subtables(document.root, "light")) {
        const SceneEntry* cache = subtable(*light, "shadow").find("cache");
        if (cache == nullptr) continue;
        const std::string& folder = std::get<std::string>(cache->value.data);
        try {
            const auto method = value_named(shadow_method_words, text(subtable(*light, "shadow"), "method"));
            files.push_back(shadow_cache_file(access, folder, text(*light, "id"), method));
        } catch (const InputError& error) {
            fail_at(cache->value.place, document.sources, fmt::format("'{}': {}", folder, error.message));
        }
        if (access.read) check_cache_not_read(files.back(), *access.read);
    }
    // Two that are one file are told apart by their keys, as a kept shadow of another scene is.
    for (const auto& file : files)
        if (access.read) access.read->add(file);
}

/// Refuses stacks of lights that have no plane of focus, in the first frame.
void check_stacks(const SceneDocument& document, const Scene& scene) {
    const std::vector<const SceneTable*> lights = subtables(document.root, "light");
    check_stack_plans(scene, [&](std::size_t light, const std::string& why) {
        fail_at(place_of(subtable(*lights[light], "shadow"), "method"), document.sources, why);
    });
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
    check_stacks(document, scene);
    check_memory(estimated(document, [&] { return estimate_memory(scene); }), limits, document.sources[0]);
    return scene;
}

}  // namespace obscura
