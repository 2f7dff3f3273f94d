#include "app/scene/rules_shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/scene.h"
#include "app/scene/validate.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

constexpr const char* compressed_keys[] = {"scope",      "filter", "max_magnification", "code", "layout",
                                           "top_levels", "cache"};
constexpr const char* exact_keys[] = {"samples"};
constexpr const char* day_keys[] = {"day_file", "max_sun_deg"};
constexpr const char* map_keys[] = {"resolution", "filter_px", "normal_offset_texels"};
/// What stacks have neither of compressed maps nor of maps.
constexpr const char* tree_keys[] = {"scope", "filter", "code", "layout", "top_levels"};
constexpr const char* filter_keys[] = {"filter_px", "normal_offset_texels"};
constexpr std::int64_t dense_default = 4096, most_dense_filter_px = 5;

void set_default(SceneTable& table, const char* key, SceneValue value) {
    if (!table.has(key)) table.set(key, std::move(value));
}

/// The methods that obey a key; `needs` leaves out stacks, which have some keys of each.
std::string methods_of(std::string_view key, const char* needs) {
    if (key == "resolution") return "method = \"map\", \"compressed\" or \"stack\"";
    const bool stack = key == "cache" || key == "max_magnification" || key == "samples";
    return std::string(needs) + (stack ? " or \"stack\"" : "");
}

template <std::size_t n>
void refuse_keys(const SceneTable& settings, const char* const (&keys)[n], const char* needs,
                 const Sources& sources) {
    for (const char* key : keys) {
        if (settings.has(key)) {
            fail_at(settings.find(key)->place, sources,
                    fmt::format("'{}' needs {}", key, methods_of(key, needs)));
        }
    }
}

template <std::size_t n>
bool has_any(const SceneTable& settings, const char* const (&keys)[n]) {
    return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return settings.has(key); });
}

bool has_keyframes(const SceneTable& root, const SceneTable& light) {
    const auto keyframes = subtables(subtable(root, "frames"), "light");
    return std::any_of(keyframes.begin(), keyframes.end(),
                       [&](const SceneTable* k) { return text(*k, "id") == text(light, "id"); });
}

/// Whether the light has penumbrae, which maps of its middle do not show.
bool is_sized(const SceneTable& light) {
    const auto above_zero = [&](const char* key) { return light.has(key) && number(light, key) > 0; };
    return above_zero("angular_diameter_deg") || above_zero("radius_m") || text(light, "type") == "area" ||
           text(light, "type") == "surface";
}

/// Whether shadows of that size are wanted.
bool is_soft(const SceneTable& light, const SceneTable& settings) {
    const SceneEntry* samples = settings.find("samples");
    const auto* count = samples == nullptr ? nullptr : std::get_if<std::int64_t>(&samples->value.data);
    return is_sized(light) && (count == nullptr || *count > 1);
}

/// What shadows a light gets that names no method. Keys that only maps have ask for one. Else one frame, or
/// frames in which the light or what it shines on changes, or a light with a size, have their own samples
/// shaded; a tree pays where both stand still for long.
ShadowMethod planned_method(const SceneTable& settings, bool cached, bool light_moves, bool soft,
                            int frames) {
    if (settings.has("day_file")) return ShadowMethod::day;
    if (settings.has("samples")) return ShadowMethod::exact;
    if (has_any(settings, compressed_keys) || has_any(settings, map_keys) || cached ||
        settings.has("receivers")) {
        return ShadowMethod::compressed;
    }
    return soft || light_moves || frames < tree_break_even_frames ? ShadowMethod::exact
                                                                  : ShadowMethod::compressed;
}

void complete_map(SceneTable& settings) {
    static const ShadowSettings d;
    set_default(settings, "filter_px", value_of(std::int64_t{d.filter_px}));
    set_default(settings, "normal_offset_texels", value_of(d.normal_offset_texels));
}

void complete_dense(SceneTable& settings, const Sources& sources) {
    set_default(settings, "resolution", value_of(dense_default));
    const SceneValue& resolution = settings.find("resolution")->value;
    if (std::holds_alternative<std::string>(resolution.data)) {
        fail_at(resolution.place, sources,
                "'resolution' = \"auto\" needs method = \"compressed\" or \"stack\"");
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

/// "auto", and what it may go by: magnification, when the file gives none.
void complete_resolution(SceneTable& settings, double magnification, const Sources& sources) {
    set_default(settings, "resolution", value_of("auto"));
    const bool automatic = std::holds_alternative<std::string>(settings.find("resolution")->value.data);
    if (automatic) {
        set_default(settings, "max_magnification", value_of(magnification));
    } else if (settings.has("max_magnification")) {
        fail_at(settings.find("max_magnification")->place, sources,
                "'max_magnification' needs resolution = \"auto\"");
    }
}

void complete_stack(SceneTable& settings, const SceneTable& light, const SceneEntry* cache,
                    const Sources& sources) {
    refuse_keys(settings, tree_keys, "method = \"compressed\"", sources);
    refuse_keys(settings, filter_keys, "method = \"map\" or \"compressed\"", sources);
    if (!is_sized(light)) {
        fail_at(settings.find("method")->value.place, sources,
                fmt::format("method = \"stack\" needs a light with a size, which light '{}' has not",
                            text(light, "id")));
    }
    if (text(light, "type") == "surface") {
        fail_at(settings.find("method")->value.place, sources,
                fmt::format("method = \"stack\" needs a light of one shape; light '{}' is of surfaces, which "
                            "method = \"exact\" takes point by point",
                            text(light, "id")));
    }
    set_default(settings, "samples", value_of(std::int64_t{stack_samples}));
    const SceneEntry& samples = *settings.find("samples");
    const auto* count = std::get_if<std::int64_t>(&samples.value.data);
    if (count == nullptr)
        fail_at(samples.value.place, sources, "'samples' = \"auto\" needs method = \"exact\"");
    if (*count < 4) {
        fail_at(samples.value.place, sources,
                fmt::format("'samples' must be at least 4 with method = \"stack\", not {}", *count));
    }
    complete_resolution(settings, ShadowSettings{}.max_magnification, sources);
    const SceneEntry& resolution = *settings.find("resolution");
    const auto* texels = std::get_if<std::int64_t>(&resolution.value.data);
    if (texels != nullptr && *texels > most_stack_resolution) {
        fail_at(
            resolution.value.place, sources,
            fmt::format("'resolution' must be at most {} with method = \"stack\"", most_stack_resolution));
    }
    if (cache != nullptr) set_default(settings, "cache", cache->value);
}

void complete_day(SceneTable& settings, const SceneTable& light, const Sources& sources) {
    const std::string& type = text(light, "type");
    if (type != "sun" && type != "directional") {
        fail_at(
            place_of(settings, settings.has("day_file") ? "day_file" : "method"), sources,
            "a day's shadows are a sun's: method = \"day\" needs a light of type \"sun\" or \"directional\"");
    }
    if (!settings.has("day_file"))
        fail_at(place_of(settings, "method"), sources, "method = \"day\" needs 'day_file'");
    set_default(settings, "max_sun_deg", value_of(ShadowSettings{}.max_sun_deg));
}

/// Samples of a picture; a pair is two.
std::int64_t sample_count(const SceneTable& root) {
    const SceneTable& render = subtable(root, "render");
    const Size2 size = size2(render, "size_px");
    return std::int64_t{size.width} * size.height * integer(render, "samples") * (root.has("stereo") ? 2 : 1);
}

void complete_compressed(SceneTable& settings, const SceneEntry* cache, std::int64_t samples,
                         const Sources& sources) {
    static const ShadowSettings d;
    const bool own_cache = settings.has("cache");
    if (!own_cache && cache != nullptr) settings.set("cache", cache->value);
    const bool frame = settings.has("scope") && text(settings, "scope") == "frame";
    if (own_cache && frame) {
        fail_at(settings.find("cache")->place, sources, "'cache' needs scope = \"full\"");
    }
    // What merged trees store depends on all that is in them: parts of one are no part of another.
    const bool whole =
        settings.has("code") && text(settings, "code") != "mh" && text(settings, "code") != "auto";
    if (whole && frame) {
        fail_at(settings.find("code")->place, sources,
                fmt::format("'code' = \"{}\" needs scope = \"full\"", text(settings, "code")));
    }
    // A cache for all lights is none for those that say scope = "frame".
    if (frame) settings.erase("cache");
    set_default(settings, "scope", value_of(settings.has("cache") || whole ? "full" : "frame"));
    set_default(settings, "filter", value_of("pcf"));
    const bool fine = text(settings, "scope") == "frame" && text(settings, "filter") == "pcf" &&
                      integer(settings, "filter_px") <= most_fine_filter_px && samples <= most_fine_samples;
    complete_resolution(settings, fine ? frame_magnification : d.max_magnification, sources);
    set_default(settings, "code", value_of("mh"));
    if (text(settings, "code") == "mh") {
        set_default(settings, "layout", value_of("words24"));
    } else if (settings.has("layout")) {
        fail_at(settings.find("layout")->place, sources, "'layout' needs code = \"mh\"");
    }
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
    const SceneTable& frames = subtable(root, "frames");
    const auto range = parse_frame_range(text(frames, "range"));
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
        // Dumped documents name it, so that their planner is not asked again.
        if (!settings.has("method")) {
            const ShadowMethod method = planned_method(settings, cache != nullptr, has_keyframes(root, light),
                                                       is_soft(light, settings), range ? range->count() : 1);
            settings.set("method", value_of(name_of(shadow_method_words, method)));
            // A tree for many frames serves all of them.
            if (method == ShadowMethod::compressed && !has_any(settings, compressed_keys) &&
                !has_any(settings, map_keys) && !has_keyframes(root, light) && range &&
                range->count() >= tree_break_even_frames) {
                settings.set("scope", value_of("full"));
            }
        }
        set_default(settings, "receivers", value_of(text(subtable(root, "render"), "receivers").c_str()));
        const ShadowMethod method = value_named(shadow_method_words, text(settings, "method"));
        if (method != ShadowMethod::day) refuse_keys(settings, day_keys, "method = \"day\"", sources);
        if (method == ShadowMethod::stack) {
            complete_stack(settings, light, cache, sources);
            order_keys(settings);
            continue;
        }
        if (method != ShadowMethod::compressed)
            refuse_keys(settings, compressed_keys, "method = \"compressed\"", sources);
        if (method == ShadowMethod::exact) {
            refuse_keys(settings, map_keys, "method = \"map\" or \"compressed\"", sources);
            if (is_sized(light)) set_default(settings, "samples", value_of("auto"));
        } else {
            refuse_keys(settings, exact_keys, "method = \"exact\"", sources);
        }
        if (method == ShadowMethod::map || method == ShadowMethod::compressed) complete_map(settings);
        if (method == ShadowMethod::day) {
            refuse_keys(settings, map_keys, "method = \"map\" or \"compressed\"", sources);
            complete_day(settings, light, sources);
        }
        if (method == ShadowMethod::map) complete_dense(settings, sources);
        if (method == ShadowMethod::compressed)
            complete_compressed(settings, cache, sample_count(root), sources);
        order_keys(settings);
    }
    root.erase("shadow");
}

std::string shadow_method_reason(const SceneTable& root, const SceneTable& light) {
    const SceneTable& settings = subtable(light, "shadow");
    const auto given = [&](const char* key) {
        return settings.has(key) && place_of(settings, key).source >= 0;
    };
    if (given("method")) return "as asked";
    if (given("day_file")) return "'day_file' has the suns of a day";
    const auto range = parse_frame_range(text(subtable(root, "frames"), "range"));
    const int frames = range ? range->count() : 1;
    if (text(settings, "method") == name_of(shadow_method_words, ShadowMethod::compressed)) {
        const auto first_given = [&](const auto& keys) {
            const auto* key = std::find_if(std::begin(keys), std::end(keys), given);
            return key == std::end(keys) ? nullptr : *key;
        };
        const char* key = first_given(map_keys);
        if (key == nullptr) key = first_given(compressed_keys);
        if (key == nullptr && given("receivers")) key = "receivers";
        if (key != nullptr) return fmt::format("'{}' is of maps", key);
        return fmt::format("a tree pays from {} frames on in which the light stands still, and there are {}",
                           tree_break_even_frames, frames);
    }
    if (frames == 1) return "one frame";
    if (given("samples")) return "'samples' is of exact shadows";
    if (is_soft(light, settings)) return "the light has a size, which maps of its middle do not show";
    if (has_keyframes(root, light)) return "the light has keyframes";
    return fmt::format("{} frames; a tree pays from {} on", frames, tree_break_even_frames);
}

}  // namespace obscura
