#include "app/scene/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/error.h"

namespace obscura {
namespace {

const SceneValue& get(const SceneTable& table, std::string_view key) {
    const SceneEntry* entry = table.find(key);
    CHECK(entry != nullptr, fmt::format("no key '{}'", key));
    return entry->value;
}

template <class T>
const T& get_as(const SceneTable& table, std::string_view key) {
    const T* value = std::get_if<T>(&get(table, key).data);
    CHECK(value != nullptr, fmt::format("key '{}' has another type", key));
    return *value;
}

double as_number(const SceneValue& value) {
    if (const auto* i = std::get_if<std::int64_t>(&value.data)) return static_cast<double>(*i);
    const auto* d = std::get_if<double>(&value.data);
    CHECK(d != nullptr, "not a number");
    return *d;
}

}  // namespace

const SceneEntry* SceneTable::find(std::string_view key) const {
    const auto it =
        std::find_if(entries.begin(), entries.end(), [&](const SceneEntry& e) { return e.key == key; });
    return it == entries.end() ? nullptr : &*it;
}

SceneEntry* SceneTable::find(std::string_view key) {
    return const_cast<SceneEntry*>(static_cast<const SceneTable*>(this)->find(key));
}

void SceneTable::set(std::string_view key, SceneValue value) {
    const Place place = value.place;
    if (SceneEntry* entry = find(key)) {
        *entry = {std::string(key), place, std::move(value)};
    } else {
        entries.push_back({std::string(key), place, std::move(value)});
    }
}

void SceneTable::erase(std::string_view key) {
    std::erase_if(entries, [&](const SceneEntry& e) { return e.key == key; });
}

SceneValue value_of(bool v) {
    return {v, {}};
}
SceneValue value_of(int v) {
    return value_of(std::int64_t{v});
}
SceneValue value_of(std::int64_t v) {
    return {v, {}};
}
SceneValue value_of(double v) {
    return {v, {}};
}
SceneValue value_of(float v) {
    return value_of(std::strtod(fmt::format("{}", v).c_str(), nullptr));
}
SceneValue value_of(const char* v) {
    return {std::string(v), {}};
}
SceneValue value_of(const std::string& v) {
    return {v, {}};
}
SceneValue value_of(Size2 v) {
    return {SceneList{value_of(std::int64_t{v.width}), value_of(std::int64_t{v.height})}, {}};
}
SceneValue value_of(Vec2d v) {
    return {SceneList{value_of(v.x), value_of(v.y)}, {}};
}
SceneValue value_of(Vec3d v) {
    return {SceneList{value_of(v.x), value_of(v.y), value_of(v.z)}, {}};
}

SceneValue value_of(Vec3f v) {
    return {SceneList{value_of(v.x), value_of(v.y), value_of(v.z)}, {}};
}

bool boolean(const SceneTable& table, std::string_view key) {
    return get_as<bool>(table, key);
}

std::int64_t integer(const SceneTable& table, std::string_view key) {
    return get_as<std::int64_t>(table, key);
}

double number(const SceneTable& table, std::string_view key) {
    return as_number(get(table, key));
}

const std::string& text(const SceneTable& table, std::string_view key) {
    return get_as<std::string>(table, key);
}

Vec2d vec2(const SceneTable& table, std::string_view key) {
    const auto& list = get_as<SceneList>(table, key);
    CHECK(list.size() == 2, fmt::format("key '{}' has {} numbers", key, list.size()));
    return {as_number(list[0]), as_number(list[1])};
}

Vec3d vec3(const SceneTable& table, std::string_view key) {
    const auto& list = get_as<SceneList>(table, key);
    CHECK(list.size() == 3, fmt::format("key '{}' has {} numbers", key, list.size()));
    return {as_number(list[0]), as_number(list[1]), as_number(list[2])};
}

Size2 size2(const SceneTable& table, std::string_view key) {
    const auto& list = get_as<SceneList>(table, key);
    CHECK(list.size() == 2, fmt::format("key '{}' has {} numbers", key, list.size()));
    return {static_cast<int>(as_number(list[0])), static_cast<int>(as_number(list[1]))};
}

std::string time_text(const TimeOfDay& t) {
    const std::string whole = fmt::format("{:02}:{:02}:{:02}", t.hour, t.minute, t.second);
    return t.nanosecond == 0 ? whole : fmt::format("{}.{:09}", whole, t.nanosecond);
}

SceneValue time_as_text(const SceneValue& value) {
    const auto* time = std::get_if<TimeOfDay>(&value.data);
    return time == nullptr ? value : SceneValue{time_text(*time), value.place};
}

std::optional<double> parse_time_of_day(std::string_view text) {
    if (text.size() != 5 && text.size() != 8) return std::nullopt;
    int parts[3] = {0, 0, 0};
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool colon = i % 3 == 2, digit = text[i] >= '0' && text[i] <= '9';
        if (colon ? text[i] != ':' : !digit) return std::nullopt;
        if (!colon) parts[i / 3] = 10 * parts[i / 3] + (text[i] - '0');
    }
    const auto [hour, minute, second] = parts;
    const bool within = hour < 24 || (hour == 24 && minute == 0 && second == 0);
    if (!within || minute > 59 || second > 59) return std::nullopt;
    return hour + minute / 60.0 + second / 3600.0;
}

DateTime date_time(const SceneTable& table, std::string_view key) {
    return get_as<DateTime>(table, key);
}

double time_of_day(const SceneTable& table, std::string_view key) {
    const std::optional<double> hours = parse_time_of_day(text(table, key));
    CHECK(hours, fmt::format("key '{}' is no time of day", key));
    return *hours;
}

const SceneTable& subtable(const SceneTable& table, std::string_view key) {
    return get_as<SceneTable>(table, key);
}

std::vector<std::string> text_list(const SceneTable& table, std::string_view key) {
    std::vector<std::string> all;
    if (!table.has(key)) return all;
    for (const SceneValue& item : get_as<SceneList>(table, key))
        all.push_back(std::get<std::string>(item.data));
    return all;
}

std::vector<const SceneTable*> subtables(const SceneTable& table, std::string_view key) {
    std::vector<const SceneTable*> tables;
    if (!table.has(key)) return tables;
    for (const SceneValue& item : get_as<SceneList>(table, key))
        tables.push_back(&std::get<SceneTable>(item.data));
    return tables;
}

Place place_of(const SceneTable& table, std::string_view key) {
    return get(table, key).place;
}

}  // namespace obscura
