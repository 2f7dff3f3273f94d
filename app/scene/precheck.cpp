#include "app/scene/precheck.h"

#include <fmt/format.h>

#include <cstdint>

#include "core/error.h"

namespace obscura {
namespace {

/// Length of the well-formed UTF-8 sequence at the front of `s` (Unicode 15, table 3-7); 0 when there is
/// none.
std::size_t utf8_length(std::string_view s) {
    const auto byte = [&](std::size_t i) {
        return i < s.size() ? static_cast<std::uint8_t>(s[i]) : std::uint8_t{0};
    };
    const auto tail = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
    const std::uint8_t a = byte(0), b = byte(1);
    if (a < 0x80) return 1;
    if (a < 0xC2) return 0;  // a continuation byte, or an overlong form
    if (a < 0xE0) return tail(1) ? 2 : 0;
    if (a < 0xF0) {
        const bool overlong = a == 0xE0 && b < 0xA0, surrogate = a == 0xED && b > 0x9F;
        return tail(1) && tail(2) && !overlong && !surrogate ? 3 : 0;
    }
    const bool overlong = a == 0xF0 && b < 0x90, too_large = a == 0xF4 ? b > 0x8F : a > 0xF4;
    return tail(1) && tail(2) && tail(3) && !overlong && !too_large ? 4 : 0;
}

struct Cursor {
    std::string_view text;
    const std::string& filename;
    std::size_t at = 0;
    int line = 1, column = 1;

    bool done() const { return at >= text.size(); }
    bool sees(std::string_view s) const { return text.substr(at, s.size()) == s; }
    /// One code point on.
    void step() {
        const bool newline = text[at] == '\n';
        at += utf8_length(text.substr(at));
        line += newline ? 1 : 0;
        column = newline ? 1 : column + 1;
    }
    void steps(std::size_t count) {
        for (std::size_t i = 0; i < count && !done(); ++i)
            step();
    }
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(filename, line, column, message);
    }
};

void check_characters(Cursor cursor, const TextBounds& bounds) {
    std::size_t line_start = 0;
    while (!cursor.done()) {
        const char c = cursor.text[cursor.at];
        if (c == '\0') cursor.fail("NUL byte: this is not a text file");
        if (utf8_length(cursor.text.substr(cursor.at)) == 0) {
            cursor.fail(fmt::format("byte 0x{:02X} is not valid UTF-8",
                                    static_cast<unsigned>(static_cast<std::uint8_t>(c))));
        }
        if (cursor.at - line_start >= bounds.line_bytes) {
            cursor.fail(fmt::format("line is longer than {} bytes", bounds.line_bytes));
        }
        cursor.step();
        if (c == '\n') line_start = cursor.at;
    }
}

/// Steps over a string, whatever its quotes; an unterminated one ends with its line (or the text) and is
/// left for the parser to report.
void skip_string(Cursor& cursor) {
    const char quote = cursor.text[cursor.at];
    const std::string triple(3, quote);
    const bool multi_line = cursor.sees(triple);
    cursor.steps(multi_line ? 3 : 1);
    while (!cursor.done()) {
        const char c = cursor.text[cursor.at];
        if (quote == '"' && c == '\\') {
            cursor.steps(2);
        } else if (multi_line && cursor.sees(triple)) {
            cursor.steps(3);
            return;
        } else if (!multi_line && (c == quote || c == '\n')) {
            cursor.step();
            return;
        } else {
            cursor.step();
        }
    }
}

/// Counts open brackets, and dots between two separators: only a key can hold more than two.
void check_depths(Cursor cursor, const TextBounds& bounds) {
    int nesting = 0, dots = 0;
    while (!cursor.done()) {
        const char c = cursor.text[cursor.at];
        if (c == '"' || c == '\'') {
            skip_string(cursor);
            continue;
        }
        if (c == '#') {
            while (!cursor.done() && cursor.text[cursor.at] != '\n')
                cursor.step();
            continue;
        }
        if (c == '[' || c == '{') ++nesting;
        if (c == ']' || c == '}') --nesting;
        if (nesting > bounds.nesting)
            cursor.fail(fmt::format("nested deeper than {} levels", bounds.nesting));
        if (c == '.') {
            ++dots;
        } else if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n') {
            dots = 0;
        }
        if (dots >= bounds.key_depth)
            cursor.fail(fmt::format("key has more than {} parts", bounds.key_depth));
        cursor.step();
    }
}

}  // namespace

void precheck_scene_text(std::string_view text, const std::string& filename, const TextBounds& bounds) {
    if (text.size() > bounds.bytes) {
        throw InputError(filename,
                         fmt::format("scene file has {} bytes, more than {}", text.size(), bounds.bytes));
    }
    const Cursor start{text, filename};
    check_characters(start, bounds);
    check_depths(start, bounds);
}

}  // namespace obscura
