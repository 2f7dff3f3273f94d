#pragma once
// Line-oriented text files (OBJ, MTL): logical lines with their numbers, words, strict numbers.

#include <cstdint>
#include <string>
#include <string_view>

namespace obscura {

/// Walks over the lines of a text: LF or CRLF, a byte order mark at the start, backslash at the end of a line
/// joins it with the next, the last line may lack its end. A line's number is that of its first piece.
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

/// Takes the next word off `rest`; empty when there is none or a comment (#) begins.
std::string_view take_word(std::string_view& rest);

/// What is left of a line as a name: without blanks around it, blanks and # inside it kept.
std::string_view trimmed(std::string_view rest);

/// Where a number stands, for the message.
struct TextPlace {
    const std::string& file;
    int line = 0;
};

/// A finite decimal number that fits a float, in the C locale, nothing behind it. Throws InputError naming
/// the word, with a hint for decimal commas.
float parse_float(std::string_view word, const TextPlace& place);

/// A word of a text as it may be shown: cut to a readable length, unprintable bytes as '?'.
std::string shown(std::string_view word);

}  // namespace obscura
