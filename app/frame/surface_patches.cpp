#include "app/frame/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/frame/surface_blur.h"

namespace obscura {
namespace {

constexpr int most_side = 1024;

struct Corners {
    Vec3d a, b, c;
    double area() const { return 0.5 * length(cross(b - a, c - a)); }
};

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return {to_double(mesh.positions[t.v[0]]), to_double(mesh.positions[t.v[1]]),
            to_double(mesh.positions[t.v[2]])};
}

/// How many cells of size h lie along a side: the middle of what its longest edge and its area ask for.
int side_for(const Corners& t, double h) {
    const Vec3d e0 = t.b - t.a, e1 = t.c - t.a, e2 = t.c - t.b;
    const double longest = std::sqrt(std::max({dot(e0, e0), dot(e1, e1), dot(e2, e2)}));
    const double wide = std::sqrt(2 * t.area());
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(longest * wide) / h), 1.0, double{most_side}));
}

/// Place of a cell in its triangle: row j along the second edge, column i along the first, and whether it is
/// turned around. Rows of 2 (side - j) - 1 cells.
struct CellPlace {
    int i = 0, j = 0;
    bool turned = false;
};

std::uint32_t index_of(const CellPlace& c, int side) {
    return static_cast<std::uint32_t>(c.j * (2 * side - c.j) + 2 * c.i + (c.turned ? 1 : 0));
}

CellPlace place_of(std::uint32_t index, int side) {
    CellPlace c;
    int left = static_cast<int>(index);
    for (; left >= 2 * (side - c.j) - 1; ++c.j)
        left -= 2 * (side - c.j) - 1;
    c.i = left / 2;
    c.turned = left % 2 == 1;
    return c;
}

/// By component: closed, and its inside is behind its triangles.
std::vector<bool> solids(const Mesh& mesh) {
    std::vector<double> volume(mesh.components.size());
    std::vector<Vec3d> origin(mesh.components.size());
    std::vector<bool> met(mesh.components.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t component = mesh.component[t];
        const Corners c = corners_of(mesh, t);
        // Relative to some point of it, so that little is lost far off.
        if (!met[component]) origin[component] = c.a;
        met[component] = true;
        const Vec3d o = origin[component];
        volume[component] += dot(c.a - o, cross(c.b - o, c.c - o));
    }
    std::vector<bool> solid(mesh.components.size());
    for (std::size_t i = 0; i < solid.size(); ++i)
        solid[i] = mesh.components[i].closed && volume[i] > 0;
    return solid;
}

/// What small triangles that share a patch have in common.
struct Together {
    std::int64_t x, y, z;
    int facing;
    std::uint32_t material;
    bool solid;
    std::uint32_t triangle;

    auto key() const { return std::tie(x, y, z, facing, material, solid); }
    friend bool operator<(const Together& a, const Together& b) {
        return a.key() != b.key() ? a.key() < b.key() : a.triangle < b.triangle;
    }
};

class Divider {
  public:
    explicit Divider(const Mesh& mesh) : mesh_(mesh), solid_(solids(mesh)) {}

    SurfacePatches run() {
        divided_.triangles.resize(mesh_.triangles.size());
        choose_size();
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (casts(t) && !is_small(corners_of(mesh_, t))) divide(static_cast<std::uint32_t>(t));
        }
        gather_small();
        return std::move(divided_);
    }

  private:
    bool casts(std::size_t t) const {
        return mesh_.objects.empty() || mesh_.objects[mesh_.object[t]].casts_shadow;
    }
    bool is_small(const Corners& c) const {
        return c.area() < divided_.size_m * divided_.size_m / 8 && side_for(c, divided_.size_m) == 1;
    }

    /// As small as there are cells for.
    void choose_size() {
        double area = 0;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
            area += casts(t) ? corners_of(mesh_, t).area() : 0.0;
        double& h = divided_.size_m;
        h = std::max(std::sqrt(2 * area / static_cast<double>(surface_cells)), 1e-30);
        for (;; h *= std::sqrt(2.0)) {
            std::int64_t cells = 0, single = 0;
            for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
                if (!casts(t)) continue;
                const int side = side_for(corners_of(mesh_, t), h);
                cells += std::int64_t{side} * side;
                ++single;
            }
            if (cells <= surface_cells + single) return;
        }
    }

    void add(std::uint32_t t, std::uint32_t cells, float area, TrianglePatches& to) {
        const auto sides = solid_[mesh_.component[t]] ? 1 : 2;
        for (int s = 0; s < sides; ++s) {
            (s == 0 ? to.front : to.back) = static_cast<std::uint32_t>(divided_.patches.size());
            for (std::uint32_t cell = 0; cell < cells; ++cell)
                divided_.patches.push_back({t, cell, s == 1, area});
        }
    }

    void divide(std::uint32_t t) {
        const Corners c = corners_of(mesh_, t);
        TrianglePatches& to = divided_.triangles[t];
        const int side = side_for(c, divided_.size_m);
        to.side = static_cast<std::uint16_t>(side);
        add(t, static_cast<std::uint32_t>(side * side), static_cast<float>(c.area() / (side * side)), to);
    }

    void gather_small() {
        std::vector<Together> small;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const Corners c = corners_of(mesh_, t);
            if (!casts(t) || !is_small(c)) continue;
            const auto cell = [&](double at) {
                return static_cast<std::int64_t>(
                    std::floor(std::clamp(at / divided_.size_m, -0x1p60, 0x1p60)));
            };
            const Vec3d middle = (c.a + c.b + c.c) * (1.0 / 3);
            small.push_back({cell(middle.x), cell(middle.y), cell(middle.z),
                             facing_of(mesh_.faces[mesh_.face[t]].n), mesh_.material[t],
                             solid_[mesh_.component[t]], static_cast<std::uint32_t>(t)});
        }
        std::sort(small.begin(), small.end());
        for (std::size_t begin = 0, end = 0; begin < small.size(); begin = end) {
            double area = 0, most = -1;
            std::uint32_t largest = 0;
            for (end = begin; end < small.size() && small[end].key() == small[begin].key(); ++end) {
                const double own = corners_of(mesh_, small[end].triangle).area();
                area += own;
                if (own > most) largest = small[end].triangle;
                most = std::max(most, own);
            }
            TrianglePatches shared{no_patch, no_patch, 1};
            add(largest, 1, static_cast<float>(area), shared);
            for (std::size_t i = begin; i < end; ++i)
                divided_.triangles[small[i].triangle] = shared;
        }
    }

    const Mesh& mesh_;
    std::vector<bool> solid_;
    SurfacePatches divided_;
};

}  // namespace

SurfacePatches surface_patches(const Mesh& mesh) {
    return Divider(mesh).run();
}

std::uint32_t patch_at(const Mesh& mesh, const SurfacePatches& patches, std::uint32_t triangle, bool back,
                       Vec3d p) {
    const TrianglePatches& of = patches.triangles[triangle];
    const std::uint32_t first = back ? of.back : of.front;
    if (of.side <= 1 || first == no_patch) return first;
    // Barycentric coordinates of b and c, by the rule of Cramer.
    const Corners t = corners_of(mesh, triangle);
    const Vec3d e0 = t.b - t.a, e1 = t.c - t.a, d = p - t.a;
    const double d00 = dot(e0, e0), d01 = dot(e0, e1), d11 = dot(e1, e1), d20 = dot(d, e0), d21 = dot(d, e1);
    const double area = d00 * d11 - d01 * d01;
    if (!(area > 0)) return first;
    const auto steps = [&](double share) {
        return std::clamp(share / area * of.side, 0.0, static_cast<double>(of.side));
    };
    const double u = steps(d11 * d20 - d01 * d21), v = steps(d00 * d21 - d01 * d20);
    CellPlace c;
    c.j = std::min(static_cast<int>(v), of.side - 1);
    c.i = std::min(static_cast<int>(u), of.side - 1 - c.j);
    c.turned = (u - c.i) + (v - c.j) > 1 && c.i < of.side - 1 - c.j;
    return first + index_of(c, of.side);
}

PatchMiddle patch_middle(const Mesh& mesh, const SurfacePatches& patches, const SurfacePatch& patch) {
    const int side = patches.triangles[patch.triangle].side;
    const CellPlace c = place_of(patch.cell, side);
    const double off = c.turned ? 2.0 / 3 : 1.0 / 3;
    const Corners t = corners_of(mesh, patch.triangle);
    PatchMiddle m;
    m.u = (c.i + off) / side;
    m.v = (c.j + off) / side;
    const Plane& plane = mesh.faces[mesh.face[patch.triangle]];
    const Vec3d p = t.a + (t.b - t.a) * m.u + (t.c - t.a) * m.v;
    m.p = p - plane.n * (dot(plane.n, p) + plane.d);
    m.n = patch.back ? -plane.n : plane.n;
    return m;
}

}  // namespace obscura
