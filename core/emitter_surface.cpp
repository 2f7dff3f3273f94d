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
    double at[6];  ///< middle, metres, and normal times the surface's extent
    double area_m2;
    std::uint32_t piece;
    std::uint32_t order;  ///< among all, which settles ties
};

/// Cuts the surface in parts, by where it is and by where it faces: what shines to both sides of a sheet, or
/// around a tube, is not one part.
class Halving {
  public:
    Halving(const EmitterSurface& surface, int count) : surface_(surface) {
        // At least sixteen chips a part.
        most_m2_ = surface.area_m2 / (16.0 * count);
        for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
            const EmitterPiece& p = surface.pieces[i];
            add_chips(p.corner[0], p.corner[1], p.corner[2], p.area_m2, static_cast<std::uint32_t>(i));
        }
        points.reserve(static_cast<std::size_t>(count));
        cut(0, chips_.size(), count);
    }

    std::vector<EmitterPoint> points;

  private:
    /// Quarters a triangle until no chip is too large.
    void add_chips(Vec3d a, Vec3d b, Vec3d c, double area_m2, std::uint32_t piece) {
        if (area_m2 <= most_m2_) {
            const Vec3d p = (a + b + c) * (1.0 / 3), n = surface_.pieces[piece].normal * surface_.radius_m;
            chips_.push_back(
                {{p.x, p.y, p.z, n.x, n.y, n.z}, area_m2, piece, static_cast<std::uint32_t>(chips_.size())});
            return;
        }
        const Vec3d ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
        add_chips(a, ab, ca, area_m2 / 4, piece);
        add_chips(ab, b, bc, area_m2 / 4, piece);
        add_chips(ca, bc, c, area_m2 / 4, piece);
        add_chips(ab, bc, ca, area_m2 / 4, piece);
    }

    void cut(std::size_t begin, std::size_t end, int count) {
        if (count == 1) {
            points.push_back(point_of(begin, end));
            return;
        }
        const std::size_t axis = longest_axis(begin, end);
        std::sort(chips_.begin() + static_cast<std::ptrdiff_t>(begin),
                  chips_.begin() + static_cast<std::ptrdiff_t>(end), [&](const Chip& a, const Chip& b) {
                      return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.order < b.order;
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

    std::size_t longest_axis(std::size_t begin, std::size_t end) const {
        std::size_t longest = 0;
        double most = -1;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            double low = chips_[begin].at[axis], high = low;
            for (std::size_t i = begin; i < end; ++i) {
                low = std::min(low, chips_[i].at[axis]);
                high = std::max(high, chips_[i].at[axis]);
            }
            // Of what is as long the first, but for the rounding of normals.
            if (high - low > most * (1 + 1e-9)) {
                most = high - low;
                longest = axis;
            }
        }
        return longest;
    }

    /// The chip nearest to the part's middle stands for it: a place that is on the surface.
    EmitterPoint point_of(std::size_t begin, std::size_t end) const {
        CHECK(begin < end);
        double middle[6] = {}, area = 0;
        for (std::size_t i = begin; i < end; ++i) {
            area += chips_[i].area_m2;
            for (std::size_t axis = 0; axis < 6; ++axis)
                middle[axis] += chips_[i].at[axis] * chips_[i].area_m2;
        }
        const auto away = [&](const Chip& chip) {
            double sum = 0;
            for (std::size_t axis = 0; axis < 6; ++axis) {
                const double d = chip.at[axis] - middle[axis] / area;
                sum += d * d;
            }
            return sum;
        };
        const Chip* nearest = &chips_[begin];
        for (std::size_t i = begin + 1; i < end; ++i) {
            if (away(chips_[i]) < away(*nearest)) nearest = &chips_[i];
        }
        return {{nearest->at[0], nearest->at[1], nearest->at[2]},
                surface_.pieces[nearest->piece].normal,
                area / surface_.area_m2};
    }

    const EmitterSurface& surface_;
    double most_m2_ = 0;
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
