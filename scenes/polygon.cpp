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

/// 0 for a corner that is no ear, else area over the square of the longest side. A corner of the ring that is
/// inside, or outside by less than `margin` in the same measure, is in the way.
double ear_quality(const std::vector<Vec2d>& p, const std::vector<std::uint32_t>& ring, std::size_t i,
                   double margin) {
    const std::size_t n = ring.size();
    const std::uint32_t ia = ring[(i + n - 1) % n], ib = ring[i], ic = ring[(i + 1) % n];
    const Vec2d a = p[ia], b = p[ib], c = p[ic];
    const double area = area2(a, b, c);
    if (area <= 0) return 0;
    const double longest2 = std::max({distance2(a, b), distance2(b, c), distance2(c, a)});
    const double least = -margin * longest2;
    for (const std::uint32_t k : ring) {
        if (k == ia || k == ib || k == ic) continue;
        if (area2(a, b, p[k]) >= least && area2(b, c, p[k]) >= least && area2(c, a, p[k]) >= least) return 0;
    }
    return area / longest2;
}

struct Cutting {
    std::vector<Triangle> triangles;
    double worst_quality = 1;  ///< of all ears; 0 when there was a ring without one
};

/// Clips the best ear until three corners are left.
Cutting cut_ears(const std::vector<Vec2d>& outline, double margin) {
    std::vector<std::uint32_t> ring(outline.size());
    for (std::uint32_t i = 0; i < ring.size(); ++i)
        ring[i] = i;
    Cutting cutting;
    while (ring.size() >= 3) {
        std::size_t best = 0;
        double best_quality = 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double quality = ear_quality(outline, ring, i, margin);
            if (quality > best_quality) best = i, best_quality = quality;
        }
        cutting.worst_quality = std::min(cutting.worst_quality, best_quality);
        const std::size_t n = ring.size();
        cutting.triangles.push_back({{ring[(best + n - 1) % n], ring[best], ring[(best + 1) % n]}});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return cutting;
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Vec2d>& outline) {
    CHECK(outline.size() >= 3);
    // Noses of stairs lie on one line, and rounding makes them turn either way: an ear along that line passes
    // them by and leaves a ring without area. With a margin they are in its way, and no such ear is cut.
    constexpr double sliver = 1e-9, margin = 1e-9;
    Cutting exact = cut_ears(outline, 0);
    if (exact.worst_quality > sliver) return std::move(exact.triangles);
    Cutting wary = cut_ears(outline, margin);
    return std::move(wary.worst_quality > exact.worst_quality ? wary.triangles : exact.triangles);
}

}  // namespace obscura
