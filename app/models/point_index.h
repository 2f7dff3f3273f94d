#pragma once
// Points that are equal numbers become one: for files that repeat a corner for every triangle.

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/vec.h"

namespace obscura {

class PointIndex {
  public:
    /// Index of p among `points`, to which new ones are added. 0 and -0 are one number.
    std::int32_t index_of(Vec3d p, std::vector<Vec3d>& points) {
        const std::array<std::uint64_t, 3> bits = {std::bit_cast<std::uint64_t>(p.x + 0.0),
                                                   std::bit_cast<std::uint64_t>(p.y + 0.0),
                                                   std::bit_cast<std::uint64_t>(p.z + 0.0)};
        const auto [at, is_new] = known_.try_emplace(bits, static_cast<std::int32_t>(points.size()));
        if (is_new) points.push_back(p);
        return at->second;
    }
    /// What comes is not joined with what was.
    void forget() { known_.clear(); }

  private:
    struct Hash {
        std::size_t operator()(const std::array<std::uint64_t, 3>& bits) const {
            std::uint64_t h = 0;
            for (const std::uint64_t b : bits)
                h = (h ^ b ^ b >> 29) * 0x9e3779b97f4a7c15u;
            return static_cast<std::size_t>(h ^ h >> 32);
        }
    };
    std::unordered_map<std::array<std::uint64_t, 3>, std::int32_t, Hash> known_;
};

}  // namespace obscura
