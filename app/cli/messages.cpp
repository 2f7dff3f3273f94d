#include "app/cli/messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace obscura {

bool is_terminal(std::FILE* stream) {
    return ::isatty(::fileno(stream)) == 1;
}

bool has_escapes(std::FILE* stream) {
    const char* term = std::getenv("TERM");
    const std::string_view name = term != nullptr ? term : "";
    return is_terminal(stream) && !name.empty() && name != "dumb" && name != "unknown";
}

bool wants_colour(std::FILE* stream) {
    const char* no_colour = std::getenv("NO_COLOR");
    return has_escapes(stream) && (no_colour == nullptr || *no_colour == '\0');
}

// fmt::print() throws where fwrite() only says so.
void say(std::string_view text) noexcept {
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

void say_note(const std::string& text) {
    say(fmt::format("obscura: note: {}\n", text));
}

void print(std::string_view text) noexcept {
    (void)std::fwrite(text.data(), 1, text.size(), stdout);
    (void)std::fflush(stdout);
}

}  // namespace obscura
