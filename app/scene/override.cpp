#include "app/scene/override.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "app/scene/precheck.h"
#include "app/scene/schema.h"
#include "app/scene/toml_parse.h"
#include "core/error.h"

namespace obscura {
namespace {

constexpr std::size_t longest_path = 16;

std::string_view trimmed(std::string_view s) {
    const std::size_t first = std::min(s.find_first_not_of(" \t"), s.size());
    return s.substr(first, s.find_last_not_of(" \t") + 1 - first);
}

std::vector<std::string> split(std::string_view path) {
    std::vector<std::string> parts;
    while (true) {
        const std::size_t dot = path.find('.');
        parts.emplace_back(path.substr(0, dot));
        if (dot == std::string_view::npos) return parts;
        path.remove_prefix(dot + 1);
    }
}

/// A word that a shell leaves when its user forgot that TOML strings have quotes.
bool is_bare_word(std::string_view value) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_-./#").find(static_cast<char>(c)) != std::string_view::npos;
    };
    return !value.empty() && std::isalpha(static_cast<unsigned char>(value[0])) != 0 && value != "true" &&
           value != "false" && value != "inf" && value != "nan" &&
           std::all_of(value.begin(), value.end(), plain);
}

void set_place(SceneValue& value, const Place& place) {
    value.place = place;
    if (auto* list = std::get_if<SceneList>(&value.data)) {
        for (SceneValue& item : *list)
            set_place(item, place);
    } else if (auto* table = std::get_if<SceneTable>(&value.data)) {
        for (SceneEntry& entry : table->entries) {
            entry.place = place;
            set_place(entry.value, place);
        }
    }
}

SceneValue parse_value(std::string_view value, const std::string& source_name, const Place& place) {
    SceneValue result;
    if (is_bare_word(value) || parse_time_of_day(value)) {
        result.data = std::string(value);
    } else {
        if (value.find('\n') != std::string_view::npos) throw InputError(source_name, "a value is one line");
        const std::string line = fmt::format("value = {}", value);
        try {
            precheck_scene_text(line, source_name);
            result = std::move(parse_toml(line, source_name, place.source).entries.at(0).value);
        } catch (const InputError& error) {
            throw InputError(source_name, error.message);
        }
    }
    set_place(result, place);
    return result;
}

/// The element of `list` with that id, or with that number when all its characters are digits.
SceneValue& element(SceneList& list, const std::string& key, const std::string& part,
                    const std::string& source_name) {
    std::vector<std::string> ids;
    for (SceneValue& item : list) {
        const auto* table = std::get_if<SceneTable>(&item.data);
        const SceneEntry* id = table != nullptr ? table->find("id") : nullptr;
        const auto* name = id != nullptr ? std::get_if<std::string>(&id->value.data) : nullptr;
        if (name == nullptr) continue;
        if (*name == part) return item;
        ids.push_back(*name);
    }
    std::size_t index = 0;
    const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (status == std::errc{} && end == part.data() + part.size() && index < list.size()) return list[index];
    throw InputError(source_name, fmt::format("'{}' has no element '{}'{}", key, part, hint(part, ids)));
}

}  // namespace

void apply_override(SceneTable& root, const std::string& text, int source) {
    const std::string source_name = "-D " + text;
    const Place place{source, 0, 0};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw InputError(source_name, "must be key=value");
    const std::vector<std::string> path = split(trimmed(std::string_view(text).substr(0, equals)));
    if (path.size() > longest_path)
        throw InputError(source_name, fmt::format("key has more than {} parts", longest_path));
    if (std::any_of(path.begin(), path.end(), [](const std::string& p) { return p.empty(); })) {
        throw InputError(source_name, "key has an empty part");
    }
    SceneValue value = parse_value(trimmed(std::string_view(text).substr(equals + 1)), source_name, place);

    SceneTable* table = &root;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        if (!table->has(path[i])) table->set(path[i], {SceneTable{}, place});
        SceneValue* next = &table->find(path[i])->value;
        if (auto* list = std::get_if<SceneList>(&next->data)) {
            if (++i + 1 == path.size())
                throw InputError(source_name, fmt::format("say which key of '{}' to set", path[i]));
            next = &element(*list, path[i - 1], path[i], source_name);
        }
        table = std::get_if<SceneTable>(&next->data);
        if (table == nullptr) throw InputError(source_name, fmt::format("'{}' is not a table", path[i]));
    }
    table->set(path.back(), std::move(value));
}

}  // namespace obscura
