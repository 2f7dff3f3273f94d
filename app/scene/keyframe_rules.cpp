#include "app/scene/keyframe_rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/validate.h"

namespace obscura {

void check_keyframes(const std::vector<const SceneTable*>& keyframes, const SceneTable& target,
                     const std::string& what, const std::vector<KeySpec>& further,
                     const std::vector<std::string>& sources) {
    double last = -1;
    for (const SceneTable* keyframe : keyframes) {
        const double frame = number(*keyframe, "frame");
        if (frame <= last) {
            fail_at(place_of(*keyframe, "frame"), sources,
                    fmt::format("keyframes of {} must rise: {} follows {}", what, frame, last));
        }
        last = frame;
        for (const SceneEntry& entry : keyframe->entries) {
            const bool own = std::any_of(further.begin(), further.end(),
                                         [&](const KeySpec& k) { return k.name == entry.key && k.animated; });
            if (entry.key != "frame" && entry.key != "id" && !target.has(entry.key) && !own) {
                fail_at(entry.place, sources, fmt::format("{} has no '{}'", what, entry.key));
            }
        }
    }
}

}  // namespace obscura
