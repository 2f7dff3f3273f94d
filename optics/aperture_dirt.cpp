// Whatever has an edge is a loop that closes (see Outline) over an open square: the winding number counts how
// often a point is hidden, so overlaps hide once, and coverage is exact. Noise and soft dust multiply that.

#include "optics/aperture_dirt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/num.h"
#include "optics/outline_coverage.h"
#include "optics/perlin_noise.h"

namespace obscura {
namespace {

using Loop = std::vector<Vec2d>;

enum Stream : std::uint32_t { noise_stream, dust_stream, scratch_stream, eyelash_stream };

/// The square that shares refer to: as large as the mask's longer side, around its middle.
struct Square {
    Vec2d corner;
    double side = 0;
    Vec2d at(double x, double y) const { return {corner.x + x * side, corner.y + y * side}; }
};

Square square_of(int width, int height) {
    const double side = std::max(width, height);
    return {{0.5 * (width - side), 0.5 * (height - side)}, side};
}

void require(bool good, const char* name, double value, const char* range) {
    if (good) return;
    throw InputError("aperture", fmt::format("{} is {}, must be {}", name, value, range));
}

void check(const LensDirt& d) {
    const auto in = [](double v, double low, double high) { return v >= low && v <= high; };
    const auto above = [](double v, double high) { return v > 0 && v <= high; };
    require(d.seed >= 0 && d.seed < (std::int64_t{1} << 32), "seed", static_cast<double>(d.seed),
            "0 to 2^32 - 1");
    require(in(d.noise, 0, 1), "noise", d.noise, "0 to 1");
    require(in(d.noise_cell, 1.0 / 1024, 1), "noise_cell", d.noise_cell, "1/1024 to 1");
    require(in(d.noise_stretch, 1, 64), "noise_stretch", d.noise_stretch, "1 to 64");
    require(in(d.noise_angle_deg, -36000, 36000), "noise_angle_deg", d.noise_angle_deg, "-36000 to 36000");
    require(in(d.dust, 0, 10000), "dust", d.dust, "0 to 10000");
    require(above(d.dust_radius, 0.5), "dust_radius", d.dust_radius, "above 0 and at most 0.5");
    require(in(d.dust_softness, 0, 1), "dust_softness", d.dust_softness, "0 to 1");
    require(in(d.scratches, 0, 10000), "scratches", d.scratches, "0 to 10000");
    require(above(d.scratch_width, 0.1), "scratch_width", d.scratch_width, "above 0 and at most 0.1");
    require(above(d.scratch_length, 2), "scratch_length", d.scratch_length, "above 0 and at most 2");
    require(in(d.scratch_spread_deg, 0, 180), "scratch_spread_deg", d.scratch_spread_deg, "0 to 180");
    require(in(d.eyelashes, 0, 1000), "eyelashes", d.eyelashes, "0 to 1000");
    require(above(d.eyelash_width, 0.1), "eyelash_width", d.eyelash_width, "above 0 and at most 0.1");
    require(above(d.eyelash_length, 2), "eyelash_length", d.eyelash_length, "above 0 and at most 2");
    require(above(d.occluder_diameter, 4), "occluder_diameter", d.occluder_diameter, "above 0 and at most 4");
    require(in(d.occluder_x, -2, 2), "occluder_x", d.occluder_x, "-2 to 2");
    require(in(d.occluder_y, -2, 2), "occluder_y", d.occluder_y, "-2 to 2");
}

/// Opens; chords at most 1e-4 texel from the circle.
Loop circle_loop(Vec2d centre, double radius) {
    const int n = std::max(12, static_cast<int>(std::ceil(num::pi * std::sqrt(radius / 2e-4))));
    Loop loop;
    for (int k = 0; k < n; ++k) {
        const double angle = 360.0 * k / n;
        loop.push_back({centre.x + radius * num::cos_deg(angle), centre.y + radius * num::sin_deg(angle)});
    }
    return loop;
}

Loop closing(Loop loop) {
    std::reverse(loop.begin(), loop.end());
    return loop;
}

/// A curve with a width, closing: half_width(t) to both sides of a quadratic Bezier curve, t in [0, 1].
template <class HalfWidth>
Loop band(Vec2d from, Vec2d control, Vec2d to, HalfWidth&& half_width) {
    constexpr int parts = 32;
    Loop left, right;
    for (int k = 0; k <= parts; ++k) {
        const double t = static_cast<double>(k) / parts, s = 1 - t;
        const Vec2d p = from * (s * s) + control * (2 * s * t) + to * (t * t);
        const Vec2d along = (control - from) * s + (to - control) * t;
        const double scale = half_width(t) / std::sqrt(along.x * along.x + along.y * along.y);
        const Vec2d aside{-along.y * scale, along.x * scale};
        left.push_back(p - aside);
        right.push_back(p + aside);
    }
    left.insert(left.end(), right.rbegin(), right.rend());
    return closing(std::move(left));
}

struct Grain {
    Vec2d centre;
    double radius = 0;
};

/// Few large grains, many small ones.
Grain grain_of(const LensDirt& d, const Square& square, int k) {
    ItemRandom random{static_cast<std::uint32_t>(k), dust_stream, static_cast<std::uint32_t>(d.seed)};
    const double x = random.next(), y = random.next(), size = random.next();
    return {square.at(x, y), square.side * d.dust_radius * (0.15 + 0.85 * size * size * size)};
}

/// Widest in the middle, pointed at both ends, bent by up to a tenth of its length.
Loop scratch_loop(const LensDirt& d, const Square& square, int k) {
    ItemRandom random{static_cast<std::uint32_t>(k), scratch_stream, static_cast<std::uint32_t>(d.seed)};
    const double x = random.next(), y = random.next();
    const Vec2d middle = square.at(x, y);
    const double angle = 90 + (random.next() - 0.5) * d.scratch_spread_deg;
    const double length = square.side * d.scratch_length * (0.2 + 0.8 * random.next());
    const double half_width = 0.5 * square.side * d.scratch_width * (0.4 + 0.6 * random.next());
    const double bend = 0.2 * length * (random.next() - 0.5);
    const Vec2d along{num::cos_deg(angle), num::sin_deg(angle)}, aside{-along.y, along.x};
    return band(middle - along * (0.5 * length), middle + aside * bend, middle + along * (0.5 * length),
                [&](double t) { return half_width * 4 * t * (1 - t); });
}

/// Roots stand along the upper side, a little unevenly; tips fan out to both sides, hang in a bow, and lean
/// towards each other in threes.
Loop eyelash_loop(const LensDirt& d, const Square& square, int k) {
    ItemRandom random{static_cast<std::uint32_t>(k), eyelash_stream, static_cast<std::uint32_t>(d.seed)};
    const double place = (k + 0.5 + 0.9 * (random.next() - 0.5)) / d.eyelashes;
    const int first_of_three = k / 3 * 3;
    const double clump = std::min(1.0, (first_of_three + 1.5) / d.eyelashes);
    const double side = 2 * place - 1;  // -1 left, 1 right
    // The lid is an arc: lower at the sides. Roots lie on the border or beyond.
    const Vec2d root = square.at(place, -0.06 + 0.06 * side * side);
    const double length = square.side * d.eyelash_length * (0.4 + 0.6 * random.next());
    const double lean = 30 * side + 12 * (random.next() - 0.5);  // of the tip, from straight down
    const double bow = 0.25 * side + 0.3 * (random.next() - 0.5);
    const double half_width = 0.5 * square.side * d.eyelash_width * (0.7 + 0.3 * random.next());
    const Vec2d down{num::sin_deg(lean), num::cos_deg(lean)}, aside{-down.y, down.x};
    const Vec2d tip = root + down * length + Vec2d{0.7 * (clump - place) * square.side, 0};
    return band(root, root + down * (0.5 * length) + aside * (bow * 0.5 * length), tip,
                [&](double t) { return half_width * (1 - 0.9 * t * t); });
}

/// Everything with an edge.
Outline outline_on(const LensDirt& d, const Square& square) {
    Outline outline;
    const Vec2d a = square.corner - Vec2d{1, 1}, b = square.at(1, 1) + Vec2d{1, 1};
    Loop light{{a.x, a.y}, {b.x, a.y}, {b.x, b.y}, {a.x, b.y}};
    const Vec2d occluder = square.at(0.5 + d.occluder_x, 0.5 + d.occluder_y);
    if (d.occluder == Occluder::housing)
        light = circle_loop(occluder, 0.5 * d.occluder_diameter * square.side);
    outline.loops.push_back(std::move(light));
    if (d.occluder == Occluder::disc)
        outline.loops.push_back(closing(circle_loop(occluder, 0.5 * d.occluder_diameter * square.side)));
    if (d.dust_softness == 0) {
        for (int k = 0; k < d.dust; ++k) {
            const Grain grain = grain_of(d, square, k);
            outline.loops.push_back(closing(circle_loop(grain.centre, grain.radius)));
        }
    }
    for (int k = 0; k < d.scratches; ++k)
        outline.loops.push_back(scratch_loop(d, square, k));
    for (int k = 0; k < d.eyelashes; ++k)
        outline.loops.push_back(eyelash_loop(d, square, k));
    return outline;
}

/// Dark inside, clear outside, a cubic between; at least a texel wide.
void add_soft_grain(const Grain& grain, double softness, Image<float>& light) {
    const double fade = std::max(0.5, softness * grain.radius);
    const double inner = grain.radius - fade, outer = grain.radius + fade;
    const auto first = [&](double c) { return std::max(0, static_cast<int>(std::floor(c - outer))); };
    const auto last = [&](double c, int n) { return std::min(n, static_cast<int>(std::ceil(c + outer))); };
    for (int y = first(grain.centre.y); y < last(grain.centre.y, light.height); ++y) {
        for (int x = first(grain.centre.x); x < last(grain.centre.x, light.width); ++x) {
            const double dx = x + 0.5 - grain.centre.x, dy = y + 0.5 - grain.centre.y;
            const double t = std::clamp((std::sqrt(dx * dx + dy * dy) - inner) / (outer - inner), 0.0, 1.0);
            light(x, y) *= static_cast<float>(t * t * (3 - 2 * t));
        }
    }
}

/// Takes away noise * (1/2 + fluctuations), which hardly ever reach 1/2. No octave is finer than two texels.
void add_noise(const LensDirt& d, const Square& square, Image<float>& light) {
    const double cell = d.noise_cell * square.side;
    int octaves = 1;
    while (octaves < 6 && cell / (1 << octaves) >= 2)
        ++octaves;
    const std::uint32_t seed = hash3(static_cast<std::uint32_t>(d.seed), noise_stream, 0)[0];
    const double c = num::cos_deg(d.noise_angle_deg), s = num::sin_deg(d.noise_angle_deg);
    for (int y = 0; y < light.height; ++y) {
        for (int x = 0; x < light.width; ++x) {
            const double px = (x + 0.5 - square.corner.x) / cell, py = (y + 0.5 - square.corner.y) / cell;
            const double along = (c * px + s * py) / d.noise_stretch, across = c * py - s * px;
            const double share = std::clamp(0.5 + fractal_noise(along, across, octaves, seed), 0.0, 1.0);
            light(x, y) *= static_cast<float>(1 - d.noise * share);
        }
    }
}

}  // namespace

bool has_dirt(const LensDirt& dirt) {
    return dirt.noise > 0 || dirt.dust > 0 || dirt.scratches > 0 || dirt.eyelashes > 0 ||
           dirt.occluder != Occluder::none;
}

Outline dirt_outline(const LensDirt& dirt, int width, int height) {
    check(dirt);
    return outline_on(dirt, square_of(width, height));
}

Image<float> dirt_transmission(const LensDirt& dirt, int width, int height) {
    check(dirt);
    const Square square = square_of(width, height);
    Image<float> light = coverage_of(outline_on(dirt, square), width, height);
    if (dirt.dust_softness > 0) {
        for (int k = 0; k < dirt.dust; ++k)
            add_soft_grain(grain_of(dirt, square, k), dirt.dust_softness, light);
    }
    if (dirt.noise > 0) add_noise(dirt, square, light);
    return light;
}

void add_dirt(const LensDirt& dirt, Aperture& aperture) {
    check(dirt);
    if (!has_dirt(dirt)) return;
    Image<float>& mask = aperture.mask;
    const Image<float> light = dirt_transmission(dirt, mask.width, mask.height);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        mask.pixels[i] *= light.pixels[i];
    aperture.outline = {};
}

void add_occluder(ImageView<const float> occluder, double dx, double dy, Occluder kind, Aperture& aperture) {
    if (kind == Occluder::none) return;
    Image<float>& mask = aperture.mask;
    // Where the occluder's corner lies, in whole texels and the part of one that remains.
    const double left = dx + 0.5 * (mask.width - occluder.width),
                 top = dy + 0.5 * (mask.height - occluder.height);
    const double x0 = std::floor(left), y0 = std::floor(top);
    const double fx = left - x0, fy = top - y0;
    const auto at = [&](double x, double y) {
        const bool inside = x >= 0 && y >= 0 && x < occluder.width && y < occluder.height;
        return inside ? static_cast<double>(occluder(static_cast<int>(x), static_cast<int>(y))) : 0.0;
    };
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const double u = x - x0, v = y - y0;
            const double upper = fx * at(u - 1, v - 1) + (1 - fx) * at(u, v - 1);
            const double lower = fx * at(u - 1, v) + (1 - fx) * at(u, v);
            const double open = std::clamp(fy * upper + (1 - fy) * lower, 0.0, 1.0);
            mask(x, y) *= static_cast<float>(kind == Occluder::housing ? open : 1 - open);
        }
    }
    aperture.outline = {};
}

}  // namespace obscura
