#pragma once
// Settings of scenes drawn over the whole ranges of their keys.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "app/scene/schema.h"
#include "app/scene/toml_text.h"

namespace obscura {

/// Keys drawn from their own ranges, ends among them, as TOML.
class Draw {
  public:
    explicit Draw(std::uint64_t seed) : engine_(seed) {}

    double chance() { return std::uniform_real_distribution<>(0, 1)(engine_); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

    /// "" for those that are left out.
    std::string line(const KeySpec& key, double share) {
        if (!key.required && chance() > share) return "";
        const std::string value = value_of_key(key);
        return value.empty() ? "" : key.name + " = " + value + "\n";
    }

  private:
    std::string value_of_key(const KeySpec& key) {
        switch (key.type) {
            case KeyType::boolean:
                return chance() < 0.5 ? "true" : "false";
            case KeyType::choice:
                return "\"" + key.choices[below(key.choices.size())] + "\"";
            case KeyType::integer:
                return integer(key);
            case KeyType::number:
                return toml_text(value_of(number(key.range)));
            case KeyType::vec2:
                return "[" + component(key) + ", " + component(key) + "]";
            case KeyType::vec3:
            case KeyType::vec3_or_number:
                return "[" + component(key) + ", " + component(key) + ", " + component(key) + "]";
            case KeyType::name_list: {
                const char* names[] = {"\"ball\"", "\"wall\"", "[\"ball\", \"post\"]", "[\"post\"]"};
                const char* materials[] = {"\"clay\"", "[\"plaster\", \"stone\"]"};
                return key.name.ends_with("objects") ? names[below(4)] : materials[below(2)];
            }
            case KeyType::date_time:
                return date(key.range) + "T" + time_of_day() + offset();
            case KeyType::time_of_day:
                return "\"" + time_of_day() + "\"";
            default:
                return "";  // files
        }
    }
    /// Of vectors; points of the picture mostly lie in it.
    std::string component(const KeySpec& key) {
        if (key.name.ends_with("_px") && chance() < 0.95) return toml_text(value_of(27 * chance()));
        if (key.name.ends_with("_m") && chance() < 0.6) return toml_text(value_of(2 * chance() - 1));
        return toml_text(value_of(number(key.range)));
    }

    std::string time_of_day() {
        const std::size_t second = below(86400);
        return fmt::format("{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60);
    }

    /// The first and the last day of its years among them.
    std::string date(const Range& years) {
        const double kind = chance();
        if (kind < 0.1) return fmt::format("{:04}-01-01", std::llround(years.lo));
        if (kind < 0.2) return fmt::format("{:04}-12-31", std::llround(years.hi));
        const double year = kind < 0.5 ? 2026 : years.lo + std::floor((years.hi - years.lo + 1) * chance());
        return fmt::format("{:04}-{:02}-{:02}", std::llround(year), 1 + below(12), 1 + below(28));
    }
    std::string offset() {
        if (chance() < 0.5) return "Z";
        return fmt::format("{}{:02}:{:02}", chance() < 0.5 ? '+' : '-', below(24), below(60));
    }

    std::string integer(const KeySpec& key) {
        if (!key.allowed.empty()) return std::to_string(key.allowed[below(key.allowed.size())]);
        if (!key.word.empty() && chance() < 0.5) return "\"" + key.word + "\"";
        // What costs time and memory in proportion is not taken to its end.
        const double most = key.name == "margin_px" ? 200 : 40;
        return std::to_string(
            std::llround(number({key.range.lo, std::min(key.range.hi, most), key.range.open_lo, false})));
    }

    double number(const Range& r) {
        const double lo = r.open_lo ? std::nextafter(r.lo, r.hi) : r.lo;
        const double hi = r.open_hi ? std::nextafter(r.hi, r.lo) : r.hi;
        const double kind = chance();
        if (kind < 0.12) return lo;
        if (kind < 0.24) return hi;
        if (kind < 0.3) return lo + (hi - lo) * chance();
        // By magnitude, either sign that the range has.
        const double size = std::pow(10.0, std::uniform_real_distribution<>(-4, 3)(engine_));
        return std::clamp(lo < 0 && chance() < 0.5 ? -size : size, lo, hi);
    }

    std::mt19937_64 engine_;
};

}  // namespace obscura
