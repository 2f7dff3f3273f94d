#include "bench/shadows/dense_points.h"

namespace obscura::ref {

void dense_visibility(const float* stored, std::int32_t size, const MapPoints& points,
                      std::uint16_t* lit) noexcept {
    for (std::size_t first = 0; first < points.count; first += 16) {
        std::uint32_t word = 0;
        for (std::size_t i = first; i < points.count && i < first + 16; ++i) {
            const std::int32_t x = points.x[i], y = points.y[i];
            const bool inside = ((x | y) & -size) == 0;
            const std::int32_t index = ((y >> 2) * (size / 4) + (x >> 2)) << 4 | (y & 3) << 2 | (x & 3);
            const bool is_lit = !inside || points.depth[i] <= stored[index];
            word |= (is_lit ? 1u : 0u) << (i - first);
        }
        lit[first / 16] = static_cast<std::uint16_t>(word);
    }
}

}  // namespace obscura::ref
