#include "raster/heights/profile.h"

#include <algorithm>
#include <cmath>

#include "raster/heights/height_sun.h"

namespace obscura {
namespace {

constexpr double cell = static_cast<double>(cell_q20), per_cell = 1 / cell;

void append(Profile& p, const ProfileLine& line, double from) {
    if (!p.lines.empty() && p.lines.back().is_line_of(line)) return;
    p.lines.push_back({from, line.u0, line.g0, line.slope});
}

/// The same where `line` may begin at or before the last line's own beginning.
void replace(Profile& p, const ProfileLine& line, double from) {
    while (!p.lines.empty() && p.lines.back().from >= from)
        p.lines.pop_back();
    append(p, line, from);
}

/// From (u, g0) on, and to g1 one over per_u further.
ProfileLine line_through(double u, double g0, double g1, double per_u) {
    return {u, u, g0, (g1 - g0) * per_u};
}

/// Of two lines of which b is more than tolerance above a at `last` and not at `u`: the first number at which
/// it is. The quotient is as good as the differences are, and one more step makes up for its own rounding.
double crossing(const ProfileLine& a, const ProfileLine& b, double u, double last, double tolerance) {
    const auto kept = [&](double v) { return a.at(v) - b.at(v) + tolerance; };
    const double at_u = kept(u), at_last = kept(last);
    double c = std::clamp(u + 1 + std::floor((last - u) * (at_u / (at_u - at_last))), u + 1, last);
    if (c - 1 > u && kept(c - 1) < 0) {
        c -= 1;
    } else if (c < last && kept(c) >= 0) {
        c += 1;
    }
    return c;
}

/// Triangles (before j, before j + 1, now j) and (now j, before j + 1, now j + 1): above line `now` rises at
/// most the corner before j + 1.
void strip_along(const std::vector<double>& before, const std::vector<double>& now, const StripParams& s,
                 Profile& out) {
    const double row_u = s.slope_q20, diagonal_u = cell - row_u;
    const double per_row = 1 / row_u, per_diagonal = 1 / diagonal_u;
    for (std::size_t j = 0; j + 1 < now.size(); ++j) {
        const double u = s.first_u + cell * static_cast<double>(j);
        const double left = now[j], right = now[j + 1], corner = before[j + 1];
        if (corner * cell > left * row_u + right * diagonal_u) {
            if (diagonal_u > 0) append(out, line_through(u, left, corner, per_diagonal), u);
            if (row_u > 0) append(out, line_through(u + diagonal_u, corner, right, per_row), u + diagonal_u);
        } else {
            append(out, line_through(u, left, right, per_cell), u);
        }
    }
}

/// Joins a line that begins at `start` and ends at or above what the strip so far ends with, at u.
void join(const ProfileLine& first, double start, double u, double tolerance, Profile& out) {
    double from = start;
    if (!out.lines.empty() && out.lines.back().at(start) - first.at(start) + tolerance >= 0) {
        const ProfileLine& last = out.lines.back();
        const bool rises = start < u && last.at(u) - first.at(u) + tolerance < 0;
        from = rises ? crossing(last, first, start, u, tolerance) : u;
    }
    replace(out, first, from);
}

/// Triangles (before j, now j, now j + 1) and (before j, before j + 1, now j + 1): the first one's upper
/// side, from before j over now j, or straight, to now j + 1. Each begins where the one before it has not
/// ended yet, which ends in now j. What the last row adds is its own edge alone.
void strip_across(const std::vector<double>& before, const std::vector<double>& now, const StripParams& s,
                  Profile& out) {
    const double row_u = s.slope_q20, diagonal_u = cell + row_u;
    const double per_row = 1 / row_u, per_diagonal = 1 / diagonal_u;
    for (std::size_t j = 0; j < now.size(); ++j) {
        const double u = s.first_u + cell * static_cast<double>(j), start = u - row_u;
        const bool last = j + 1 == now.size();
        const bool over = last || now[j] * diagonal_u > before[j] * cell + now[j + 1] * row_u;
        if (!over) {
            join(line_through(start, before[j], now[j + 1], per_diagonal), start, u, s.tolerance_m, out);
            continue;
        }
        if (row_u > 0) join(line_through(start, before[j], now[j], per_row), start, u, s.tolerance_m, out);
        if (!last) replace(out, line_through(u, now[j], now[j + 1], per_cell), u);
    }
}

}  // namespace

void line_profile(const std::vector<double>& now, double first_u, Profile& line) {
    line.lines.clear();
    for (std::size_t j = 0; j + 1 < now.size(); ++j) {
        const double u = first_u + cell * static_cast<double>(j);
        append(line, line_through(u, now[j], now[j + 1], per_cell), u);
    }
    line.end = first_u + cell * static_cast<double>(now.size() - 1);
}

void strip_profile(const std::vector<double>& before, const std::vector<double>& now,
                   const StripParams& params, Profile& strip) {
    strip.lines.clear();
    if (params.crossed_diagonals) {
        strip_across(before, now, params, strip);
    } else {
        strip_along(before, now, params, strip);
    }
    strip.end = params.first_u + cell * static_cast<double>(now.size() - 1);
}

void upper_envelope(const Profile& far, const Profile& strip, double begin, double tolerance_m,
                    Profile& out) {
    const ProfileLine *a = far.lines.data(), *b = strip.lines.data();
    const ProfileLine *a_last = a + far.lines.size() - 1, *b_last = b + strip.lines.size() - 1;
    while (a != a_last && a[1].from <= begin)
        ++a;
    while (b != b_last && b[1].from <= begin)
        ++b;
    out.lines.clear();
    // Between two beginnings of lines there is one crossing at most.
    out.lines.reserve(2 * (far.lines.size() + strip.lines.size()) + 2);
    out.end = strip.end;
    const ProfileLine* latest = nullptr;
    const auto put = [&](const ProfileLine* line, double from) {
        if (line == latest) return;
        latest = line;
        out.lines.push_back({from, line->u0, line->g0, line->slope});
    };
    double u = begin;
    while (u <= far.end && u <= strip.end) {
        // Both are straight from u to last.
        const double a_end = a != a_last ? a[1].from - 1 : far.end,
                     b_end = b != b_last ? b[1].from - 1 : strip.end;
        const double last = std::min(a_end, b_end);
        const bool far_first = a->at(u) - b->at(u) + tolerance_m >= 0;
        const bool far_last = a->at(last) - b->at(last) + tolerance_m >= 0;
        put(far_first ? a : b, u);
        if (far_first && !far_last) put(b, crossing(*a, *b, u, last, tolerance_m));
        if (!far_first && far_last) put(a, crossing(*b, *a, u, last, -tolerance_m));
        a += a_end == last && a != a_last ? 1 : 0;
        b += b_end == last && b != b_last ? 1 : 0;
        u = last + 1;
    }
    // Where the far profile has ended, the strip is alone.
    for (; u <= strip.end; ++b) {
        put(b, u);
        u = b != b_last ? b[1].from : strip.end + 1;
    }
}

}  // namespace obscura
