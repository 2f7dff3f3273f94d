// The sun against published positions: the worked examples of Meeus and of NREL's SPA report, and what
// geometry demands at solstices, equinoxes, the horizon and the date line.

#include "core/sun.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/num.h"

namespace obscura {
namespace {

struct Noon {
    double elevation_deg = -90, azimuth_deg = 0;
};

/// Highest point within six hours of local noon, by minutes.
Noon culmination(int year, int month, int day, double latitude_deg, double longitude_deg) {
    Noon best;
    for (int minute = -360; minute <= 360; ++minute) {
        const double hour = 12 - longitude_deg / 15 + minute / 60.0;
        const SunPosition p = solar_position(year, month, day, hour, latitude_deg, longitude_deg);
        if (p.elevation_deg > best.elevation_deg) best = {p.elevation_deg, p.azimuth_deg};
    }
    return best;
}

TEST(Sun, MeeusExample25a) {
    // 1992 October 13, 0 h: apparent right ascension 13h 13m 31.4s, declination -7 deg 47' 06".
    const SunPosition p = solar_position(1992, 10, 13, 0.0, 0.0, 0.0);
    EXPECT_NEAR(p.right_ascension_deg, (13 + 13 / 60.0 + 31.4 / 3600.0) * 15, 0.001);
    EXPECT_NEAR(p.declination_deg, -(7 + 47 / 60.0 + 6 / 3600.0), 0.001);
}

TEST(Sun, SolsticeDeclinationIsTheTrueObliquity) {
    // Meeus, example 22.a: 1987 April 10, true obliquity 23 deg 26' 36.85"; by June nutation adds 0.1", and
    // the slow decrease takes as much.
    double highest = 0;
    for (int hour = 0; hour < 96; ++hour) {
        highest = std::max(highest, solar_position(1987, 6, 20, hour, 0, 0).declination_deg);
    }
    EXPECT_NEAR(highest, 23 + 26 / 60.0 + 36.85 / 3600, 0.0005);
}

TEST(Sun, ExampleOfNrelReport) {
    // Reda and Andreas, "Solar Position Algorithm", NREL/TP-560-34302, appendix A.5: Golden, 2003 October 17,
    // 12:30:30 local time (UTC - 7): azimuth 194.340241 deg, zenith 50.111622 deg with refraction at 820 hPa.
    const SunPosition p = solar_position(2003, 10, 17, 19 + 30.5 / 60.0, 39.742476, -105.1786);
    EXPECT_NEAR(p.azimuth_deg, 194.340241, 0.02);
    EXPECT_NEAR(p.apparent_elevation_deg, 90 - 50.111622, 0.02);
    EXPECT_NEAR(p.declination_deg, -9.31434, 0.005);
}

TEST(Sun, NoonHeightsOfSolsticesAndEquinoxes) {
    constexpr double greenwich = 51.4769, obliquity = 23.436;
    EXPECT_NEAR(culmination(2024, 6, 20, greenwich, 0).elevation_deg, 90 - greenwich + obliquity, 0.02);
    EXPECT_NEAR(culmination(2024, 12, 21, greenwich, 0).elevation_deg, 90 - greenwich - obliquity, 0.02);
    // The equinox was at 03:06 on 20 March; the declination grows by 0.016 degrees an hour.
    EXPECT_NEAR(culmination(2024, 3, 20, greenwich, 0).elevation_deg, 90 - greenwich + 0.147, 0.02);
    EXPECT_NEAR(culmination(2024, 6, 20, greenwich, 0).azimuth_deg, 180, 0.5);
}

TEST(Sun, SouthOfTheTropicsItStandsNorthAtNoon) {
    constexpr double sydney = -33.8688;
    const Noon noon = culmination(2024, 12, 21, sydney, 151.2093);
    EXPECT_NEAR(noon.elevation_deg, 90 + sydney + 23.436, 0.02);
    EXPECT_LT(std::fabs(std::remainder(noon.azimuth_deg, 360.0)), 1.5);
    EXPECT_NEAR(culmination(2024, 6, 20, sydney, 151.2093).elevation_deg, 90 + sydney - 23.436, 0.02);
}

TEST(Sun, SunriseAzimuthFollowsFromTheDeclination) {
    // On the horizon cos(azimuth) = sin(declination) / cos(latitude).
    for (const double latitude : {-60.0, -20.0, 0.0, 45.0, 60.0}) {
        SunPosition before;
        bool found = false;
        for (int minute = -180; minute < 720 && !found; ++minute) {
            const SunPosition p = solar_position(2024, 6, 20, minute / 60.0, latitude, 0);
            if (minute > -180 && before.elevation_deg < 0 && p.elevation_deg >= 0) {
                const double expected =
                    num::acos(num::sin_deg(p.declination_deg) / num::cos_deg(latitude)) * 180 / num::pi;
                EXPECT_NEAR(p.azimuth_deg, expected, 0.5) << latitude;
                found = true;
            }
            before = p;
        }
        EXPECT_TRUE(found) << latitude;
    }
}

TEST(Sun, DateLineAndMidnightAreNoSeams) {
    const SunPosition west = solar_position(2026, 3, 1, 3.25, -17.7, -180.0);
    const SunPosition east = solar_position(2026, 3, 1, 3.25, -17.7, 180.0);
    EXPECT_NEAR(west.azimuth_deg, east.azimuth_deg, 1e-9);
    EXPECT_NEAR(west.elevation_deg, east.elevation_deg, 1e-9);

    // Hour 24 of a day is hour 0 of the next, over the ends of February and of a year too.
    const int days[][6] = {{2024, 2, 28, 2024, 2, 29}, {2024, 2, 29, 2024, 3, 1},  {2023, 2, 28, 2023, 3, 1},
                           {1900, 2, 28, 1900, 3, 1},  {2024, 12, 31, 2025, 1, 1}, {2000, 6, 30, 2000, 7, 1}};
    for (const auto& d : days) {
        const SunPosition late = solar_position(d[0], d[1], d[2], 24 + 9.5, 48, 11);
        const SunPosition early = solar_position(d[3], d[4], d[5], 9.5, 48, 11);
        EXPECT_NEAR(late.azimuth_deg, early.azimuth_deg, 1e-6) << d[0] << '-' << d[1] << '-' << d[2];
        EXPECT_NEAR(late.elevation_deg, early.elevation_deg, 1e-6);
    }
}

TEST(Sun, PolesSeeItCircleAtItsDeclination) {
    for (const double hour : {0.0, 5.0, 13.0, 21.0}) {
        const SunPosition p = solar_position(2024, 6, 20, hour, 90, 0);
        EXPECT_NEAR(p.elevation_deg, p.declination_deg, 1e-9);
        EXPECT_LT(solar_position(2024, 6, 20, hour, -90, 0).elevation_deg, -23);
    }
}

TEST(Sun, RefractionLiftsTheHorizonByHalfADegree) {
    // Meeus, ch. 16: about 29' at the horizon of an airless body, 1' at 45 degrees, nothing overhead.
    EXPECT_NEAR(refraction_deg(0.0), 29.0 / 60, 0.5 / 60);
    EXPECT_NEAR(refraction_deg(45.0), 1.0 / 60, 0.05 / 60);
    EXPECT_NEAR(refraction_deg(90.0), 0.0, 0.002);
    EXPECT_EQ(refraction_deg(-30.0), refraction_deg(-1.0));
    for (int tenth = -9; tenth < 900; ++tenth)
        EXPECT_GE(refraction_deg(tenth / 10.0), refraction_deg(tenth / 10.0 + 0.1));
}

TEST(Sun, KnowsTheCalendar) {
    EXPECT_TRUE(is_solar_date(2024, 2, 29));
    EXPECT_TRUE(is_solar_date(2000, 2, 29));
    EXPECT_FALSE(is_solar_date(1900, 2, 29));
    EXPECT_FALSE(is_solar_date(2023, 2, 29));
    EXPECT_FALSE(is_solar_date(2024, 4, 31));
    EXPECT_FALSE(is_solar_date(2024, 13, 1));
    EXPECT_FALSE(is_solar_date(2024, 0, 1));
    EXPECT_FALSE(is_solar_date(2024, 1, 0));
    EXPECT_FALSE(is_solar_date(1700, 1, 1));
}

}  // namespace
}  // namespace obscura
