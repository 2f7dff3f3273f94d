#include "app/models/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/// Whether a backslash joins the line with the next one. Blanks behind it are not seen by people. In a
/// comment it is a part of the comment: the folder of a path, as a rule, and what follows is a statement.
bool joins_next(std::string_view line) {
    const std::string_view seen = trimmed(line);
    return !seen.empty() && seen.back() == '\\' && seen.find('#') == std::string_view::npos;
}

/// Takes the next word off `rest`, up to a character that `ends` it; empty at a comment.
template <class Ends>
std::string_view take_until(std::string_view& rest, Ends ends) {
    std::size_t begin = 0;
    while (begin < rest.size() && is_blank(rest[begin]))
        ++begin;
    std::size_t end = begin;
    if (begin < rest.size() && rest[begin] != '#') {
        while (end < rest.size() && !ends(rest[end]))
            ++end;
    }
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(word.empty() ? rest.size() : end);
    return word;
}

}  // namespace

LineReader::LineReader(std::string_view text) : rest_(text) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
}

std::string_view LineReader::take_piece() {
    const std::size_t end = rest_.find_first_of("\r\n");
    const std::string_view piece = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end, rest_.size()));
    // CRLF is one end.
    rest_.remove_prefix(rest_.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, rest_.size()));
    ++next_number_;
    return piece;
}

bool LineReader::next() {
    if (rest_.empty()) return false;
    number_ = next_number_;
    line_ = take_piece();
    if (!joins_next(line_)) return true;

    joined_.assign(line_);
    while (joins_next(joined_)) {
        joined_[joined_.rfind('\\')] = ' ';
        if (rest_.empty()) break;
        joined_.append(take_piece());
    }
    line_ = joined_;
    return true;
}

std::string_view take_word(std::string_view& rest) {
    return take_until(rest, [](char c) { return is_blank(c) || c == '#'; });
}

std::string_view take_name_word(std::string_view& rest) {
    return take_until(rest, is_blank);
}

std::string_view without_comment(std::string_view name) {
    for (std::size_t i = 1; i < name.size(); ++i) {
        if (name[i] == '#' && is_blank(name[i - 1])) return trimmed(name.substr(0, i));
    }
    return name;
}

std::string_view trimmed(std::string_view rest) {
    while (!rest.empty() && is_blank(rest.front()))
        rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back()))
        rest.remove_suffix(1);
    return rest;
}

double parse_number(std::string_view word, const TextPlace& place) {
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = end == digits.data() + digits.size();
    if (error == std::errc::invalid_argument || !whole) {
        const bool comma = word.find(',') != std::string_view::npos;
        throw InputError(place.file, place.line, 0,
                         fmt::format("'{}' is not a number{}", shown(word),
                                     comma ? " (decimals are written with a point)" : ""));
    }
    if (error == std::errc::result_out_of_range) {
        // from_chars does not say which way. A short number with a negative exponent is too small, so zero.
        const bool tiny = word.size() < 40 && word.find_first_of("eE") != std::string_view::npos &&
                          word[word.find_first_of("eE") + 1] == '-';
        value = tiny ? 0.0 : HUGE_VAL;
    }
    if (!(std::fabs(value) <= static_cast<double>(FLT_MAX))) {
        throw InputError(place.file, place.line, 0,
                         fmt::format("'{}' is not a finite number in single precision", shown(word)));
    }
    return value;
}

float parse_float(std::string_view word, const TextPlace& place) {
    return static_cast<float>(parse_number(word, place));
}

std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return word.size() > 40 ? text + "..." : text;
}

}  // namespace obscura
