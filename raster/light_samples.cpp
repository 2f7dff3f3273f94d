#include "raster/light_samples.h"

#include <cmath>

#include "core/emitter_surface.h"
#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

constexpr double golden = 0.61803398874989484820;
constexpr double golden_angle = 2.39996322972865332223;  // 2 pi (1 - golden)

double fraction(double x) {
    return x - std::floor(x);
}

/// Unit vectors at right angles to unit d, and to each other.
struct Across {
    Vec3d u, v;
};
Across across(Vec3d d) {
    const Vec3d aside = std::fabs(d.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d u = normalize(cross(aside, d));
    return {u, cross(d, u)};
}

/// Point k of `count` of the unit disc, each of as much area.
struct DiscPoint {
    double x, y, area;  ///< area: share of the disc that is nearer to its middle
};
DiscPoint sunflower(int k, int count) {
    const double area = (k + 0.5) / count, r = std::sqrt(area), angle = k * golden_angle;
    return {r * num::cos(angle), r * num::sin(angle), area};
}

/// Distance from a ball's middle, radius 1, within which a share t of the points of density 1 / sqrt(1 - r^2)
/// lie: r = sin a with (2 / pi) (a - sin a cos a) = t.
double ball_radius(double t) {
    double low = 0, high = num::pi / 2;
    for (int i = 0; i < 48; ++i) {
        const double a = 0.5 * (low + high);
        (a - num::sin(a) * num::cos(a) < t * (num::pi / 2) ? low : high) = a;
    }
    return num::sin(0.5 * (low + high));
}

Vec3d ball_point(int k, int count) {
    const double z = 1.0 - (2.0 * k + 1.0) / count, level = std::sqrt(1.0 - z * z), angle = k * golden_angle;
    // As far from the middle as the square root of two's multiples say, which the order knows nothing of.
    const double r = ball_radius(fraction((k + 0.5) * 1.41421356237309504880));
    return Vec3d{level * num::cos(angle), z, level * num::sin(angle)} * r;
}

/// Direction k of a disc in the sky: of as much solid angle each.
Vec3d disc_direction(const Light& light, int k, int count) {
    const Vec3d axis = normalize(light.direction);
    const DiscPoint p = sunflower(k, count);
    // 1 - cos of the disc's radius; of the direction's, that times the area within.
    const double half = num::sin_deg(0.25 * light.angular_diameter_deg), rim = 2 * half * half,
                 versine = rim * p.area, sine = std::sqrt(versine * (2 - versine)), r = std::sqrt(p.area);
    const Across a = across(axis);
    return normalize(axis * (1 - versine) + (a.u * (p.x / r) + a.v * (p.y / r)) * sine);
}

Light sample_of(const Light& light, int k, int count) {
    Light one = light;
    const double share = 1.0 / count;
    switch (light.kind) {
        case LightKind::directional:
        case LightKind::sun: {
            one.direction = disc_direction(light, k, count);
            one.angular_diameter_deg = 0;
            // On a surface that faces the disc's middle they add up to the whole: their cosines' mean is
            // (1 + cos) / 2.
            const double cosine = num::cos_deg(0.5 * light.angular_diameter_deg);
            one.color = light.color * static_cast<float>(share * 2 / (1 + cosine));
            break;
        }
        case LightKind::point:
        case LightKind::spot:
            one.position = light.position + ball_point(k, count) * light.radius_m;
            one.radius_m = 0;
            one.color = light.color * static_cast<float>(share);
            break;
        case LightKind::area: {
            const Vec3d down = cross(light.direction, light.across);
            double x = 2 * (k + 0.5) * share - 1, y = 2 * fraction((k + 0.5) * golden) - 1;
            if (light.shape == AreaShape::disc) {
                const DiscPoint p = sunflower(k, count);
                x = p.x;
                y = p.y;
            }
            one.position =
                light.position + light.across * (0.5 * light.width_m * x) + down * (0.5 * light.height_m * y);
            one.part = share;
            break;
        }
        case LightKind::surface:
            break;
    }
    return one;
}

/// Of a surface, small area lights which lie on it.
std::vector<Light> surface_samples(const Light& light, int count) {
    std::vector<Light> samples;
    for (const EmitterPoint& p : emitter_points(*light.surface, count)) {
        Light& one = samples.emplace_back(light);
        one.kind = LightKind::area;
        one.position = p.position;
        one.direction = p.normal;
        one.across = across(p.normal).u;
        one.width_m = one.height_m = std::sqrt(light.surface->area_m2);
        one.part = p.share;
        one.surface = nullptr;
    }
    return samples;
}

}  // namespace

bool has_size(const Light& light) {
    if (is_parallel(light.kind)) return light.angular_diameter_deg > 0;
    if (light.kind == LightKind::surface) return light.surface != nullptr && !light.surface->pieces.empty();
    return light.kind == LightKind::area ? light.part == 1 : light.radius_m > 0;
}

std::vector<Light> light_samples(const Light& light, int count) {
    CHECK(count >= 1);
    if (!has_size(light) || count == 1) return {light};
    if (light.kind == LightKind::surface) return surface_samples(light, count);
    std::vector<Light> samples;
    samples.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k)
        samples.push_back(sample_of(light, k, count));
    return samples;
}

}  // namespace obscura
