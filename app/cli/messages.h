#pragma once
// Words for people on the standard streams. None of them ends a run: the exit code is that of the work.

#include <cstdio>
#include <string>
#include <string_view>

namespace obscura {

/// Whether `stream` is a terminal; one that understands escape sequences (TERM names it, and not as "dumb" or
/// "unknown"); and one that may be coloured besides (NO_COLOR unset or empty).
bool is_terminal(std::FILE* stream);
bool has_escapes(std::FILE* stream);
bool wants_colour(std::FILE* stream);

/// `text` as it is on standard error. What cannot be written there (closed, full, its reader gone) is
/// dropped: a message that nobody can read costs no picture.
void say(std::string_view text) noexcept;
/// "obscura: note: TEXT", a line.
void say_note(const std::string& text);

/// `text` as it is on standard output, at once. That it could not be written is told by the exit code when
/// all files are there (run_program.h).
void print(std::string_view text) noexcept;

}  // namespace obscura
