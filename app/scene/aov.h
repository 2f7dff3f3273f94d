#pragma once
// The pictures that a frame can give, by name.

#include <array>
#include <string_view>

#include "app/scene/scene.h"

namespace obscura {

/// In the order of Aov.
inline constexpr std::array<std::string_view, 6> aov_names = {"beauty", "depth",  "normal",
                                                              "albedo", "object", "shadow"};

constexpr std::string_view aov_name(Aov aov) {
    return aov_names[static_cast<std::size_t>(aov)];
}

}  // namespace obscura
