// The only file that includes toml++.
#include "app/scene/toml_parse.h"

#include <fmt/format.h>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "app/scene/keyframes.h"
#include "core/error.h"

namespace obscura {
namespace {

Place place_in(const toml::source_region& region, int source) {
    return {source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// Where date-times of a text begin whose second is 60, which RFC 3339 and so TOML allow. toml++ does not.
using LeapSeconds = std::set<std::pair<int, int>>;

DateTime second_later(DateTime t) {
    const std::int64_t nanosecond = std::exchange(t.nanosecond, 0);
    DateTime later = from_epoch_seconds(epoch_seconds(t) + 1, t.offset_minutes);
    later.nanosecond = nanosecond;
    later.has_offset = t.has_offset;
    return later;
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

SceneValue convert_node(const toml::node& node, int source, const std::string& filename,
                        const LeapSeconds& leaps);

SceneTable convert_table(const toml::table& table, int source, const std::string& filename,
                         const LeapSeconds& leaps) {
    SceneTable result;
    for (const auto& [key, node] : table) {
        result.entries.push_back({std::string(key.str()), place_in(key.source(), source),
                                  convert_node(node, source, filename, leaps)});
    }
    // toml++ sorts by name; people read errors from top to bottom.
    std::stable_sort(result.entries.begin(), result.entries.end(),
                     [](const SceneEntry& a, const SceneEntry& b) {
                         return a.place.line != b.place.line ? a.place.line < b.place.line
                                                             : a.place.column < b.place.column;
                     });
    return result;
}

SceneValue convert_node(const toml::node& node, int source, const std::string& filename,
                        const LeapSeconds& leaps) {
    const Place place = place_in(node.source(), source);
    if (const auto* table = node.as_table()) return {convert_table(*table, source, filename, leaps), place};
    if (const auto* array = node.as_array()) {
        SceneList list;
        for (const toml::node& item : *array)
            list.push_back(convert_node(item, source, filename, leaps));
        return {std::move(list), place};
    }
    if (const auto* v = node.as_boolean()) return {v->get(), place};
    if (const auto* v = node.as_integer()) return {v->get(), place};
    if (const auto* v = node.as_floating_point()) return {v->get(), place};
    if (const auto* v = node.as_string()) return {v->get(), place};
    if (const auto* v = node.as_date_time()) {
        const DateTime t = convert(v->get());
        return {leaps.contains({place.line, place.column}) ? second_later(t) : t, place};
    }
    if (const auto* v = node.as_time()) {
        const toml::time t = v->get();
        return {TimeOfDay{t.hour, t.minute, t.second, t.nanosecond}, place};
    }
    throw InputError(filename, place.line, place.column, "a date alone means nothing here");
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
    const std::string_view date = text.substr(std::min(i, text.size()), 10);
    if (date.size() == 10 && date[4] == '-' && date[7] == '-') return "";
    i = text.find_first_not_of("+-.0123456789", std::min(i, text.size()));
    if (i == std::string_view::npos || i == number) return "";
    i = text.find_first_not_of(' ', i);
    if (i == std::string_view::npos || std::isalpha(static_cast<unsigned char>(text[i])) == 0) return "";
    const bool exponent = (text[i] == 'e' || text[i] == 'E') && i + 1 < text.size() &&
                          std::isalpha(static_cast<unsigned char>(text[i + 1])) == 0;
    return !exponent ? " (a value is a plain number: its unit stands in the key's name)" : "";
}

/// Where line `line` of a text begins.
std::size_t line_start(std::string_view text, int line) {
    std::size_t at = 0;
    for (int l = 1; l < line; ++l)
        at = std::min(text.size(), text.find('\n', at) + 1);
    return at;
}

/// The parser has stopped at `place`. True when that is behind the 60 of a date-time's leap second, which is
/// then a 59 and one of `leaps`. A date-time is ASCII, so its first column is counted back from there.
bool take_leap_second(std::string& text, const Place& place, LeapSeconds& leaps) {
    const std::string_view form = "dddd-dd-dd_dd:dd:60";
    const std::size_t start = line_start(text, place.line),
                      end = std::min(text.find('\n', start), text.size());
    // Columns count code points.
    std::size_t at = start;
    for (int column = 1; column < place.column && at < end; ++column) {
        do {
            ++at;
        } while (at < end && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80);
    }
    for (std::size_t stop : {at, at + 1, at + 2}) {
        if (stop > end || stop < start + form.size()) continue;
        const std::size_t first = stop - form.size();
        const bool matches =
            std::equal(form.begin(), form.end(), text.begin() + static_cast<std::ptrdiff_t>(first),
                       [](char wanted, char c) {
                           if (wanted == 'd') return c >= '0' && c <= '9';
                           return wanted == '_' ? c == 'T' || c == 't' || c == ' ' : c == wanted;
                       });
        if (!matches) continue;
        text.replace(stop - 2, 2, "59");
        const auto back = static_cast<int>(at) - static_cast<int>(first);
        leaps.emplace(place.line, place.column - back);
        return true;
    }
    return false;
}

}  // namespace

SceneTable parse_toml(std::string_view text, const std::string& filename, int source) {
    std::string plain(text);
    LeapSeconds leaps;
    while (true) {
        try {
            return convert_table(toml::parse(plain), source, filename, leaps);
        } catch (const toml::parse_error& error) {
            const Place place = place_in(error.source(), source);
            if (take_leap_second(plain, place, leaps)) continue;
            std::string message{error.description()};
            constexpr std::string_view prefix = "Error while parsing ";
            if (message.starts_with(prefix)) message = "in " + message.substr(prefix.size());
            throw InputError(filename, place.line, place.column, message + unit_hint(text, place.line));
        }
    }
}

}  // namespace obscura
