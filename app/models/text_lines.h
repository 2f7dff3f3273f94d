#pragma once
// Line-oriented text files (OBJ, MTL): logical lines with their numbers, words, strict numbers.

#include <cstdint>
#include <string>
#include <string_view>

namespace obscura {

/// Walks over the lines of a text: ended by LF, CRLF or CR, a byte order mark at the start, the last line may
/// lack its end. A backslash at the end of a line, blanks behind it or not, joins it with the next, but not
/// where a # stands before it. A line's number is that of its first piece.
class LineReader {
  public:
    explicit LineReader(std::string_view text);
    /// False at the end. `line()` stays valid until the next call.
    bool next();
    std::string_view line() const { return line_; }
    int number() const { return number_; }

  private:
    std::string_view take_piece();

    std::string_view rest_, line_;
    std::string joined_;
    int number_ = 0, next_number_ = 1;
};

/// Takes the next word off `rest`; empty when there is none or a comment (#) begins, which ends a word, too.
std::string_view take_word(std::string_view& rest);

/// The same for names, which may have a # behind their first character.
std::string_view take_name_word(std::string_view& rest);

/// A trimmed name up to a # that stands behind a blank: what it is if that is not a part of it.
std::string_view without_comment(std::string_view name);

/// What is left of a line as a name: without blanks around it, blanks and # inside it kept.
std::string_view trimmed(std::string_view rest);

/// Where a number stands, for the message.
struct TextPlace {
    const std::string& file;
    int line = 0;
};

/// A finite decimal number in a float's range, in the C locale, nothing behind it. Throws InputError naming
/// the word, with a hint for decimal commas.
double parse_number(std::string_view word, const TextPlace& place);

/// The same, rounded.
float parse_float(std::string_view word, const TextPlace& place);

/// A word of a text as it may be shown: cut to a readable length, unprintable bytes as '?'.
std::string shown(std::string_view word);

}  // namespace obscura
