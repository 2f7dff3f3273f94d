#pragma once
// A strict JSON reader (RFC 8259) for checking reports: what it does not understand, it throws.

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::test {

struct Json {
    enum class Kind { null, truth, number, text, list, object } kind = Kind::null;
    bool truth = false;
    double number = 0;
    std::string text;
    std::vector<Json> list;
    std::map<std::string, Json> object;

    const Json& at(const std::string& key) const { return object.at(key); }
};

class JsonReader {
  public:
    explicit JsonReader(std::string_view text) : rest(text) {}

    Json document() {
        Json value = read_value();
        skip_space();
        if (!rest.empty()) fail("text behind the document");
        return value;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error("JSON: " + what + " before '" + std::string(rest.substr(0, 20)) + "'");
    }
    void skip_space() { rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size())); }
    bool take(std::string_view token) {
        if (!rest.starts_with(token)) return false;
        rest.remove_prefix(token.size());
        return true;
    }
    void need(std::string_view token) {
        skip_space();
        if (!take(token)) fail("'" + std::string(token) + "' is missing");
    }

    std::string read_text() {
        std::string text;
        while (!take("\"")) {
            if (rest.empty() || static_cast<unsigned char>(rest[0]) < 0x20) fail("bad character in text");
            if (take("\\u")) {
                int code = 0;
                const auto [end, error] = std::from_chars(rest.data(), rest.data() + 4, code, 16);
                if (rest.size() < 4 || error != std::errc{} || end != rest.data() + 4 || code > 0x7f)
                    fail("bad \\u");
                text += static_cast<char>(code);
                rest.remove_prefix(4);
            } else if (take("\\")) {
                if (rest.empty() || std::string_view("\"\\/").find(rest[0]) == std::string_view::npos)
                    fail("bad \\");
                text += rest[0];
                rest.remove_prefix(1);
            } else {
                text += rest[0];
                rest.remove_prefix(1);
            }
        }
        return text;
    }

    Json read_number() {
        Json value;
        value.kind = Json::Kind::number;
        const std::string_view digits = rest.substr(rest.starts_with("-") ? 1 : 0);
        const bool starts_well = !digits.empty() && digits[0] >= '0' && digits[0] <= '9';
        const bool octal = digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value.number);
        if (!starts_well || octal || error != std::errc{}) fail("bad number");
        rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        return value;
    }

    Json read_list() {
        Json value;
        value.kind = Json::Kind::list;
        skip_space();
        if (take("]")) return value;
        while (true) {
            value.list.push_back(read_value());
            skip_space();
            if (take("]")) return value;
            need(",");
        }
    }

    Json read_object() {
        Json value;
        value.kind = Json::Kind::object;
        skip_space();
        if (take("}")) return value;
        while (true) {
            need("\"");
            const std::string key = read_text();
            need(":");
            if (!value.object.emplace(key, read_value()).second) fail("key '" + key + "' twice");
            skip_space();
            if (take("}")) return value;
            need(",");
        }
    }

    Json read_value() {
        skip_space();
        Json value;
        if (take("{")) return read_object();
        if (take("[")) return read_list();
        if (take("\"")) {
            value.kind = Json::Kind::text;
            value.text = read_text();
            return value;
        }
        if (take("null")) return value;
        value.kind = Json::Kind::truth;
        value.truth = rest.starts_with("true");
        if (take("true") || take("false")) return value;
        return read_number();
    }

    std::string_view rest;
};

inline Json parse_json(std::string_view text) {
    return JsonReader(text).document();
}

}  // namespace obscura::test
