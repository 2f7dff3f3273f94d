#pragma once
// What is refused before the TOML parser sees a text: toml++ 3.3 recurses once per level of a dotted key and
// overflows its stack at 200,000 of them, and it reports broken UTF-8 without a column.

#include <string>
#include <string_view>

namespace obscura {

/// Bounds of a scene file's text.
struct TextBounds {
    std::size_t bytes = std::size_t{16} << 20;
    std::size_t line_bytes = std::size_t{1} << 20;
    int nesting = 64;    ///< brackets and braces
    int key_depth = 16;  ///< parts of a dotted key
};

/// Throws InputError with line and column at the first violation of `bounds`, NUL or byte that is not UTF-8.
void precheck_scene_text(std::string_view text, const std::string& filename, const TextBounds& bounds = {});

}  // namespace obscura
