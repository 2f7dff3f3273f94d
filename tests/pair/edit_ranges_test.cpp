// [stereo] and [[stereo.edit]] over the whole ranges of their keys: what the rows allow is refused with a
// reason or makes a pair of finite pictures.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "app/scene/keys.h"
#include "app/scene/toml_text.h"
#include "tests/pair/limit_cases.h"

namespace obscura {
namespace {

using stereo_limits::ball, stereo_limits::box, stereo_limits::Case, stereo_limits::pair_of;

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
                return "[" + component(key) + ", " + component(key) + ", " + component(key) + "]";
            case KeyType::name_list: {
                const char* names[] = {"\"ball\"", "\"wall\"", "[\"ball\", \"post\"]", "[\"post\"]"};
                const char* materials[] = {"\"clay\"", "[\"plaster\", \"stone\"]"};
                return key.name.ends_with("objects") ? names[below(4)] : materials[below(2)];
            }
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

std::string drawn_stereo(Draw& draw) {
    std::string keys;
    for (const KeySpec& key : stereo_table().keys) {
        if (key.type != KeyType::table_list && key.name != "interaxial_m") keys += draw.line(key, 0.15);
    }
    return keys;
}

std::string drawn_edits(Draw& draw) {
    const TableSpec& spec = stereo_edit_table();
    std::string edits;
    for (std::size_t i = 0, count = 1 + draw.below(3); i < count; ++i) {
        const VariantSpec& variant = spec.variants[draw.below(spec.variants.size())];
        edits += "[[stereo.edit]]\nid = \"e" + std::to_string(i) + "\"\ntype = \"" + variant.name + "\"\n";
        // Keys that need or exclude one another come together or not at all, mostly.
        const double angle = draw.chance() < 0.15 ? 1 : 0, distance = draw.chance() < 0.15 ? 1 : 0,
                     in_px = draw.chance() < 0.5 ? 1 : 0;
        for (const KeySpec& key : spec.keys) {
            if (key.name == "id" || key.name == "type") continue;
            const bool of_angle = key.name == "fade_angle_deg" || key.name == "fade_direction";
            edits += draw.line(key, key.name == "weight" ? 0.2 : of_angle ? angle : distance);
        }
        for (const KeySpec& key : variant.keys) {
            const double share = key.name == "offset_px"                                   ? 0.7 * in_px
                                 : key.name == "offset_percent"                            ? 0.7 - 0.7 * in_px
                                 : key.name == "objects"                                   ? 0.95
                                 : key.name.starts_with("second_")                         ? 0.3
                                 : key.name == "source_px" || key.name == "destination_px" ? in_px
                                 : key.name == "source_m" || key.name == "destination_m"   ? 1 - in_px
                                                                                           : 0.3;
            edits += draw.line(key, share);
        }
    }
    return edits;
}

bool is_finite(float v) {
    return std::isfinite(v);
}
bool is_finite(Vec3f v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Map>
std::int64_t not_finite(const Map& map) {
    return std::count_if(map.pixels.begin(), map.pixels.end(), [](const auto& v) { return !is_finite(v); });
}

/// Maps of pixels that see nothing have their own value for that.
void expect_sound(const StereoPair& pair) {
    EXPECT_EQ(not_finite(pair.optimised), 0);
    EXPECT_EQ(not_finite(pair.solution.disparity), 0);
    EXPECT_TRUE(std::isfinite(pair.solution.report.error_max_px));
    EXPECT_EQ(not_finite(pair.eyes.left.radiance), 0);
    EXPECT_EQ(not_finite(pair.eyes.right.radiance), 0);
}

TEST(EditRanges, WhatTheRowsAllowIsMadeOrRefused) {
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const int wanted = slow != nullptr ? 1000 * std::max(1, std::atoi(slow)) : 60;
    int made = 0, refused = 0, too_large = 0;
    for (int i = 0; i < 20 * wanted && made < wanted && !testing::Test::HasFailure(); ++i) {
        Draw draw(static_cast<std::uint64_t>(i));
        const std::string keys = drawn_stereo(draw), edits = drawn_edits(draw);
        SCOPED_TRACE("draw " + std::to_string(i) + ":\n" + keys + edits);
        const std::string scene =
            box("wall", {16, 10, 0.2}, {0, draw.chance() < 0.5 ? 0.0 : -5.5, -3}, "plaster") +
            ball("ball", 0.5, {0.4, 0, 0}) + box("post", {0.05, 3, 0.05}, {-0.6, 0, 0.5});
        try {
            const Case c = stereo_limits::made(keys, scene + edits, 48, 27);
            expect_sound(pair_of(c));
            ++made;
        } catch (const InputError& error) {
            EXPECT_FALSE(error.message.empty());
            ++refused;
        } catch (const LimitError&) {
            ++too_large;
        }
    }
    fmt::print("{} made, {} refused, {} beyond limits\n", made, refused, too_large);
    EXPECT_EQ(made, wanted);
}

}  // namespace
}  // namespace obscura
