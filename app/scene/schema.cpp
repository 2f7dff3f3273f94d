#include "app/scene/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace obscura {
namespace {

KeySpec key(std::string name, KeyType type, std::string doc) {
    KeySpec spec;
    spec.name = std::move(name);
    spec.type = type;
    spec.doc = std::move(doc);
    return spec;
}

KeySpec table_of(std::string name, KeyType type, const TableSpec& table) {
    KeySpec spec = key(std::move(name), type, "");
    spec.table = &table;
    return spec;
}

/// Optimal string alignment distance (Damerau 1964): edits that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = std::exchange(last, row);
    }
    return last[b.size()];
}

}  // namespace

KeySpec boolean_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::boolean, std::move(doc));
}
KeySpec integer_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::integer, std::move(doc));
}
KeySpec number_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::number, std::move(doc));
}
KeySpec text_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::text, std::move(doc));
}
KeySpec file_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::file, std::move(doc));
}
KeySpec name_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::name, std::move(doc));
}
KeySpec choice_key(std::string name, std::vector<std::string> choices, std::string doc) {
    KeySpec spec = key(std::move(name), KeyType::choice, std::move(doc));
    spec.choices = std::move(choices);
    return spec;
}
KeySpec size_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::size2, std::move(doc));
}
KeySpec vec2_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::vec2, std::move(doc));
}
KeySpec vec3_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::vec3, std::move(doc));
}
KeySpec vec3_or_number_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::vec3_or_number, std::move(doc));
}
KeySpec date_time_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::date_time, std::move(doc));
}
KeySpec time_of_day_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::time_of_day, std::move(doc));
}
KeySpec name_list_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::name_list, std::move(doc));
}
KeySpec name_map_key(std::string name, std::string doc) {
    return key(std::move(name), KeyType::name_map, std::move(doc));
}
KeySpec table_key(std::string name, const TableSpec& table) {
    return table_of(std::move(name), KeyType::table, table);
}
KeySpec table_list_key(std::string name, const TableSpec& table) {
    return table_of(std::move(name), KeyType::table_list, table);
}
KeySpec table_map_key(std::string name, const TableSpec& table) {
    return table_of(std::move(name), KeyType::table_map, table);
}

std::string unit_of(std::string_view name) {
    static const std::pair<const char*, const char*> units[] = {
        {"_w_m2_sr", "W/(m² sr)"},
        {"_w_m2", "W/m²"},
        {"_w_sr", "W/sr"},
        {"_mib", "MiB"},
        {"_deg", "degrees"},
        {"_mm", "mm"},
        {"_px", "pixels"},
        {"_texels", "texels"},
        {"_ev", "EV"},
        {"_m", "metres"},
        {"_percent", "% of the width"},
    };
    for (const auto& [suffix, unit] : units) {
        if (name.ends_with(suffix)) return unit;
    }
    return "";
}

std::string allowed_text(const KeySpec& key) {
    if (!key.choices.empty()) return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
    const std::string word = key.word.empty() ? "" : fmt::format(" or \"{}\"", key.word);
    if (!key.allowed.empty()) return fmt::format("one of {}{}", fmt::join(key.allowed, ", "), word);
    const Range& r = key.range;
    if (key.type == KeyType::date_time) return fmt::format("in the years {} to {}", r.lo, r.hi);
    if (key.type == KeyType::time_of_day) return "\"HH:MM\" or \"HH:MM:SS\", 00:00 to 24:00";
    const bool below = r.hi != std::numeric_limits<double>::infinity();
    const bool above = r.lo != -std::numeric_limits<double>::infinity();
    if (above && below) {
        return fmt::format("in {}{}, {}{}", r.open_lo ? '(' : '[', r.lo, r.hi, r.open_hi ? ')' : ']');
    }
    if (above) return fmt::format("{} {}", r.open_lo ? "more than" : "at least", r.lo);
    if (below) return fmt::format("{} {}", r.open_hi ? "less than" : "at most", r.hi);
    return "";
}

std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t longest_name =
        64;  // whatever is longer is no slip, and comparing it would take long
    if (name.size() > longest_name) return std::nullopt;
    std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
    std::optional<std::string> found;
    for (const std::string& candidate : names) {
        // A key without its unit counts as a slip of one letter.
        const bool lacks_unit = !name.empty() && candidate.size() > name.size() + 1 &&
                                candidate.compare(0, name.size(), name) == 0 && candidate[name.size()] == '_';
        const std::size_t distance = lacks_unit ? 1 : edit_distance(name, candidate);
        if (distance < best && distance < candidate.size()) {
            best = distance;
            found = candidate;
        }
    }
    return found;
}

std::string hint(std::string_view name, const std::vector<std::string>& names) {
    const auto found = nearest(name, names);
    return found ? fmt::format("; did you mean '{}'?", *found) : "";
}

}  // namespace obscura
