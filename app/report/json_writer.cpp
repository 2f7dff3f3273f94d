#include "app/report/json_writer.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace obscura {

void JsonWriter::separate() {
    if (after_key) {
        after_key = false;
        return;
    }
    if (empty.empty()) return;
    if (!empty.back()) out += ',';
    empty.back() = false;
    out += '\n';
    out.append(empty.size() * 2, ' ');
}

JsonWriter& JsonWriter::literal(std::string_view text) {
    separate();
    out += text;
    return *this;
}

JsonWriter& JsonWriter::open(char bracket) {
    separate();
    out += bracket;
    empty.push_back(true);
    return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
    CHECK(!empty.empty() && !after_key);
    const bool nothing = empty.back();
    empty.pop_back();
    if (!nothing) {
        out += '\n';
        out.append(empty.size() * 2, ' ');
    }
    out += bracket;
    return *this;
}

JsonWriter& JsonWriter::begin_object() {
    return open('{');
}
JsonWriter& JsonWriter::end_object() {
    return close('}');
}
JsonWriter& JsonWriter::begin_list() {
    return open('[');
}
JsonWriter& JsonWriter::end_list() {
    return close(']');
}

JsonWriter& JsonWriter::key(std::string_view name) {
    value(name);
    out += ": ";
    after_key = true;
    return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
    separate();
    out += '"';
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            out += fmt::format("\\u{:04x}", static_cast<int>(c));
        } else {
            out += c;
        }
    }
    out += '"';
    return *this;
}

JsonWriter& JsonWriter::value(double number) {
    return literal(std::isfinite(number) ? fmt::format("{}", number) : "null");
}

JsonWriter& JsonWriter::value(bool truth) {
    return literal(truth ? "true" : "false");
}

std::string JsonWriter::finish() const {
    CHECK(empty.empty() && !after_key);
    return out + "\n";
}

}  // namespace obscura
