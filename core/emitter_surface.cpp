#include "core/emitter_surface.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace obscura {
namespace {

EmitterPiece piece_of(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = cross(b - a, c - a);
    const double twice = length(n);
    return {{a, b, c}, twice > 0 ? n * (1 / twice) : Vec3d{0, 0, 0}, 0.5 * twice};
}

Vec3d middle_of(const EmitterPiece& piece) {
    return (piece.corner[0] + piece.corner[1] + piece.corner[2]) * (1.0 / 3);
}

/// A piece of a piece, as cutting in halves sees it.
struct Chip {
    Vec3d middle;
    double area_m2;
    std::uint32_t piece;
    std::uint32_t order;  ///< among all, which settles ties
};

/// Quarters a triangle until no chip is larger than `most_m2`.
void add_chips(Vec3d a, Vec3d b, Vec3d c, double area_m2, double most_m2, std::uint32_t piece,
               std::vector<Chip>& chips) {
    if (area_m2 <= most_m2) {
        chips.push_back({(a + b + c) * (1.0 / 3), area_m2, piece, static_cast<std::uint32_t>(chips.size())});
        return;
    }
    const Vec3d ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
    add_chips(a, ab, ca, area_m2 / 4, most_m2, piece, chips);
    add_chips(ab, b, bc, area_m2 / 4, most_m2, piece, chips);
    add_chips(ca, bc, c, area_m2 / 4, most_m2, piece, chips);
    add_chips(ab, bc, ca, area_m2 / 4, most_m2, piece, chips);
}

/// Cuts the surface in parts.
class Halving {
  public:
    Halving(const EmitterSurface& surface, int count) : surface_(surface) {
        // Sixteen chips a part, at least half as many.
        for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
            const EmitterPiece& p = surface.pieces[i];
            add_chips(p.corner[0], p.corner[1], p.corner[2], p.area_m2, surface.area_m2 / (16.0 * count),
                      static_cast<std::uint32_t>(i), chips_);
        }
        cut(0, chips_.size(), count);
    }

    std::vector<EmitterPoint> points;

  private:
    void cut(std::size_t begin, std::size_t end, int count) {
        if (count == 1) {
            points.push_back(point_of(begin, end));
            return;
        }
        const int axis = longest_axis(begin, end);
        const auto along = [&](const Chip& c) {
            return axis == 0 ? c.middle.x : axis == 1 ? c.middle.y : c.middle.z;
        };
        std::sort(chips_.begin() + static_cast<std::ptrdiff_t>(begin),
                  chips_.begin() + static_cast<std::ptrdiff_t>(end), [&](const Chip& a, const Chip& b) {
                      return along(a) != along(b) ? along(a) < along(b) : a.order < b.order;
                  });
        double all = 0;
        for (std::size_t i = begin; i < end; ++i)
            all += chips_[i].area_m2;
        const int first = count / 2;
        const double wanted = all * first / count;
        std::size_t at = begin;
        for (double before = 0; before + 0.5 * chips_[at].area_m2 < wanted; ++at)
            before += chips_[at].area_m2;
        cut(begin, at, first);
        cut(at, end, count - first);
    }

    int longest_axis(std::size_t begin, std::size_t end) const {
        Vec3d low = chips_[begin].middle, high = low;
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d p = chips_[i].middle;
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const Vec3d size = high - low;
        if (size.x >= size.y && size.x >= size.z) return 0;
        return size.y >= size.z ? 1 : 2;
    }

    /// The chip nearest to the part's middle stands for it: a place that is on the surface.
    EmitterPoint point_of(std::size_t begin, std::size_t end) const {
        CHECK(begin < end);
        Vec3d sum{0, 0, 0};
        double area = 0;
        for (std::size_t i = begin; i < end; ++i) {
            sum = sum + chips_[i].middle * chips_[i].area_m2;
            area += chips_[i].area_m2;
        }
        const Vec3d middle = sum * (1 / area);
        std::size_t nearest = begin;
        const auto away = [&](std::size_t i) {
            const Vec3d d = chips_[i].middle - middle;
            return dot(d, d);
        };
        for (std::size_t i = begin + 1; i < end; ++i) {
            if (away(i) < away(nearest)) nearest = i;
        }
        const Chip& chip = chips_[nearest];
        return {chip.middle, surface_.pieces[chip.piece].normal, area / surface_.area_m2};
    }

    const EmitterSurface& surface_;
    std::vector<Chip> chips_;
};

}  // namespace

EmitterSurface emitter_surface(const Mesh& mesh, std::uint32_t material) {
    EmitterSurface surface;
    Vec3d sum{0, 0, 0};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.material[t] != material) continue;
        const auto& v = mesh.triangles[t].v;
        const EmitterPiece piece = piece_of(to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
                                            to_double(mesh.positions[v[2]]));
        if (!(piece.area_m2 > 0)) continue;
        surface.pieces.push_back(piece);
        surface.area_m2 += piece.area_m2;
        sum = sum + middle_of(piece) * piece.area_m2;
    }
    if (surface.pieces.empty()) return surface;
    surface.middle = sum * (1 / surface.area_m2);
    for (const EmitterPiece& piece : surface.pieces) {
        for (const Vec3d p : piece.corner)
            surface.radius_m = std::max(surface.radius_m, length(p - surface.middle));
    }
    return surface;
}

std::vector<EmitterPoint> emitter_points(const EmitterSurface& surface, int count) {
    CHECK(!surface.pieces.empty() && count >= 1);
    return Halving(surface, count).points;
}

}  // namespace obscura
