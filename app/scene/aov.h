#pragma once
// The pictures that a frame can give, by name.

#include <string_view>

#include "app/scene/scene.h"
#include "app/scene/words.h"

namespace obscura {

inline constexpr Word<Aov> aov_words[] = {
    {"beauty", Aov::beauty}, {"depth", Aov::depth},   {"normal", Aov::normal},      {"albedo", Aov::albedo},
    {"object", Aov::object}, {"shadow", Aov::shadow}, {"sun_hours", Aov::sun_hours}};

inline std::string_view aov_name(Aov aov) {
    return name_of(aov_words, aov);
}

}  // namespace obscura
