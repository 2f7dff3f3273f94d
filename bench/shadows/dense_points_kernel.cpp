// One gather and one comparison for sixteen points.

#include "bench/shadows/dense_points.h"
#include "core/simd.h"

namespace obscura::OBSCURA_ISA {

void dense_visibility(const float* stored, std::int32_t size, const MapPoints& points,
                      std::uint16_t* lit) noexcept {
    const I32 blocks_across = splat(size / 4), three = splat(std::int32_t{3});
    std::size_t first = 0;
    for (; first + 16 <= points.count; first += 16) {
        const I32 x = load(points.x + first), y = load(points.y + first);
        const Mask inside = ~any_bit(x | y, splat(-size));
        const I32 block = shift_right<2>(y) * blocks_across + shift_right<2>(x);
        const I32 index = shift_left<4>(block) | shift_left<2>(y & three) | (x & three);
        const F32 depth = gather(stored, select(inside, index, splat(std::int32_t{0})));
        const std::uint32_t dark = bits(inside) & ~bits(less_equal(load(points.depth + first), depth));
        lit[first / 16] = static_cast<std::uint16_t>(~dark);
    }
    if (first == points.count) return;
    std::uint32_t word = 0;
    for (std::size_t i = first; i < points.count; ++i) {
        const std::int32_t x = points.x[i], y = points.y[i];
        const bool inside = ((x | y) & -size) == 0;
        const std::int32_t index = ((y >> 2) * (size / 4) + (x >> 2)) << 4 | (y & 3) << 2 | (x & 3);
        const bool is_lit = !inside || points.depth[i] <= stored[index];
        word |= (is_lit ? 1u : 0u) << (i - first);
    }
    lit[first / 16] = static_cast<std::uint16_t>(word);
}

}  // namespace obscura::OBSCURA_ISA
