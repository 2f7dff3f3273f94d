#include "app/scene/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace obscura {
namespace {

std::string quoted(const std::string& s) {
    std::string out = "\"";
    for (const char c : s) {
        const auto u = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (u < 0x20 || u == 0x7F) {
            out += fmt::format("\\u{:04X}", static_cast<unsigned>(u));
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string date_time_text(const DateTime& t) {
    std::string out = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", t.year, t.month, t.day, t.hour,
                                  t.minute, t.second);
    if (t.nanosecond != 0) {
        out += fmt::format(".{:09}", t.nanosecond);
        out.erase(out.find_last_not_of('0') + 1);
    }
    if (t.has_offset) {
        const int minutes = std::abs(t.offset_minutes);
        out += fmt::format("{}{:02}:{:02}", t.offset_minutes < 0 ? '-' : '+', minutes / 60, minutes % 60);
    }
    return out;
}

bool is_table(const SceneValue& value) {
    return std::holds_alternative<SceneTable>(value.data);
}

bool is_table_list(const SceneValue& value) {
    const auto* list = std::get_if<SceneList>(&value.data);
    return list != nullptr && !list->empty() && std::all_of(list->begin(), list->end(), is_table);
}

/// A [material] that holds nothing but [material.NAME]s needs no header of its own.
bool only_tables(const SceneTable& table) {
    return !table.entries.empty() && std::all_of(table.entries.begin(), table.entries.end(),
                                                 [](const SceneEntry& e) { return is_table(e.value); });
}

/// Plain values first: after a [header], TOML gives every key to that header.
void write_table(std::string& out, const SceneTable& table, const std::string& path) {
    for (const SceneEntry& entry : table.entries) {
        if (is_table(entry.value) || is_table_list(entry.value)) continue;
        out += fmt::format("{} = {}\n", toml_key(entry.key), toml_text(entry.value));
    }
    const auto section = [&](const SceneTable& inner, const std::string& name, const char* open,
                             const char* close) {
        if (!only_tables(inner)) out += fmt::format("\n{}{}{}\n", open, name, close);
        write_table(out, inner, name + ".");
    };
    for (const SceneEntry& entry : table.entries) {
        const std::string name = path + toml_key(entry.key);
        if (is_table(entry.value)) section(std::get<SceneTable>(entry.value.data), name, "[", "]");
        if (!is_table_list(entry.value)) continue;
        for (const SceneValue& item : std::get<SceneList>(entry.value.data)) {
            section(std::get<SceneTable>(item.data), name, "[[", "]]");
        }
    }
}

}  // namespace

std::string toml_text(const SceneValue& value) {
    struct Visitor {
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
        std::string operator()(double d) const {
            const std::string digits = fmt::format("{}", d);
            return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;
        }
        std::string operator()(const std::string& s) const { return quoted(s); }
        std::string operator()(const DateTime& t) const { return date_time_text(t); }
        std::string operator()(const TimeOfDay& t) const { return time_text(t); }
        std::string operator()(const SceneList& list) const {
            std::string out = "[";
            for (std::size_t i = 0; i < list.size(); ++i)
                out += (i == 0 ? "" : ", ") + toml_text(list[i]);
            return out + "]";
        }
        std::string operator()(const SceneTable& table) const {
            std::string out = "{";
            for (const SceneEntry& e : table.entries) {
                out += fmt::format("{}{} = {}", out.size() == 1 ? "" : ", ", toml_key(e.key),
                                   toml_text(e.value));
            }
            return out + "}";
        }
    };
    return std::visit(Visitor{}, value.data);
}

std::string toml_key(const std::string& key) {
    const auto bare = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
    return !key.empty() && std::all_of(key.begin(), key.end(), bare) ? key : quoted(key);
}

std::string toml_document(const SceneTable& root) {
    std::string out;
    write_table(out, root, "");
    return out;
}

}  // namespace obscura
