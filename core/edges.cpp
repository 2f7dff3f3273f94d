#include "core/edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/error.h"

namespace obscura {
namespace {

std::array<std::uint32_t, 3> position_bits(Vec3f p) {
    // Adding +0 turns -0 into +0 and leaves every other value alone.
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

std::uint64_t hash_of(const std::array<std::uint32_t, 3>& bits) {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::uint32_t b : bits) {
        h = (h ^ b) * 0xff51afd7ed558ccdu;
        h ^= h >> 32;
    }
    return h;
}

}  // namespace

std::vector<std::uint32_t> weld_positions(std::span<const Vec3f> positions) {
    CHECK(positions.size() < UINT32_MAX);
    // Open addressing in vertex order: the first of equal positions stays, so the hash decides nothing.
    constexpr std::uint32_t empty = UINT32_MAX;
    std::vector<std::uint32_t> slots(std::bit_ceil(positions.size() * 2 + 1), empty);
    std::vector<std::uint32_t> first(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const auto bits = position_bits(positions[v]);
        std::size_t slot = hash_of(bits) & (slots.size() - 1);
        while (slots[slot] != empty && position_bits(positions[slots[slot]]) != bits) {
            slot = (slot + 1) & (slots.size() - 1);
        }
        if (slots[slot] == empty) slots[slot] = v;
        first[v] = slots[slot];
    }
    return first;
}

std::vector<Triangle> relabel(std::span<const Triangle> triangles, std::span<const std::uint32_t> ids) {
    std::vector<Triangle> result(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k)
            result[t].v[k] = ids[triangles[t].v[k]];
    }
    return result;
}

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles, std::uint32_t id_count,
                               std::span<const std::uint32_t> subset, std::span<const std::uint32_t> group) {
    const auto each_use = [&](auto&& fn) {
        for (const std::uint32_t t : subset) {
            const Triangle& triangle = triangles[t];
            if (repeats_corner(triangle)) continue;
            for (std::uint8_t k = 0; k < 3; ++k) {
                const std::uint32_t from = triangle.v[k], to = triangle.v[(k + 1) % 3];
                fn(EdgeUse{std::min(from, to), std::max(from, to), group.empty() ? 0 : group[t], t, k,
                           from < to});
            }
        }
    };
    // Count, prefix sum, scatter by the lower end; the few uses of one vertex are then sorted directly.
    std::vector<std::size_t> begin(static_cast<std::size_t>(id_count) + 1, 0);
    each_use([&](const EdgeUse& use) { ++begin[use.lo + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<EdgeUse> uses(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    each_use([&](const EdgeUse& use) { uses[next[use.lo]++] = use; });
    const auto key = [](const EdgeUse& u) { return std::tie(u.hi, u.group, u.triangle, u.corner); };
    for (std::size_t v = 0; v < id_count; ++v) {
        std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                  uses.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
                  [&](const EdgeUse& a, const EdgeUse& b) { return key(a) < key(b); });
    }
    return uses;
}

std::vector<std::uint32_t> all_indices(std::size_t count) {
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
}

bool is_degenerate(Vec3f a, Vec3f b, Vec3f c) {
    const Vec3d p = to_double(a), q = to_double(b), r = to_double(c);
    const double longest = std::sqrt(std::max({dot(q - p, q - p), dot(r - q, r - q), dot(p - r, p - r)}));
    double largest = 0;
    for (const Vec3d v : {p, q, r}) {
        largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    }
    // Height over the longest edge against half a unit in the last place of the largest coordinate.
    const double twice_area = length(cross(q - p, r - p));
    return twice_area <= longest * largest * 0x1p-24;
}

}  // namespace obscura
