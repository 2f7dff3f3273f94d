#pragma once
// The tree a scene file is read into: plain values with the place they were written at. It knows nothing of
// TOML's syntax (toml_parse.cpp does) nor of what keys mean (keys*.cpp do).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// Where a value was written. `source` indexes the names of the document's sources: 0 is the scene file, then
/// one per override; -1 means that the value is a default and stands nowhere. Lines and columns count from 1.
struct Place {
    int source = -1, line = 0, column = 0;
};

/// Date and time of day with its offset from UTC.
struct DateTime {
    int year = 2000, month = 1, day = 1, hour = 0, minute = 0, second = 0;
    std::int64_t nanosecond = 0;
    bool has_offset = false;
    int offset_minutes = 0;
    friend bool operator==(const DateTime&, const DateTime&) = default;
};

/// A time of day alone, as TOML has it without quotes. Keys of times of day keep it as text.
struct TimeOfDay {
    int hour = 0, minute = 0, second = 0;
    std::int64_t nanosecond = 0;
    friend bool operator==(const TimeOfDay&, const TimeOfDay&) = default;
};
std::string time_text(const TimeOfDay& time);  ///< "06:30:00"; nanoseconds when there are any

/// Hours since midnight of "HH:MM" or "HH:MM:SS", from 00:00 to 24:00; none of anything else.
std::optional<double> parse_time_of_day(std::string_view text);

/// Width and height in pixels.
struct Size2 {
    int width = 0, height = 0;
};

struct SceneValue;
struct SceneEntry;
using SceneList = std::vector<SceneValue>;

struct SceneTable {
    std::vector<SceneEntry> entries;

    const SceneEntry* find(std::string_view key) const;
    SceneEntry* find(std::string_view key);
    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Replaces the value of `key`, or appends it.
    void set(std::string_view key, SceneValue value);
    void erase(std::string_view key);
};

struct SceneValue {
    std::variant<bool, std::int64_t, double, std::string, DateTime, TimeOfDay, SceneList, SceneTable> data;
    Place place;
};

struct SceneEntry {
    std::string key;
    Place place;
    SceneValue value;
};

/// A time of day without quotes as the text it would be with them; anything else as it is.
SceneValue time_as_text(const SceneValue& value);

// Makers of values that stand nowhere: defaults.
SceneValue value_of(bool v);
SceneValue value_of(int v);
SceneValue value_of(std::int64_t v);
SceneValue value_of(double v);
SceneValue value_of(float v);  ///< through the shortest decimal that gives the same float: 0.8f is 0.8
SceneValue value_of(const char* v);
SceneValue value_of(const std::string& v);
SceneValue value_of(Size2 v);
SceneValue value_of(Vec2d v);
SceneValue value_of(Vec3d v);
SceneValue value_of(Vec3f v);  ///< as floats

// Readers of validated tables. The key must be there with that type: the schema saw to it.
bool boolean(const SceneTable& table, std::string_view key);
std::int64_t integer(const SceneTable& table, std::string_view key);
double number(const SceneTable& table, std::string_view key);
const std::string& text(const SceneTable& table, std::string_view key);
Vec2d vec2(const SceneTable& table, std::string_view key);
Vec3d vec3(const SceneTable& table, std::string_view key);
Size2 size2(const SceneTable& table, std::string_view key);
DateTime date_time(const SceneTable& table, std::string_view key);
double time_of_day(const SceneTable& table, std::string_view key);  ///< hours
const SceneTable& subtable(const SceneTable& table, std::string_view key);
/// The names of a list; empty when the key is absent.
std::vector<std::string> text_list(const SceneTable& table, std::string_view key);
/// The tables of a list; empty when the key is absent.
std::vector<const SceneTable*> subtables(const SceneTable& table, std::string_view key);
Place place_of(const SceneTable& table, std::string_view key);

}  // namespace obscura
