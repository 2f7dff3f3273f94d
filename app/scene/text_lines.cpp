#include "app/scene/text_lines.h"

#include <fmt/format.h>

#include <cfloat>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

LineReader::LineReader(std::string_view text) : rest_(text) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
}

std::string_view LineReader::take_piece() {
    const std::size_t end = rest_.find('\n');
    std::string_view piece = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!piece.empty() && piece.back() == '\r') piece.remove_suffix(1);
    ++next_number_;
    return piece;
}

bool LineReader::next() {
    if (rest_.empty()) return false;
    number_ = next_number_;
    line_ = take_piece();
    if (line_.empty() || line_.back() != '\\') return true;

    joined_.assign(line_);
    while (!joined_.empty() && joined_.back() == '\\') {
        joined_.back() = ' ';
        if (rest_.empty()) break;
        joined_.append(take_piece());
    }
    line_ = joined_;
    return true;
}

std::string_view take_word(std::string_view& rest) {
    std::size_t begin = 0;
    while (begin < rest.size() && is_blank(rest[begin]))
        ++begin;
    std::size_t end = begin;
    if (begin < rest.size() && rest[begin] != '#') {
        while (end < rest.size() && !is_blank(rest[end]))
            ++end;
    }
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(word.empty() ? rest.size() : end);
    return word;
}

std::string_view trimmed(std::string_view rest) {
    while (!rest.empty() && is_blank(rest.front()))
        rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back()))
        rest.remove_suffix(1);
    return rest;
}

float parse_float(std::string_view word, const TextPlace& place) {
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
    return static_cast<float>(value);
}

std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return word.size() > 40 ? text + "..." : text;
}

}  // namespace obscura
