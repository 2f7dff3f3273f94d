#include "hierarchy/stack/light_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/error.h"
#include "core/num.h"
#include "raster/view.h"

namespace obscura {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Cell number `d` of the Hilbert curve over 2^order cells a side, from (0, 0) to (side - 1, 0).
void hilbert_cell(int order, std::uint32_t d, std::uint32_t& x, std::uint32_t& y) {
    x = y = 0;
    for (std::uint32_t side = 1; side < 1u << order; side *= 2, d /= 4) {
        const std::uint32_t right = d / 2 & 1u, up = (d ^ right) & 1u;
        if (up == 0) {
            if (right == 1) {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            const std::uint32_t t = x;
            x = y;
            y = t;
        }
        x += side * right;
        y += side * up;
    }
}

/// The other way round: which cell of the curve (x, y) is.
std::uint64_t hilbert_number(int order, std::uint32_t x, std::uint32_t y) {
    std::uint64_t d = 0;
    for (std::uint32_t side = (1u << order) / 2; side > 0; side /= 2) {
        const std::uint32_t right = (x & side) != 0 ? 1 : 0, up = (y & side) != 0 ? 1 : 0;
        d = 4 * d + ((3 * right) ^ up);
        x &= side - 1;
        y &= side - 1;
        if (up == 0) {
            if (right == 1) {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            const std::uint32_t t = x;
            x = y;
            y = t;
        }
    }
    return d;
}

/// From the unit square to the unit disc.
Vec2d concentric(Vec2d p) {
    const double a = 2 * p.x - 1, b = 2 * p.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    double r, turn;
    if (std::fabs(a) > std::fabs(b)) {
        r = a;
        turn = pi / 4 * (b / a);
    } else {
        r = b;
        turn = pi / 2 - pi / 4 * (a / b);
    }
    return {r * num::cos(turn), r * num::sin(turn)};
}

}  // namespace

std::vector<Vec2d> hilbert_samples(int count) {
    CHECK(count >= 1 && std::has_single_bit(static_cast<unsigned>(count)), "a power of two of samples");
    const int log = std::countr_zero(static_cast<unsigned>(count));
    const int order = log / 2, squares = log % 2 == 0 ? 1 : 2;
    const auto side = static_cast<double>(1 << order), cells = side * side;
    std::vector<Vec2d> samples;
    for (int i = 0; i < count; ++i) {
        std::uint32_t x, y;
        hilbert_cell(order, static_cast<std::uint32_t>(i) & (static_cast<std::uint32_t>(cells) - 1u), x, y);
        const double square = i >= static_cast<int>(cells) ? 1 : 0;
        samples.push_back({(square + (x + 0.5) / side) / squares, (y + 0.5) / side});
    }
    return samples;
}

std::vector<std::size_t> hilbert_order(const std::vector<Vec2d>& places) {
    constexpr int order = 16;
    Vec2d low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Vec2d& p : places) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, 1e-300});
    const auto cell = [&](double offset) {
        return static_cast<std::uint32_t>(std::clamp(offset / extent, 0.0, 1.0) * ((1 << order) - 1));
    };
    std::vector<std::pair<std::uint64_t, std::size_t>> numbered;
    numbered.reserve(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec2d d{places[i].x - low.x, places[i].y - low.y};
        numbered.emplace_back(hilbert_number(order, cell(d.x), cell(d.y)), i);
    }
    std::sort(numbered.begin(), numbered.end());
    std::vector<std::size_t> sorted;
    sorted.reserve(numbered.size());
    for (const auto& [number, i] : numbered)
        sorted.push_back(i);
    return sorted;
}

LightSamples parallelogram_samples(Vec3d centre, Vec3d edge_u, Vec3d edge_v, int count) {
    LightSamples samples;
    for (const Vec2d& s : hilbert_samples(count))
        samples.at.push_back(centre + edge_u * (s.x - 0.5) + edge_v * (s.y - 0.5));
    return samples;
}

LightSamples disc_samples(Vec3d centre, Vec3d normal, double radius, int count) {
    const Basis basis = look_basis(normal, {0, 1, 0});
    LightSamples samples;
    for (const Vec2d& s : hilbert_samples(count)) {
        const Vec2d p = concentric(s);
        samples.at.push_back(centre + basis.right * (p.x * radius) + basis.up * (p.y * radius));
    }
    return samples;
}

LightSamples sun_samples(Vec3d direction, double angular_radius_deg, int count) {
    CHECK(angular_radius_deg >= 0 && angular_radius_deg < 45);
    const double angle = angular_radius_deg * pi / 180, tangent = num::sin(angle) / num::cos(angle);
    LightSamples samples = disc_samples(normalize(direction), direction, tangent, count);
    samples.directional = true;
    for (Vec3d& d : samples.at)
        d = normalize(d);
    return samples;
}

}  // namespace obscura
