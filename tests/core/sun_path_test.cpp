// The sun's path: days as long as almanacs say, rise and set to the last bit, steps that add up.

#include "core/sun_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/num.h"

namespace obscura {
namespace {

struct PlaceAndDay {
    const char* name;
    double latitude_deg, longitude_deg, ahead_of_utc_h;
    int month, day;  ///< of 2024
    int hours,
        minutes;  ///< from sunrise to sunset as almanacs count: the disc's upper rim, 34' of refraction
};

SunPath path_of(const PlaceAndDay& p, int steps = 144) {
    return {2024, p.month, p.day, p.ahead_of_utc_h, 0, 24, p.latitude_deg, p.longitude_deg, steps};
}

double sunlit_hours(const SunPath& path) {
    double sum = 0;
    for (const SunSpan& span : sunlit_spans(path))
        sum += span.hours();
    return sum;
}

TEST(SunPath, DaysAreAsLongAsAlmanacsSay) {
    // Whole minutes. Found in tables: December in London and Oslo (Finnish Meteorological Institute), June in
    // London (4:42 to 21:20) and New York (5:24 to 20:30). The others are remembered, not looked up.
    const PlaceAndDay days[] = {
        {"London, June", 51.51, -0.13, 1, 6, 20, 16, 38},
        {"London, December", 51.51, -0.13, 0, 12, 21, 7, 50},
        {"Oslo, June", 59.91, 10.75, 2, 6, 20, 18, 50},
        {"Oslo, December", 59.91, 10.75, 1, 12, 21, 5, 54},
        {"Sydney, December", -33.87, 151.21, 11, 12, 21, 14, 25},
        {"Sydney, June", -33.87, 151.21, 10, 6, 20, 9, 54},
        {"New York, June", 40.71, -74.01, -4, 6, 20, 15, 6},
        {"Quito, June", -0.18, -78.47, -5, 6, 20, 12, 7},
    };
    for (const PlaceAndDay& p : days) {
        // Ours end when the disc's middle does, 16' later at sunrise: twice that at the speed at which the
        // sun crosses the horizon.
        const double declination = p.month == 6 ? 23.44 : -23.44;
        const double cos_hour = -num::sin_deg(p.latitude_deg) / num::cos_deg(p.latitude_deg) *
                                num::sin_deg(declination) / num::cos_deg(declination);
        const double degrees_per_hour = 15 * num::cos_deg(p.latitude_deg) * num::cos_deg(declination) *
                                        std::sqrt(1 - cos_hour * cos_hour);
        const double rim_h = 2 * (16.0 / 60) / degrees_per_hour;
        EXPECT_NEAR(sunlit_hours(path_of(p)) + rim_h, p.hours + p.minutes / 60.0, 1.5 / 60) << p.name;
        EXPECT_LT(rim_h, 7.5 / 60) << p.name;
    }
}

TEST(SunPath, EquinoxesHaveTwelveHoursAndWhatAirAdds) {
    for (const double latitude : {-50.0, -30.0, 0.0, 30.0, 50.0, 60.0}) {
        const double hours = sunlit_hours({2026, 3, 20, 0, 0, 24, latitude, 0, 10});
        EXPECT_NEAR(hours, 12 + 2 * (34.5 / 60) / (15 * num::cos_deg(latitude)), 2.5 / 60) << latitude;
        EXPECT_NEAR(hours, 12, 0.2) << latitude;
    }
}

TEST(SunPath, RiseAndSetAreExact) {
    const SunPath path = path_of({"", 48.2, 16.37, 2, 6, 20, 0, 0});
    const std::vector<SunSpan> spans = sunlit_spans(path);
    ASSERT_EQ(spans.size(), 1u);
    const auto up = [&](double hour) {
        return solar_position(2024, 6, 20, hour - 2, 48.2, 16.37).apparent_elevation_deg > 0;
    };
    EXPECT_FALSE(up(spans[0].from_h));
    EXPECT_TRUE(up(std::nextafter(spans[0].from_h, 24)));
    EXPECT_TRUE(up(spans[0].to_h));
    EXPECT_FALSE(up(std::nextafter(spans[0].to_h, 24)));
}

TEST(SunPath, StepsAddUpAndAreWholeButAtTheEnds) {
    const SunPath path = path_of({"", 48.2, 16.37, 2, 6, 20, 0, 0}, 97);
    const std::vector<SunStep> suns = sun_steps(path);
    ASSERT_GT(suns.size(), 60u);
    double sum = 0;
    for (std::size_t i = 0; i < suns.size(); ++i) {
        sum += suns[i].hours;
        EXPECT_GT(suns[i].elevation_deg, 0);
        if (i == 0) continue;
        EXPECT_GT(suns[i].hour_h, suns[i - 1].hour_h);
        if (i + 1 < suns.size()) {
            EXPECT_NEAR(suns[i].hours, 24.0 / 97, 1e-12);
        }
    }
    EXPECT_NEAR(sum, sunlit_hours(path), 1e-9);
    // A path that lies within the day is all of it.
    SunPath noon = path;
    noon.from_h = 11.25;
    noon.to_h = 14;
    noon.steps = 5;
    EXPECT_EQ(sun_steps(noon).size(), 5u);
    EXPECT_DOUBLE_EQ(sun_steps(noon)[0].hour_h, 11.25 + 0.5 * 2.75 / 5);
    EXPECT_DOUBLE_EQ(sunlit_hours(noon), 2.75);
}

TEST(SunPath, PolarNightsHaveNoSunsAndPolarDaysAllOfThem) {
    const SunPath night{2026, 12, 21, 1, 0, 24, 69.65, 18.96, 48},
        day{2026, 6, 21, 2, 0, 24, 69.65, 18.96, 48};
    EXPECT_TRUE(sunlit_spans(night).empty());
    EXPECT_TRUE(sun_steps(night).empty());
    ASSERT_EQ(sunlit_spans(day).size(), 1u);
    EXPECT_DOUBLE_EQ(sunlit_hours(day), 24);
    EXPECT_EQ(sun_steps(day).size(), 48u);
}

TEST(SunPath, ADayByAnotherClockMayHoldTwoSpans) {
    // Sydney by UTC: the sun sets at 09 h and rises again at 19 h, in one step of two.
    const SunPath path{2026, 12, 21, 0, 0, 24, -33.87, 151.21, 1};
    const std::vector<SunSpan> spans = sunlit_spans(path);
    ASSERT_EQ(spans.size(), 2u);
    EXPECT_EQ(spans[0].from_h, 0);
    EXPECT_EQ(spans[1].to_h, 24);
    EXPECT_EQ(sun_steps(path).size(), 2u);
    SunPath own = path;
    own.ahead_of_utc_h = 11;
    EXPECT_EQ(sunlit_spans(own).size(), 1u);
    EXPECT_NEAR(sunlit_hours(own), sunlit_hours(path), 0.02);
}

TEST(SunPath, StepsByTravelAreCloseWhereShadowsMoveFast) {
    const SunPath path = path_of({"Green River", 38.9, -110.1, -6, 4, 12, 0, 0}, 158);
    const std::vector<SunStep> suns = sun_steps_by_travel(path, 0.5);
    ASSERT_EQ(suns.size(), 158u);
    double hours = 0, longest = 0;
    for (std::size_t i = 0; i < suns.size(); ++i) {
        EXPECT_GT(suns[i].elevation_deg, 0.5);
        EXPECT_GT(suns[i].hours, 0);
        EXPECT_TRUE(i == 0 || suns[i].hour_h > suns[i - 1].hour_h);
        hours += suns[i].hours;
        longest = std::max(longest, suns[i].hours);
    }
    EXPECT_NEAR(hours, sunlit_hours(path), 0.2) << "but for the time below half a degree";
    EXPECT_LT(hours, sunlit_hours(path));
    EXPECT_LT(suns.front().hours, longest / 5);
    EXPECT_LT(suns.back().hours, longest / 5);

    // Equal shares of the root of the tip's way: from one sun to the next, way times time is nearly the same.
    struct Tip {
        double x, y;
    };
    const auto tip = [](const SunStep& s) {
        const double l = num::cos_deg(s.elevation_deg) / num::sin_deg(s.elevation_deg);
        return Tip{l * num::sin_deg(s.azimuth_deg), l * num::cos_deg(s.azimuth_deg)};
    };
    const auto product = [&](std::size_t i) {
        const Tip a = tip(suns[i]), b = tip(suns[i + 1]);
        return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y)) *
               (suns[i + 1].hour_h - suns[i].hour_h);
    };
    for (std::size_t i = 4; i + 5 < suns.size(); ++i)
        EXPECT_NEAR(product(i) / product(79), 1, 0.05) << i;

    EXPECT_TRUE(
        sun_steps_by_travel(path_of({"Tromso, December", 69.65, 18.96, 1, 12, 21, 0, 0}), 0.5).empty());
    const std::vector<SunStep> polar =
        sun_steps_by_travel(path_of({"Pole, June", 90, 0, 0, 6, 21, 0, 0}, 20), 0.5);
    ASSERT_EQ(polar.size(), 20u) << "a day of 24 hours";
    for (const SunStep& s : polar)
        EXPECT_NEAR(s.hours, 1.2, 0.01);
}

}  // namespace
}  // namespace obscura
