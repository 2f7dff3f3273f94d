#include "app/scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

std::string type_text(const KeySpec& key) {
    const std::string unit = unit_of(key.name);
    switch (key.type) {
        case KeyType::boolean:
            return "true or false";
        case KeyType::integer:
            return key.word.empty() ? "an integer" : fmt::format("an integer or \"{}\"", key.word);
        case KeyType::number:
            return unit.empty() ? "a number" : "a number of " + unit;
        case KeyType::text:
        case KeyType::file:
        case KeyType::name:
        case KeyType::choice:
            return "a string";
        case KeyType::time_of_day:
            return "a time of day";
        case KeyType::size2:
            return "two integers [width, height]";
        case KeyType::vec2:
            return "two numbers";
        case KeyType::vec3:
            return "three numbers";
        case KeyType::vec3_or_number:
            return "a number or three numbers";
        case KeyType::date_time:
            return "a date and time";
        case KeyType::table:
            return fmt::format("a table [{}]", key.name);
        case KeyType::table_list:
            return fmt::format("a list of tables [[{}]]", key.name);
        case KeyType::table_map:
            return fmt::format("tables [{}.NAME]", key.name);
        case KeyType::name_list:
            return "a list of names";
        case KeyType::name_map:
            return fmt::format("a table [{}] of names", key.name);
    }
    return "";
}

std::string found_text(const SceneValue& value) {
    struct Visitor {
        std::string operator()(bool) const { return "a boolean"; }
        std::string operator()(std::int64_t) const { return "an integer"; }
        std::string operator()(double) const { return "a number"; }
        std::string operator()(const std::string& s) const {
            return s.size() <= 40 ? fmt::format("the string \"{}\"", s) : "a string";
        }
        std::string operator()(const DateTime&) const { return "a date"; }
        std::string operator()(const TimeOfDay& t) const { return "the time of day " + time_text(t); }
        std::string operator()(const SceneList& list) const {
            return fmt::format("a list of {}", list.size());
        }
        std::string operator()(const SceneTable&) const { return "a table"; }
    };
    return std::visit(Visitor{}, value.data);
}

/// For "45 deg" where 45 was wanted.
std::string string_number_hint(const SceneValue& value) {
    const auto* s = std::get_if<std::string>(&value.data);
    if (s == nullptr) return "";
    const std::size_t digits = s->find_first_not_of("+-.0123456789eE");
    if (digits == 0 || s->find_first_of("0123456789") >= std::min(digits, s->size())) return "";
    std::string bare = s->substr(0, digits);
    while (!bare.empty() && (bare.back() == 'e' || bare.back() == 'E'))
        bare.pop_back();
    return fmt::format("; write {} without quotes, the unit stands in the key's name", bare);
}

[[noreturn]] void wrong_type(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const bool numeric = key.type == KeyType::number || key.type == KeyType::integer;
    fail_at(value.place, sources,
            fmt::format("'{}' must be {}, not {}{}", key.name, type_text(key), found_text(value),
                        numeric ? string_number_hint(value) : ""));
}

double checked_number(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* i = std::get_if<std::int64_t>(&value.data);
    const auto* d = std::get_if<double>(&value.data);
    if (i == nullptr && d == nullptr) wrong_type(key, value, sources);
    const double v = i != nullptr ? static_cast<double>(*i) : *d;
    if (!std::isfinite(v))
        fail_at(value.place, sources, fmt::format("'{}' must be finite, not {}", key.name, v));
    if (!key.range.contains(v)) {
        fail_at(value.place, sources, fmt::format("'{}' must be {}, not {}", key.name, allowed_text(key), v));
    }
    return v;
}

std::int64_t checked_integer(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* i = std::get_if<std::int64_t>(&value.data);
    if (i == nullptr) wrong_type(key, value, sources);
    const bool listed =
        key.allowed.empty() || std::find(key.allowed.begin(), key.allowed.end(), *i) != key.allowed.end();
    if (!listed || !key.range.contains(static_cast<double>(*i))) {
        fail_at(value.place, sources,
                fmt::format("'{}' must be {}, not {}", key.name, allowed_text(key), *i));
    }
    return *i;
}

SceneValue checked_list(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const bool integers = key.type == KeyType::size2;
    const auto* list = std::get_if<SceneList>(&value.data);
    if (list == nullptr && key.type == KeyType::vec3_or_number) {
        const double v = checked_number(key, value, sources);
        return {value_of(Vec3d{v, v, v}).data, value.place};
    }
    const bool two = integers || key.type == KeyType::vec2;
    if (list == nullptr || list->size() != (two ? 2u : 3u)) wrong_type(key, value, sources);
    SceneList checked;
    for (const SceneValue& item : *list) {
        SceneValue& number = checked.emplace_back();
        number.place = item.place;
        if (integers) {
            number.data = checked_integer(key, item, sources);
        } else {
            number.data = checked_number(key, item, sources);
        }
    }
    return {std::move(checked), value.place};
}

void check_name(const std::string& name, const std::string& what, const Place& place,
                const Sources& sources) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
    if (name.empty() || name.size() > 64 || !std::all_of(name.begin(), name.end(), plain)) {
        fail_at(place, sources, fmt::format("{} must be 1 to 64 letters, digits, '_' or '-'", what));
    }
}

SceneValue checked_text(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* s = std::get_if<std::string>(&value.data);
    if (s == nullptr) wrong_type(key, value, sources);
    if (key.type == KeyType::name) check_name(*s, fmt::format("'{}'", key.name), value.place, sources);
    if (key.type == KeyType::file && (s->empty() || s->find('\0') != std::string::npos)) {
        fail_at(value.place, sources,
                fmt::format("'{}' must name a {}", key.name, key.folder ? "folder" : "file"));
    }
    const bool known = std::find(key.choices.begin(), key.choices.end(), *s) != key.choices.end();
    const bool fits = key.type == KeyType::time_of_day ? parse_time_of_day(*s).has_value()
                                                       : key.type != KeyType::choice || known;
    if (!fits)
        fail_at(value.place, sources,
                fmt::format("'{}' must be {}, not \"{}\"{}", key.name, allowed_text(key),
                            s->size() <= 64 ? *s : fmt::format("{:.61}...", *s), hint(*s, key.choices)));
    return value;
}

SceneValue checked_date_time(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* t = std::get_if<DateTime>(&value.data);
    if (t == nullptr) wrong_type(key, value, sources);
    if (!t->has_offset) {
        fail_at(value.place, sources,
                fmt::format("'{}' needs an offset from UTC, as in 2026-06-21T18:00:00+02:00", key.name));
    }
    if (!key.range.contains(t->year)) {
        fail_at(value.place, sources,
                fmt::format("'{}' must be {}, not {}", key.name, allowed_text(key), t->year));
    }
    return value;
}

SceneValue checked_value(const KeySpec& key, const SceneValue& value, const Sources& sources);

/// [key.NAME] tables, and the keys beside them.
SceneValue checked_map(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* table = std::get_if<SceneTable>(&value.data);
    if (table == nullptr) wrong_type(key, value, sources);
    SceneTable map;
    for (const SceneEntry& entry : table->entries) {
        const auto* inner = std::get_if<SceneTable>(&entry.value.data);
        const auto beside = std::find_if(key.beside_tables.begin(), key.beside_tables.end(),
                                         [&](const KeySpec& k) { return k.name == entry.key; });
        if (inner == nullptr && beside != key.beside_tables.end()) {
            map.set(entry.key, checked_value(*beside, entry.value, sources));
            continue;
        }
        check_name(entry.key, fmt::format("the NAME of [{}.NAME]", key.name), entry.place, sources);
        if (inner == nullptr) wrong_type(key, entry.value, sources);
        map.set(entry.key,
                {validate_table(*inner, entry.value.place, *key.table, sources), entry.value.place});
    }
    return {std::move(map), value.place};
}

SceneValue checked_tables(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* table = std::get_if<SceneTable>(&value.data);
    if (key.type == KeyType::table) {
        if (table == nullptr) wrong_type(key, value, sources);
        return {validate_table(*table, value.place, *key.table, sources), value.place};
    }
    const auto* list = std::get_if<SceneList>(&value.data);
    if (list == nullptr) wrong_type(key, value, sources);
    SceneList checked;
    for (const SceneValue& item : *list) {
        const auto* inner = std::get_if<SceneTable>(&item.data);
        if (inner == nullptr) wrong_type(key, item, sources);
        checked.push_back({validate_table(*inner, item.place, *key.table, sources), item.place});
    }
    return {std::move(checked), value.place};
}

/// Keys are free (slots are named by files), values are names.
SceneValue checked_name_map(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    const auto* table = std::get_if<SceneTable>(&value.data);
    if (table == nullptr) wrong_type(key, value, sources);
    for (const SceneEntry& entry : table->entries) {
        const auto* name = std::get_if<std::string>(&entry.value.data);
        if (name == nullptr) {
            fail_at(entry.value.place, sources,
                    fmt::format("'{}' holds names, not {}", key.name, found_text(entry.value)));
        }
        check_name(*name, fmt::format("a name in '{}'", key.name), entry.value.place, sources);
    }
    return value;
}

/// Names that the rules look up: any text. One that stands alone is a list of one.
SceneValue checked_name_list(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    constexpr std::size_t longest = 256;
    SceneList names;
    if (std::holds_alternative<std::string>(value.data)) {
        names.push_back(value);
    } else if (const auto* list = std::get_if<SceneList>(&value.data)) {
        names = *list;
    } else {
        wrong_type(key, value, sources);
    }
    if (names.empty()) fail_at(value.place, sources, fmt::format("'{}' must name something", key.name));
    for (const SceneValue& item : names) {
        const auto* name = std::get_if<std::string>(&item.data);
        if (name == nullptr) {
            fail_at(item.place, sources, fmt::format("'{}' holds names, not {}", key.name, found_text(item)));
        }
        if (name->empty() || name->size() > longest || name->find('\0') != std::string::npos) {
            fail_at(item.place, sources,
                    fmt::format("a name in '{}' must be 1 to {} characters", key.name, longest));
        }
    }
    return {std::move(names), value.place};
}

SceneValue checked_value(const KeySpec& key, const SceneValue& value, const Sources& sources) {
    switch (key.type) {
        case KeyType::boolean:
            if (!std::holds_alternative<bool>(value.data)) wrong_type(key, value, sources);
            return value;
        case KeyType::integer: {
            const auto* word = std::get_if<std::string>(&value.data);
            if (word != nullptr && !key.word.empty() && *word == key.word) return value;
            return {checked_integer(key, value, sources), value.place};
        }
        case KeyType::number:
            return {checked_number(key, value, sources), value.place};
        case KeyType::text:
        case KeyType::file:
        case KeyType::name:
        case KeyType::choice:
            return checked_text(key, value, sources);
        case KeyType::time_of_day:
            return checked_text(key, time_as_text(value), sources);
        case KeyType::size2:
        case KeyType::vec2:
        case KeyType::vec3:
        case KeyType::vec3_or_number:
            return checked_list(key, value, sources);
        case KeyType::date_time:
            return checked_date_time(key, value, sources);
        case KeyType::table:
        case KeyType::table_list:
            return checked_tables(key, value, sources);
        case KeyType::table_map:
            return checked_map(key, value, sources);
        case KeyType::name_list:
            return checked_name_list(key, value, sources);
        case KeyType::name_map:
            return checked_name_map(key, value, sources);
    }
    return value;
}

/// The variant that a raw table asks for; checks the discriminator, since nothing else makes sense without
/// it.
const VariantSpec* raw_variant(const SceneTable& raw, const Place& place, const TableSpec& spec,
                               const Sources& sources) {
    if (spec.variants.empty()) return nullptr;
    const auto key = std::find_if(spec.keys.begin(), spec.keys.end(),
                                  [&](const KeySpec& k) { return k.name == spec.discriminator; });
    CHECK(key != spec.keys.end());
    const SceneEntry* entry = raw.find(spec.discriminator);
    if (entry == nullptr && !key->fallback) {
        fail_at(place, sources, fmt::format("{} needs '{}': {}", spec.path, key->name, allowed_text(*key)));
    }
    const SceneValue chosen = entry != nullptr ? checked_text(*key, entry->value, sources) : *key->fallback;
    const auto& name = std::get<std::string>(chosen.data);
    const auto variant = std::find_if(spec.variants.begin(), spec.variants.end(),
                                      [&](const VariantSpec& v) { return v.name == name; });
    CHECK(variant != spec.variants.end(), name);
    return &*variant;
}

[[noreturn]] void unknown_key(const SceneEntry& entry, const TableSpec& spec, const VariantSpec* variant,
                              const std::vector<const KeySpec*>& known, const Sources& sources) {
    const std::string shown = entry.key.size() <= 64 ? entry.key : entry.key.substr(0, 61) + "...";
    for (const VariantSpec& other : spec.variants) {
        for (const KeySpec& key : other.keys) {
            if (key.name != entry.key) continue;
            fail_at(entry.place, sources,
                    fmt::format("'{}' does not apply to {} with {} = \"{}\"", shown, spec.path,
                                spec.discriminator, variant->name));
        }
    }
    std::vector<std::string> names(known.size());
    std::transform(known.begin(), known.end(), names.begin(), [](const KeySpec* key) { return key->name; });
    const std::string where = spec.path.empty() ? "" : " in " + spec.path;
    fail_at(entry.place, sources, fmt::format("unknown key '{}'{}{}", shown, where, hint(entry.key, names)));
}

}  // namespace

void fail_at(const Place& place, const Sources& sources, const std::string& message) {
    const std::size_t source = place.source >= 0 ? static_cast<std::size_t>(place.source) : 0;
    throw InputError(sources.at(source), place.line, place.column, message);
}

void require_known(const std::string& name, const Place& place, const std::vector<std::string>& known,
                   const char* what, const Sources& sources) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    fail_at(place, sources, fmt::format("there is no {} '{}'{}", what, name, hint(name, known)));
}

SceneTable validate_table(const SceneTable& raw, const Place& place, const TableSpec& spec,
                          const Sources& sources) {
    const VariantSpec* variant = raw_variant(raw, place, spec, sources);
    std::vector<const KeySpec*> known;
    for (const KeySpec& key : spec.keys)
        known.push_back(&key);
    if (variant != nullptr) {
        for (const KeySpec& key : variant->keys)
            known.push_back(&key);
    }

    // In the order of the file, so that the first error reported is the first one written.
    SceneTable given;
    for (const SceneEntry& entry : raw.entries) {
        const auto key =
            std::find_if(known.begin(), known.end(), [&](const KeySpec* k) { return k->name == entry.key; });
        if (key == known.end()) unknown_key(entry, spec, variant, known, sources);
        given.entries.push_back({entry.key, entry.place, checked_value(**key, entry.value, sources)});
    }

    // In the order of the schema, with defaults.
    SceneTable result;
    for (const KeySpec* key : known) {
        if (SceneEntry* entry = given.find(key->name)) {
            result.entries.push_back(std::move(*entry));
        } else if (key->required) {
            const std::string where = spec.path.empty() ? "scene" : spec.path;
            fail_at(place, sources,
                    key->type == KeyType::table
                        ? fmt::format("no {}: the scene needs [{}]", key->name, key->name)
                        : fmt::format("{} needs '{}'", where, key->name));
        } else if (key->fallback) {
            result.set(key->name, *key->fallback);
        } else if (key->type == KeyType::name_map) {
            result.set(key->name, {SceneTable{}, {}});
        } else if (key->type == KeyType::table && !key->absent) {
            result.set(key->name, {validate_table({}, {}, *key->table, sources), {}});
        }
    }
    return result;
}

const VariantSpec* variant_of(const SceneTable& table, const TableSpec& spec) {
    if (spec.variants.empty()) return nullptr;
    for (const VariantSpec& variant : spec.variants) {
        if (variant.name == text(table, spec.discriminator)) return &variant;
    }
    return nullptr;
}

}  // namespace obscura
