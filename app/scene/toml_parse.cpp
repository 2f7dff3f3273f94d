// The only file that includes toml++.
#include "app/scene/toml_parse.h"

#include <fmt/format.h>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>

#include "core/error.h"

namespace obscura {
namespace {

Place place_in(const toml::source_region& region, int source) {
    return {source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

DateTime convert(const toml::date_time& t) {
    DateTime r;
    r.year = static_cast<int>(t.date.year);
    r.month = static_cast<int>(t.date.month);
    r.day = static_cast<int>(t.date.day);
    r.hour = static_cast<int>(t.time.hour);
    r.minute = static_cast<int>(t.time.minute);
    r.second = static_cast<int>(t.time.second);
    r.nanosecond = t.time.nanosecond;
    r.has_offset = t.offset.has_value();
    r.offset_minutes = t.offset ? static_cast<int>(t.offset->minutes) : 0;
    return r;
}

SceneValue convert_node(const toml::node& node, int source, const std::string& filename);

SceneTable convert_table(const toml::table& table, int source, const std::string& filename) {
    SceneTable result;
    for (const auto& [key, node] : table) {
        result.entries.push_back(
            {std::string(key.str()), place_in(key.source(), source), convert_node(node, source, filename)});
    }
    // toml++ sorts by name; people read errors from top to bottom.
    std::stable_sort(result.entries.begin(), result.entries.end(),
                     [](const SceneEntry& a, const SceneEntry& b) {
                         return a.place.line != b.place.line ? a.place.line < b.place.line
                                                             : a.place.column < b.place.column;
                     });
    return result;
}

SceneValue convert_node(const toml::node& node, int source, const std::string& filename) {
    const Place place = place_in(node.source(), source);
    if (const auto* table = node.as_table()) return {convert_table(*table, source, filename), place};
    if (const auto* array = node.as_array()) {
        SceneList list;
        for (const toml::node& item : *array)
            list.push_back(convert_node(item, source, filename));
        return {std::move(list), place};
    }
    if (const auto* v = node.as_boolean()) return {v->get(), place};
    if (const auto* v = node.as_integer()) return {v->get(), place};
    if (const auto* v = node.as_floating_point()) return {v->get(), place};
    if (const auto* v = node.as_string()) return {v->get(), place};
    if (const auto* v = node.as_date_time()) return {convert(v->get()), place};
    throw InputError(filename, place.line, place.column, "a date or time alone means nothing here");
}

/// A number followed by a word on the line at fault is most likely a unit.
std::string unit_hint(std::string_view text, int line) {
    for (int l = 1; l < line; ++l)
        text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
    text = text.substr(0, text.find('\n'));
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return "";
    std::size_t i = text.find_first_not_of(' ', equals + 1);
    const std::size_t number = i;
    i = text.find_first_not_of("+-.0123456789", std::min(i, text.size()));
    if (i == std::string_view::npos || i == number) return "";
    i = text.find_first_not_of(' ', i);
    if (i == std::string_view::npos || std::isalpha(static_cast<unsigned char>(text[i])) == 0) return "";
    const bool exponent = (text[i] == 'e' || text[i] == 'E') && i + 1 < text.size() &&
                          std::isalpha(static_cast<unsigned char>(text[i + 1])) == 0;
    return !exponent ? " (a value is a plain number: its unit stands in the key's name)" : "";
}

}  // namespace

SceneTable parse_toml(std::string_view text, const std::string& filename, int source) {
    try {
        return convert_table(toml::parse(text), source, filename);
    } catch (const toml::parse_error& error) {
        const Place place = place_in(error.source(), source);
        std::string message{error.description()};
        constexpr std::string_view prefix = "Error while parsing ";
        if (message.starts_with(prefix)) message = "in " + message.substr(prefix.size());
        throw InputError(filename, place.line, place.column, message + unit_hint(text, place.line));
    }
}

}  // namespace obscura
