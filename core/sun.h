#pragma once
// Where the sun stands, from date, time and place.

namespace obscura {

/// Angles in degrees.
struct SunPosition {
    double azimuth_deg = 0;             ///< clockwise from true north, in [0, 360)
    double elevation_deg = 0;           ///< of the disc's centre above the horizon, without air
    double apparent_elevation_deg = 0;  ///< the same as seen through standard air (1010 hPa, 10 C)
    double declination_deg = 0;         ///< apparent place, equator of date
    double right_ascension_deg = 0;     ///< apparent place, in [0, 360)
};

/// A day of the Gregorian calendar, years 1800 to 2200.
bool is_solar_date(int year, int month, int day);

/// Position of the sun. Date and hour_utc in UTC, any finite hour_utc (24.5 is half past midnight of the next
/// day); latitude_deg in [-90, 90], north positive; longitude_deg east positive, any finite value.
/// Within 0.01 degrees of the almanac from 1950 to 2050. Needs is_solar_date().
/// Source: Meeus, "Astronomical Algorithms", 2nd ed. 1998, ch. 12, 13, 16, 25 (the formulas of NOAA's solar
/// calculator); UTC is taken for UT1 and TT, parallax (< 0.003 deg) is left out.
SunPosition solar_position(int year, int month, int day, double hour_utc, double latitude_deg,
                           double longitude_deg);

/// Lift of a body at this airless elevation by standard air, in degrees: Saemundsson's formula (Meeus 16.4);
/// below -1 degree, where it does not hold and nothing is seen, the value at -1.
double refraction_deg(double elevation_deg);

}  // namespace obscura
