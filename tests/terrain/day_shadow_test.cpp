// What a picture asks of a day is, at samples, the whole shadow; between them, wrong within a cell of edges.

#include "hierarchy/terrain/day_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/num.h"
#include "raster/heights/height_sweep.h"
#include "tests/heights/drawn_heights.h"
#include "tests/terrain/drawn_days.h"

namespace obscura {
namespace {

using drawn::hills;
using drawn::suns_over;

std::shared_ptr<const GroundDay> ground_day(Diagonal diagonal, int suns) {
    GroundDay ground;
    ground.field = std::make_shared<const HeightField>(hills(150, 131, diagonal));
    ground.pyramid = height_pyramid(*ground.field);
    ground.day = make_far_day(*ground.field, suns_over(*ground.field, suns), {4, 64, 8}, {});
    ground.name = "day";
    return std::make_shared<const GroundDay>(std::move(ground));
}

TEST(DayShadow, IsTheWholeShadowAtEverySampleFromEveryCellAroundIt) {
    for (const Diagonal diagonal : {Diagonal::falling, Diagonal::rising}) {
        const auto ground = ground_day(diagonal, 11);
        const HeightField& f = *ground->field;
        std::int64_t dark = 0;
        for (int i = 0; i < 11; ++i) {
            const auto sun = day_sun(ground, i, {});
            const int whole[] = {0};
            const ShadowBits bits =
                sweep_shadows(f, ground->day.suns[static_cast<std::size_t>(i)].direction, whole)[0];
            for (int y = 0; y < f.height(); ++y) {
                for (int x = 0; x < f.width(); ++x) {
                    for (int which = 0; which < 4; ++which) {
                        const int cx = std::clamp(x - which % 2, 0, f.width() - 2),
                                  cy = std::clamp(y - which / 2, 0, f.height() - 2);
                        ASSERT_EQ(ground_dark(*sun, {cx, cy, double(x - cx), double(y - cy)}), bits(x, y))
                            << "sun " << i << ", sample " << x << ", " << y;
                    }
                    dark += bits(x, y);
                }
            }
        }
        EXPECT_GT(dark, 11 * 150 * 131 / 20);
    }
}

TEST(DayShadow, BetweenSamplesErrsWithinACellOfAnEdge) {
    const auto ground = ground_day(Diagonal::falling, 6);
    const HeightField& f = *ground->field;
    drawn::Random random(11);
    std::int64_t asked = 0, wrong = 0, far_off = 0;
    for (int i = 0; i < 6; ++i) {
        const auto sun = day_sun(ground, i, {});
        const int whole[] = {0};
        const ShadowBits bits =
            sweep_shadows(f, ground->day.suns[static_cast<std::size_t>(i)].direction, whole)[0];
        for (int n = 0; n < 20000; ++n) {
            const GroundPlace place{drawn::below(random, f.width() - 1), drawn::below(random, f.height() - 1),
                                    drawn::unit(random), drawn::unit(random)};
            const bool truth = sun->rays.ground_hidden(place, 1 << 20);
            ++asked;
            if (ground_dark(*sun, place) == truth) continue;
            ++wrong;
            // A sample of the cell or of those around it has the other shadow.
            int dark = 0, all = 0;
            for (int y = std::max(0, place.cell_y - 1); y <= std::min(f.height() - 1, place.cell_y + 2);
                 ++y) {
                for (int x = std::max(0, place.cell_x - 1); x <= std::min(f.width() - 1, place.cell_x + 2);
                     ++x) {
                    dark += bits(x, y);
                    ++all;
                }
            }
            far_off += dark == 0 || dark == all;
        }
    }
    EXPECT_GT(wrong, 0);
    EXPECT_LT(wrong, asked / 50);
    // Ground between samples that stands out of near shadow, or dips into it: limits.md.
    EXPECT_LE(far_off, asked / 2000) << wrong << " of " << asked << " wrong";
}

TEST(DayShadow, BelongsToItsGroundAndNoOther) {
    const auto ground = ground_day(Diagonal::falling, 3);
    const std::uint64_t hash = far_day_hash(*ground->field, ground->day.suns, ground->day.params);
    EXPECT_TRUE(is_of_ground(ground->day, hash, *ground->field));
    HeightField other = *ground->field;
    other.height_q16(7, 9) += 1;
    EXPECT_FALSE(is_of_ground(ground->day, hash, other));
    EXPECT_FALSE(is_of_ground(ground->day, hash, mirrored(*ground->field)));
}

TEST(DayShadow, FindsTheSunThatStandsNearest) {
    const auto ground = ground_day(Diagonal::falling, 9);
    const FarSun& s = ground->day.suns[6];
    const auto towards = [](double azimuth, double elevation) {
        const double level = num::cos_deg(elevation);
        return Vec3d{level * num::sin_deg(azimuth), num::sin_deg(elevation), -level * num::cos_deg(azimuth)};
    };
    EXPECT_EQ(nearest_sun(ground->day, towards(s.azimuth_deg, s.elevation_deg)).sun, 6);
    EXPECT_EQ(nearest_sun(ground->day, towards(s.azimuth_deg, s.elevation_deg)).degrees, 0);
    const NearestSun higher = nearest_sun(ground->day, towards(s.azimuth_deg, s.elevation_deg + 0.25));
    EXPECT_EQ(higher.sun, 6);
    EXPECT_NEAR(higher.degrees, 0.25, 1e-9);
    EXPECT_EQ(nearest_sun(FarDay{}, {0, 1, 0}).sun, -1);
}

}  // namespace
}  // namespace obscura
