#pragma once
// What must hold for any text given to the scene reader. Shared by the fuzzer and the replay of its corpus.

#include <string>
#include <string_view>

namespace obscura {

/// Reads `text`. A scene that is accepted must dump to a text that reads back to the same dump (CHECK), a
/// refused one throws InputError or LimitError and nothing else. Returns what was wrong with it: "" when it
/// was accepted.
std::string try_scene(std::string_view text);

}  // namespace obscura
