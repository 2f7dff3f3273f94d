#include "app/elevation/flat_json.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"

namespace obscura {
namespace {

class JsonReader {
  public:
    JsonReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    std::map<std::string, double> object() {
        std::map<std::string, double> numbers;
        expect('{');
        if (peek() == '}') {
            ++at_;
        } else {
            do
                member(numbers);
            while (comma());
        }
        skip_space();
        if (at_ != text_.size()) fail("more follows the object");
        return numbers;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        int line = 1, column = 1;
        for (std::size_t i = 0; i < at_ && i < text_.size(); ++i) {
            column = text_[i] == '\n' ? 1 : column + 1;
            line += text_[i] == '\n' ? 1 : 0;
        }
        throw InputError(name_, line, column, message);
    }

    void skip_space() {
        while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
            ++at_;
    }

    char peek() {
        skip_space();
        if (at_ >= text_.size()) fail("the file ends within the object");
        return text_[at_];
    }

    void expect(char c) {
        if (peek() != c) fail(fmt::format("'{}' is missing", c));
        ++at_;
    }

    bool comma() {
        if (peek() == ',') {
            ++at_;
            return true;
        }
        expect('}');
        return false;
    }

    std::string string() {
        expect('"');
        std::string out;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (static_cast<unsigned char>(text_[at_]) < 0x20) fail("a control character within a text");
            // What an escape stands for matters to nobody here.
            if (text_[at_] == '\\') ++at_;
            if (at_ < text_.size()) out += text_[at_];
        }
        if (at_ >= text_.size()) fail("a text without an end");
        ++at_;
        return out;
    }

    void member(std::map<std::string, double>& numbers) {
        if (peek() != '"') fail("a name in quotes is missing");
        const std::string key = string();
        expect(':');
        const char first = peek();
        if (first == '"') {
            string();
            return;
        }
        if (first == '{' || first == '[') fail("objects and lists are not read here");
        for (const std::string_view word : {"true", "false", "null"}) {
            if (text_.substr(at_, word.size()) != word) continue;
            at_ += word.size();
            return;
        }
        double value = 0;
        const char* begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        // from_chars takes infinities and NaNs as well, which JSON does not have.
        const char leading = first == '-' && at_ + 1 < text_.size() ? text_[at_ + 1] : first;
        const bool digit = leading >= '0' && leading <= '9';
        if (error != std::errc{} || !digit) fail("not a number");
        if (!numbers.emplace(key, value).second) fail(fmt::format("'{}' is said twice", key));
        at_ += static_cast<std::size_t>(end - begin);
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
};

}  // namespace

std::map<std::string, double> json_numbers(std::string_view text, const std::string& name) {
    return JsonReader(text, name).object();
}

}  // namespace obscura
