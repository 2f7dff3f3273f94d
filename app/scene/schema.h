#pragma once
// How tables of a scene file are declared. One declaration drives validation, hints, defaults, `dump`, the
// choice of keys that can be animated and the written format description, so these cannot disagree.

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/value.h"

namespace obscura {

enum class KeyType {
    boolean,
    integer,
    number,
    text,
    file,            ///< text that names a file
    name,            ///< text of letters, digits, '_' and '-': ids and references
    choice,          ///< text out of a list
    size2,           ///< two integers
    vec2,            ///< two numbers
    vec3,            ///< three numbers
    vec3_or_number,  ///< three numbers, or one that stands for all three
    date_time,
    time_of_day,  ///< text "HH:MM" or "HH:MM:SS"
    table,        ///< [key]
    table_list,   ///< [[key]]
    table_map,    ///< [key.NAME]
    name_list,    ///< texts, or one that stands alone
    name_map,     ///< NAME = "name" pairs, whose keys are any text
};

/// Numbers from lo to hi; an open end excludes its bound. Applies to each component of a vector, and to the
/// year of a date.
struct Range {
    double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
    bool open_lo = false, open_hi = false;

    bool contains(double v) const { return (open_lo ? v > lo : v >= lo) && (open_hi ? v < hi : v <= hi); }
};

struct TableSpec;

struct KeySpec {
    std::string name;
    KeyType type = KeyType::number;
    std::string doc;
    bool required = false;
    bool animated = false;  ///< frames can set it
    bool folder = false;    ///< files: the text names a folder
    bool written = false;   ///< files: the text names one that is made
    bool absent = false;    ///< tables: stay away unless given
    Range range;
    std::vector<std::string> choices;
    std::vector<std::int64_t> allowed;  ///< integers: exactly these, when not empty
    std::string word;                   ///< integers: this text is allowed instead, when not empty
    std::optional<SceneValue> fallback;
    const TableSpec* table = nullptr;
    std::vector<KeySpec> beside_tables;  ///< table_map: keys that stand beside the [key.NAME]s

    // A key reads as a sentence: number("vfov_deg", "...").in(Range{0, 180, true, true}).animate().
    KeySpec&& need() && { return required = true, std::move(*this); }
    KeySpec&& animate() && { return animated = true, std::move(*this); }
    KeySpec&& as_folder() && { return folder = true, std::move(*this); }
    KeySpec&& as_result() && { return written = true, std::move(*this); }
    KeySpec&& only_if_given() && { return absent = true, std::move(*this); }
    KeySpec&& in(Range r) && { return range = r, std::move(*this); }
    KeySpec&& one_of(std::vector<std::int64_t> values) && {
        return allowed = std::move(values), std::move(*this);
    }
    KeySpec&& or_word(std::string w) && { return word = std::move(w), std::move(*this); }
    KeySpec&& beside(std::vector<KeySpec> keys) && {
        return beside_tables = std::move(keys), std::move(*this);
    }
    template <class T>
    KeySpec&& or_else(T value) && {
        return fallback = value_of(value), std::move(*this);
    }
};

/// Keys that belong to a table only when its discriminator has the value `name`.
struct VariantSpec {
    std::string name, doc;
    std::vector<KeySpec> keys;
};

struct TableSpec {
    std::string path;  ///< as written: "[camera]", "[[mesh]]", "[material.NAME]"
    std::string doc;
    std::vector<KeySpec> keys;
    std::string discriminator;  ///< a choice among `keys` that picks the variant; empty = no variants
    std::vector<VariantSpec> variants;
};

// Starts of key declarations.
KeySpec boolean_key(std::string name, std::string doc);
KeySpec integer_key(std::string name, std::string doc);
KeySpec number_key(std::string name, std::string doc);
KeySpec text_key(std::string name, std::string doc);
KeySpec file_key(std::string name, std::string doc);
KeySpec name_key(std::string name, std::string doc);
KeySpec choice_key(std::string name, std::vector<std::string> choices, std::string doc);
KeySpec size_key(std::string name, std::string doc);
KeySpec vec2_key(std::string name, std::string doc);
KeySpec vec3_key(std::string name, std::string doc);
KeySpec vec3_or_number_key(std::string name, std::string doc);
KeySpec date_time_key(std::string name, std::string doc);
KeySpec time_of_day_key(std::string name, std::string doc);
KeySpec name_list_key(std::string name, std::string doc);
KeySpec name_map_key(std::string name, std::string doc);
KeySpec table_key(std::string name, const TableSpec& table);
KeySpec table_list_key(std::string name, const TableSpec& table);
KeySpec table_map_key(std::string name, const TableSpec& table);

/// The unit that a key's name ends with, spelt out for people ("degrees"); empty when it has none.
std::string unit_of(std::string_view key);

/// "in (0, 180)", "at least 0", "one of 1, 4, 16": what the key's range and lists allow; empty when anything.
std::string allowed_text(const KeySpec& key);

/// The nearest of `names` when it is near enough to be a slip of the pen: at most two edits (insert, delete,
/// replace, swap neighbours), a third of the name, or the unit at its end (`vfov` for `vfov_deg`).
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& names);

/// "; did you mean 'x'?" or "".
std::string hint(std::string_view name, const std::vector<std::string>& names);

}  // namespace obscura
