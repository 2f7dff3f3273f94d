#pragma once
// Who walks along which edge: the raw material of topology, planar faces and normals.

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh.h"

namespace obscura {

/// One step of a triangle's boundary, from corner `corner` to the next. `lo < hi` are the ends as vertex ids;
/// `forward` when the triangle walks from lo to hi.
struct EdgeUse {
    std::uint32_t lo = 0, hi = 0;
    std::uint32_t group = 0;  ///< edges of different groups are different edges
    std::uint32_t triangle = 0;
    std::uint8_t corner = 0;
    bool forward = false;
};

/// For every vertex the first vertex with the same position (bits equal, -0 equal to 0).
std::vector<std::uint32_t> weld_positions(std::span<const Vec3f> positions);

/// `triangles` with every vertex v replaced by ids[v].
std::vector<Triangle> relabel(std::span<const Triangle> triangles, std::span<const std::uint32_t> ids);

/// Every edge use of the triangles listed in `subset`, sorted by (lo, hi, group, triangle, corner). Corners
/// hold vertex ids below id_count. Triangles that repeat a corner walk every edge there and back and are left
/// out. `group` is per triangle; empty = all in one.
std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles, std::uint32_t id_count,
                               std::span<const std::uint32_t> subset,
                               std::span<const std::uint32_t> group = {});

/// All of them: 0, 1, ... count - 1.
std::vector<std::uint32_t> all_indices(std::size_t count);

/// Calls fn(std::span<const EdgeUse>) once per edge with everyone who walks it.
template <class Fn>
void for_each_edge(std::span<const EdgeUse> uses, Fn&& fn) {
    for (std::size_t begin = 0; begin < uses.size();) {
        const EdgeUse& first = uses[begin];
        std::size_t end = begin + 1;
        while (end < uses.size() && uses[end].lo == first.lo && uses[end].hi == first.hi &&
               uses[end].group == first.group) {
            ++end;
        }
        fn(uses.subspan(begin, end - begin));
        begin = end;
    }
}

/// Walks forward minus walks backward: 0 on every edge of a solid.
inline int balance(std::span<const EdgeUse> edge) {
    int sum = 0;
    for (const EdgeUse& use : edge)
        sum += use.forward ? 1 : -1;
    return sum;
}

inline bool repeats_corner(const Triangle& t) {
    return t.v[0] == t.v[1] || t.v[1] == t.v[2] || t.v[2] == t.v[0];
}

/// No area to speak of: two corners at one position, or thinner than the rounding of its own coordinates.
bool is_degenerate(Vec3f a, Vec3f b, Vec3f c);

}  // namespace obscura
