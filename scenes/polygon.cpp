#include "scenes/polygon.h"

#include <algorithm>

#include "core/error.h"

namespace obscura {
namespace {

/// Twice the signed area of a triangle.
double area2(Vec2d a, Vec2d b, Vec2d c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance2(Vec2d a, Vec2d b) {
    return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

/// 0 for a corner that is no ear, else area over the square of the longest side.
double ear_quality(const std::vector<Vec2d>& p, const std::vector<std::uint32_t>& ring, std::size_t i) {
    const std::size_t n = ring.size();
    const std::uint32_t ia = ring[(i + n - 1) % n], ib = ring[i], ic = ring[(i + 1) % n];
    const Vec2d a = p[ia], b = p[ib], c = p[ic];
    const double area = area2(a, b, c);
    if (area <= 0) return 0;
    for (const std::uint32_t k : ring) {
        if (k == ia || k == ib || k == ic) continue;
        if (area2(a, b, p[k]) >= 0 && area2(b, c, p[k]) >= 0 && area2(c, a, p[k]) >= 0) return 0;
    }
    return area / std::max({distance2(a, b), distance2(b, c), distance2(c, a)});
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Vec2d>& outline) {
    CHECK(outline.size() >= 3);
    std::vector<std::uint32_t> ring(outline.size());
    for (std::uint32_t i = 0; i < ring.size(); ++i)
        ring[i] = i;
    std::vector<Triangle> triangles;
    while (ring.size() >= 3) {
        std::size_t best = 0;
        double best_quality = 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double quality = ear_quality(outline, ring, i);
            if (quality > best_quality) best = i, best_quality = quality;
        }
        CHECK(best_quality > 0);  // a simple polygon always has an ear
        const std::size_t n = ring.size();
        triangles.push_back({{ring[(best + n - 1) % n], ring[best], ring[(best + 1) % n]}});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return triangles;
}

}  // namespace obscura
