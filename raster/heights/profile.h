#pragma once
// Upper profiles of the ground as seen from the sun: the floating horizon.
//
// Seen along the sun's rays, a sample stands at u = row + slope * line and g = height + rise * line: what
// lies on one ray has one u, and whoever has more g than what lies nearer the sun is lit. So lines nearer the
// sun leave behind them one function of u, the highest of their g, which never moves, and to which each
// further line and the triangles that join it to the one before are added (Anderson, "Hidden line elimination
// in projected grid surfaces", 1982, does so for pictures).
//
// A profile is asked at samples alone, whose u are multiples of 2^-20 cells. So u are whole numbers in these
// units, and a profile is a row of lines, each from one such number on: where two lines cross between two
// numbers is of no account.

#include <vector>

namespace obscura {

/// A line that holds from u = `from` on: g = g0 + slope (u - u0). All u are whole and below 2^42, so exact.
struct ProfileLine {
    double from = 0, u0 = 0, g0 = 0, slope = 0;

    double at(double u) const { return g0 + slope * (u - u0); }
    bool is_line_of(const ProfileLine& o) const { return u0 == o.u0 && g0 == o.g0 && slope == o.slope; }
};

/// Lines in the order of `from`, the last up to `end` inclusive. Never empty once it has been made.
struct Profile {
    std::vector<ProfileLine> lines;
    double end = 0;
};

/// What a line of samples adds, with the triangles towards the line before.
struct StripParams {
    double slope_q20 = 0;            ///< u of this line's row 0 less that of the line before
    double first_u = 0;              ///< of this line's row 0
    bool crossed_diagonals = false;  ///< as SunView has them
    double tolerance_m = 0;          ///< less than this is no difference in g
};

/// The upper profile of the strip between two lines of samples: `before`, nearer the sun, and `now`, of the
/// same length of two or more, as g. Above `before` itself it holds only what is above it, so the profile of
/// the lines so far has to be joined with it.
void strip_profile(const std::vector<double>& before, const std::vector<double>& now,
                   const StripParams& params, Profile& strip);

/// The profile of a line of samples by itself.
void line_profile(const std::vector<double>& now, double first_u, Profile& line);

/// The higher of two profiles from u = begin to the strip's end, where `far` may end before. The same where
/// they differ by less than tolerance_m: `far`.
void upper_envelope(const Profile& far, const Profile& strip, double begin, double tolerance_m, Profile& out);

}  // namespace obscura
