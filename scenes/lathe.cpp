// Solids of revolution.

#include <cmath>

#include "core/error.h"
#include "scenes/build.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

/// One band of the surface, between two profile points, with the normals of its two rims.
struct Band {
    Vec2d low, high;                // (radius, y)
    Vec2d low_normal, high_normal;  // (outward, up), unit
    double low_v = 0, high_v = 0;   // metres along the profile
};

Vec2d unit(Vec2d a) {
    return a * (1.0 / std::sqrt(a.x * a.x + a.y * a.y));
}

/// Walking up, the outside is on the right hand.
Vec2d band_normal(Vec2d low, Vec2d high) {
    return unit({high.y - low.y, low.x - high.x});
}

std::vector<Band> bands_of(const std::vector<Vec2d>& profile, double crease_deg) {
    const std::size_t n = profile.size() - 1;
    const bool ring = profile.front() == profile.back() && profile.front().x > 0;
    CHECK(ring || (profile.front().x == 0 && profile.back().x == 0));
    const double crease_cos = on_circle(crease_deg / 360.0).x;

    std::vector<Band> bands(n);
    double v = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d a = profile[i], b = profile[i + 1];
        CHECK(!(a == b) && (i + 1 == n || b.x > 0));
        const double step = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        const Vec2d normal = band_normal(a, b);
        bands[i] = {a, b, normal, normal, v, v + step};
        v += step;
    }
    // A corner that is flat enough gets the mean of its two bands; the poles of a smooth shape get the axis.
    const auto soften = [&](std::size_t below, std::size_t above, const std::vector<Band>& flat) {
        const Vec2d p = flat[below].high_normal, q = flat[above].low_normal;
        if (p.x * q.x + p.y * q.y < crease_cos) return;
        bands[below].high_normal = bands[above].low_normal = unit(p + q);
    };
    const std::vector<Band> flat = bands;
    for (std::size_t i = 0; i + 1 < n; ++i)
        soften(i, i + 1, flat);
    if (ring) soften(n - 1, 0, flat);
    if (!ring && crease_deg >= 180) bands.front().low_normal = {0, -1}, bands.back().high_normal = {0, 1};
    return bands;
}

}  // namespace

Mesh lathe(const std::vector<Vec2d>& profile, int segments, double crease_deg) {
    CHECK(profile.size() >= 3 && segments >= 3);
    double girth = 0;
    for (const Vec2d p : profile)
        girth = p.x > girth ? p.x : girth;
    girth *= 6.283185307179586;

    Mesh m;
    const auto vertex = [&](Vec2d p, Vec2d n, double v, double column) {
        // Columns half way (poles of flat-shaded cones) keep the pole's own position: its radius is 0.
        const Vec2d at = on_circle(std::floor(column) >= segments ? 0.0 : std::floor(column) / segments);
        const Vec2d facing = on_circle(column / segments);
        m.positions.push_back(stored({p.x * at.x, p.y, -p.x * at.y}));
        m.normals.push_back(to_float({n.x * facing.x, n.y, -n.x * facing.y}));
        const bool flat = std::fabs(n.y) > 0.999;
        m.uvs.push_back(flat ? Vec2f{static_cast<float>(p.x * at.x), static_cast<float>(p.x * at.y)}
                             : Vec2f{static_cast<float>(girth * column / segments), static_cast<float>(v)});
        return static_cast<std::uint32_t>(m.positions.size() - 1);
    };
    for (const Band& band : bands_of(profile, crease_deg)) {
        // One column of vertices more than segments: the seam has its own uvs.
        std::vector<std::uint32_t> low, high;
        for (int j = 0; j <= segments; ++j) {
            const bool last = j == segments;
            if (band.low.x > 0 || !last)
                low.push_back(vertex(band.low, band.low_normal, band.low_v, band.low.x > 0 ? j : j + 0.5));
            if (band.high.x > 0 || !last)
                high.push_back(
                    vertex(band.high, band.high_normal, band.high_v, band.high.x > 0 ? j : j + 0.5));
        }
        for (std::size_t j = 0; j < static_cast<std::size_t>(segments); ++j) {
            if (band.low.x == 0) {
                m.triangles.push_back({{low[j], high[j + 1], high[j]}});
            } else if (band.high.x == 0) {
                m.triangles.push_back({{low[j], low[j + 1], high[j]}});
            } else {
                m.triangles.push_back({{low[j], low[j + 1], high[j + 1]}});
                m.triangles.push_back({{low[j], high[j + 1], high[j]}});
            }
        }
    }
    m.material.assign(m.triangles.size(), 0);
    m.object.assign(m.triangles.size(), 0);
    return m;
}

}  // namespace obscura
