// [stereo] and [[stereo.edit]] over the whole ranges of their keys: what the rows allow is refused with a
// reason or makes a pair of finite pictures.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "app/scene/keys.h"
#include "tests/pair/limit_cases.h"
#include "tests/scene/key_draw.h"

namespace obscura {
namespace {

using stereo_limits::ball, stereo_limits::box, stereo_limits::Case, stereo_limits::pair_of;

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
