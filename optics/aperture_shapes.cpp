// Outlines are built around the origin with the diameter's half as unit-free radius in texels, then turned
// and moved to the mask's centre. Loops that turn from x towards y open, others close (see Outline).

#include "optics/aperture_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/num.h"
#include "optics/outline_coverage.h"

namespace obscura {
namespace {

using Loop = std::vector<Vec2d>;

constexpr double sagitta = 1e-6;  ///< texels between a curve and its chords
constexpr double degree = num::pi / 180;

/// Parts that a curve over a parameter in [0, 1] is cut into: a chord over 1/n of it is off by at most
/// |second derivative| / (8 n^2).
int chords(double second_derivative) {
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(second_derivative / (8 * sagitta)))));
}

Vec2d polar(double radius, double angle_deg) {
    return {radius * num::cos_deg(angle_deg), radius * num::sin_deg(angle_deg)};
}

/// Appends a spiral from one radius and angle to others, both linear in the parameter; an arc when the radii
/// are equal. The last point is left to whatever follows.
void append_spiral(Loop& loop, Vec2d centre, double r0, double r1, double from_deg, double to_deg) {
    const double turn = std::fabs(to_deg - from_deg) * degree;
    const int n = chords(std::max(r0, r1) * turn * turn + 2 * std::fabs(r1 - r0) * turn);
    for (int i = 0; i < n; ++i) {
        const double t = static_cast<double>(i) / n;
        loop.push_back(centre + polar(r0 + (r1 - r0) * t, from_deg + (to_deg - from_deg) * t));
    }
}

Loop circle_loop(double radius) {
    Loop loop;
    append_spiral(loop, {}, radius, radius, 0, 360);
    return loop;
}

Loop rectangle(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// The hole that a loop would fill.
Loop reversed(Loop loop) {
    std::reverse(loop.begin(), loop.end());
    return loop;
}

Loop turned(Loop loop, double angle_deg) {
    const Vec2d axis = polar(1, angle_deg);
    for (Vec2d& p : loop)
        p = {p.x * axis.x - p.y * axis.y, p.x * axis.y + p.y * axis.x};
    return loop;
}

/// Edges between corners on the circle; a bowed one is an arc of radius radius / bow.
Loop iris(const ApertureShape& shape, double radius) {
    Loop loop;
    const double turn = 360.0 / shape.blades;
    for (int k = 0; k < shape.blades; ++k) {
        const double corner = turn * k - 90;
        if (shape.bow == 0) {
            loop.push_back(polar(radius, corner));
            continue;
        }
        const double bow_radius = radius / shape.bow;
        const double half_deg = num::asin(shape.bow * num::sin_deg(turn / 2)) / degree;
        const double middle = corner + turn / 2;
        const double back = bow_radius * num::cos_deg(half_deg) - radius * num::cos_deg(turn / 2);
        append_spiral(loop, polar(-back, middle), bow_radius, bow_radius, middle - half_deg,
                      middle + half_deg);
    }
    return loop;
}

/// One contour: out along a blade's spiral, along the rim, in along the next spiral, along the hub.
Loop whirl(const ApertureShape& shape, double radius) {
    Loop loop;
    const double hub = radius * shape.hub, turn = 360.0 / shape.blades;
    const double open = turn * shape.blade;
    for (int k = 0; k < shape.blades; ++k) {
        const double from = turn * k - 90, rim = from + shape.twist_deg;
        append_spiral(loop, {}, hub, radius, from, rim);
        append_spiral(loop, {}, radius, radius, rim, rim + open);
        append_spiral(loop, {}, radius, hub, rim + open, from + open);
        append_spiral(loop, {}, hub, hub, from + open, from + turn);
    }
    return loop;
}

/// Vanes reach from the centre to beyond the rim: what they close twice stays closed.
std::vector<Loop> annulus(const ApertureShape& shape, double radius) {
    std::vector<Loop> loops{circle_loop(radius)};
    if (shape.obstruction > 0) loops.push_back(reversed(circle_loop(radius * shape.obstruction)));
    const double half = shape.vane_width * radius;
    for (int k = 0; k < shape.vanes; ++k) {
        const double angle = shape.vane_angle_deg + 360.0 * k / shape.vanes;
        loops.push_back(reversed(turned(rectangle(0, -half, 2 * radius, half), angle)));
    }
    return loops;
}

/// `count` bars as high as the diameter.
std::vector<Loop> bars(int count, double step, double width, double radius) {
    std::vector<Loop> loops;
    for (int k = 0; k < count; ++k) {
        const double x = (k - 0.5 * (count - 1)) * step;
        loops.push_back(rectangle(x - width / 2, -radius, x + width / 2, radius));
    }
    return loops;
}

/// Centres lie on a triangular lattice of spacing d, and the outermost corners, at
/// ((rings + 1/2) d - gap / 2, (d - gap) / sqrt(12)) from the middle, on the circle: a quadratic in d.
std::vector<Loop> hexagons(const ApertureShape& shape, double radius) {
    const double gap = shape.gap * 2 * radius, reach = shape.rings + 0.5;
    const double a = reach * reach + 1.0 / 12, b = -gap * (reach + 1.0 / 6);
    const double c = gap * gap / 3 - radius * radius;
    const double spacing = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
    const double corner = (spacing - gap) / std::sqrt(3.0);
    std::vector<Loop> loops;
    for (int q = -shape.rings; q <= shape.rings; ++q) {
        for (int r = -shape.rings; r <= shape.rings; ++r) {
            if (std::abs(q + r) > shape.rings || (q == 0 && r == 0 && !shape.middle)) continue;
            const Vec2d centre{spacing * 0.5 * std::sqrt(3.0) * q, spacing * (r + 0.5 * q)};
            Loop loop;
            for (int k = 0; k < 6; ++k)
                loop.push_back(centre + polar(corner, 60.0 * k));
            loops.push_back(std::move(loop));
        }
    }
    return loops;
}

void require(bool good, const char* name, double value, const char* range) {
    if (good) return;
    throw InputError("aperture", fmt::format("{} is {}, must be {}", name, value, range));
}

void check_common(const ApertureShape& s) {
    require(s.diameter > 0 && s.diameter <= 2, "diameter", s.diameter, "above 0 and at most 2");
    require(std::fabs(s.rotation_deg) <= 36000, "rotation_deg", s.rotation_deg, "within -36000 to 36000");
    require(std::fabs(s.offset_x) <= 2, "offset_x", s.offset_x, "within -2 to 2");
    require(std::fabs(s.offset_y) <= 2, "offset_y", s.offset_y, "within -2 to 2");
}

/// Only what the kind uses.
void check_parameters(const ApertureShape& s) {
    const auto in = [](double v, double low, double high) { return v >= low && v <= high; };
    const auto inside = [](double v) { return v > 0 && v < 1; };
    check_common(s);
    switch (s.kind) {
        case ApertureKind::circle:
            break;
        case ApertureKind::iris:
            require(in(s.blades, 3, 64), "blades", s.blades, "3 to 64");
            require(in(s.bow, 0, 1), "bow", s.bow, "0 to 1");
            break;
        case ApertureKind::box:
            require(in(s.aspect, 1.0 / 64, 64), "aspect", s.aspect, "1/64 to 64");
            break;
        case ApertureKind::whirl:
            require(in(s.blades, 3, 64), "blades", s.blades, "3 to 64");
            require(inside(s.hub), "hub", s.hub, "between 0 and 1");
            require(inside(s.blade), "blade", s.blade, "between 0 and 1");
            require(in(s.twist_deg, -360, 360), "twist_deg", s.twist_deg, "-360 to 360");
            break;
        case ApertureKind::annulus:
            require(in(s.obstruction, 0, 1) && s.obstruction < 1, "obstruction", s.obstruction,
                    "at least 0 and below 1");
            require(in(s.vanes, 0, 64), "vanes", s.vanes, "0 to 64");
            require(inside(s.vane_width), "vane_width", s.vane_width, "between 0 and 1");
            require(in(s.vane_angle_deg, -3600, 3600), "vane_angle_deg", s.vane_angle_deg, "-3600 to 3600");
            break;
        case ApertureKind::slit:
            require(in(s.slits, 1, 1024), "slits", s.slits, "1 to 1024");
            require(s.slit_width > 0 && s.slit_width <= 1, "slit_width", s.slit_width,
                    "above 0 and at most 1");
            require(s.slit_step > 0 && s.slit_step <= 1, "slit_step", s.slit_step, "above 0 and at most 1");
            break;
        case ApertureKind::grating:
            require(in(s.lines, 1, 4096), "lines", s.lines, "1 to 4096");
            require(inside(s.duty), "duty", s.duty, "between 0 and 1");
            break;
        case ApertureKind::hexagons:
            require(in(s.rings, 1, 32), "rings", s.rings, "1 to 32");
            require(in(s.gap, 0, 0.5 / (2 * s.rings + 1)), "gap", s.gap, "0 to half a segment's width");
            break;
    }
}

/// Around the origin, not yet turned.
std::vector<Loop> loops_of(const ApertureShape& s, double radius) {
    const double diameter = 2 * radius;
    switch (s.kind) {
        case ApertureKind::iris:
            return {iris(s, radius)};
        case ApertureKind::circle:
            return {circle_loop(radius)};
        case ApertureKind::box:
            return {rectangle(-radius, -radius * s.aspect, radius, radius * s.aspect)};
        case ApertureKind::whirl:
            return {whirl(s, radius)};
        case ApertureKind::annulus:
            return annulus(s, radius);
        case ApertureKind::slit:
            return bars(s.slits, s.slit_step * diameter, s.slit_width * diameter, radius);
        case ApertureKind::grating:
            return bars(s.lines, diameter / s.lines, diameter / s.lines * s.duty, radius);
        case ApertureKind::hexagons:
            return hexagons(s, radius);
    }
    CHECK(false, "no such aperture");
    return {};
}

/// No two loops cross or overlap.
bool is_disjoint(const ApertureShape& s) {
    if (s.kind == ApertureKind::annulus) return s.vanes == 0;
    if (s.kind == ApertureKind::slit) return s.slits == 1 || s.slit_step >= s.slit_width;
    return true;
}

}  // namespace

const char* aperture_kind_name(ApertureKind kind) {
    constexpr const char* names[] = {"iris",    "circle", "box",     "whirl",
                                     "annulus", "slit",   "grating", "hexagons"};
    return names[static_cast<int>(kind)];
}

ApertureShape paper_aperture(ApertureKind kind) {
    ApertureShape shape;
    shape.kind = kind;
    if (kind == ApertureKind::box) {
        // On the grid up to 512 texels (rounded), one texel off at 1024, two at 2048.
        constexpr double off_grid = 0.85 / 1024;
        shape.diameter = 0.5625 + off_grid;
        shape.offset_x = shape.offset_y = 0.5 * off_grid;
    } else if (kind == ApertureKind::circle) {
        shape.diameter = 0.485;
    } else if (kind == ApertureKind::iris) {
        shape.diameter = 0.75;
        shape.rotation_deg = 5;
    } else {
        CHECK(kind == ApertureKind::whirl, "one of the four");
        shape.diameter = 0.63;
        shape.blades = 5;
        shape.hub = 0.3;
        shape.twist_deg = 45;
    }
    return shape;
}

Outline outline_of(const ApertureShape& shape, int size) {
    check_parameters(shape);
    Outline outline;
    outline.disjoint = is_disjoint(shape);
    outline.loops = loops_of(shape, 0.5 * shape.diameter * size);
    const Vec2d centre{(0.5 + shape.offset_x) * size, (0.5 + shape.offset_y) * size};
    for (Loop& loop : outline.loops) {
        loop = turned(std::move(loop), shape.rotation_deg);
        for (Vec2d& p : loop)
            p = p + centre;
    }
    return outline;
}

Aperture make_aperture(const ApertureShape& shape, int size, double diameter_m) {
    require(size >= 1 && size <= 32768, "size", size, "1 to 32768");
    require(std::isfinite(diameter_m) && diameter_m > 0, "diameter in metres", diameter_m, "positive");
    Aperture aperture;
    aperture.outline = outline_of(shape, size);
    aperture.mask = coverage_of(aperture.outline, size, size);
    aperture.pitch_m = diameter_m / (shape.diameter * size);
    return aperture;
}

}  // namespace obscura
