#include "core/sun.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

constexpr double degrees_per_radian = 180.0 / num::pi;

/// In [0, 360).
double turned(double deg) {
    const double rest = std::fmod(deg, 360.0);
    const double positive = rest < 0 ? rest + 360.0 : rest;
    return positive < 360.0 ? positive : 0.0;
}

int days_in_month(int year, int month) {
    constexpr int days[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    return days[month - 1] + (month == 2 && leap ? 1 : 0);
}

/// Days from 2000 January 1, 12 h to midnight of the date (Meeus, ch. 7, Gregorian).
double days_since_2000(int year, int month, int day) {
    if (month <= 2) {
        year -= 1;
        month += 12;
    }
    const int century = year / 100;
    const int leap_shift = 2 - century + century / 4;
    const double julian =
        std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + leap_shift - 1524.5;
    return julian - 2451545.0;
}

struct Equatorial {
    double right_ascension_deg, declination_deg;
};

/// Apparent place of the sun (Meeus, ch. 25, lower accuracy); t in Julian centuries from 2000.
Equatorial apparent_place(double t) {
    const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
    const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * num::sin_deg(anomaly) +
                          (0.019993 - t * 0.000101) * num::sin_deg(2 * anomaly) +
                          0.000289 * num::sin_deg(3 * anomaly);

    // Aberration, and nutation by its largest term.
    const double node = 125.04 - 1934.136 * t;
    const double longitude = mean_longitude + centre - 0.00569 - 0.00478 * num::sin_deg(node);
    const double obliquity = 23.0 +
                             (26.0 + (21.448 - t * (46.8150 + t * (0.00059 - t * 0.001813))) / 60.0) / 60.0 +
                             0.00256 * num::cos_deg(node);

    const double sin_longitude = num::sin_deg(longitude);
    return {turned(num::atan2(num::cos_deg(obliquity) * sin_longitude, num::cos_deg(longitude)) *
                   degrees_per_radian),
            num::asin(num::sin_deg(obliquity) * sin_longitude) * degrees_per_radian};
}

}  // namespace

bool is_solar_date(int year, int month, int day) {
    return year >= 1800 && year <= 2200 && month >= 1 && month <= 12 && day >= 1 &&
           day <= days_in_month(year, month);
}

double refraction_deg(double elevation_deg) {
    const double h = std::clamp(elevation_deg, -1.0, 90.0);
    const double angle = h + 10.3 / (h + 5.11);
    return std::max(0.0, 1.02 / 60.0 * num::cos_deg(angle) / num::sin_deg(angle));
}

SunPosition solar_position(int year, int month, int day, double hour_utc, double latitude_deg,
                           double longitude_deg) {
    CHECK(is_solar_date(year, month, day));
    CHECK(std::isfinite(hour_utc) && std::isfinite(longitude_deg) && std::fabs(latitude_deg) <= 90.0);
    const double days = days_since_2000(year, month, day) + hour_utc / 24.0;
    const double centuries = days / 36525.0;
    const Equatorial sun = apparent_place(centuries);

    // Sidereal time (Meeus 12.4) gives the hour angle, west of the meridian positive.
    const double sidereal = 280.46061837 + 360.98564736629 * days + centuries * centuries * 0.000387933;
    const double hour_angle = turned(sidereal + longitude_deg - sun.right_ascension_deg);

    // The direction in the local frame east, north, up (Meeus, ch. 13).
    const double cos_d = num::cos_deg(sun.declination_deg), sin_d = num::sin_deg(sun.declination_deg);
    const double cos_h = num::cos_deg(hour_angle), sin_h = num::sin_deg(hour_angle);
    const double cos_phi = num::cos_deg(latitude_deg), sin_phi = num::sin_deg(latitude_deg);
    const double east = -cos_d * sin_h;
    const double north = sin_d * cos_phi - cos_d * cos_h * sin_phi;
    const double up = sin_d * sin_phi + cos_d * cos_h * cos_phi;

    SunPosition p;
    p.azimuth_deg = turned(num::atan2(east, north) * degrees_per_radian);
    p.elevation_deg = num::atan2(up, std::sqrt(east * east + north * north)) * degrees_per_radian;
    p.apparent_elevation_deg = p.elevation_deg + refraction_deg(p.elevation_deg);
    p.declination_deg = sun.declination_deg;
    p.right_ascension_deg = sun.right_ascension_deg;
    return p;
}

}  // namespace obscura
