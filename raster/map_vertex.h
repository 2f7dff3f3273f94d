#pragma once
// A vertex in map space. POD: kernels include this.

#include <cstdint>

namespace obscura {

constexpr std::int32_t clip_near = 1, clip_guard = 2;

struct MapVertex {
    std::int32_t x = 0, y = 0;  ///< 24.8 fixed point; 0 where clip != 0
    float z = 0;                ///< depth, clamped to the view's range
    std::int32_t clip = 0;      ///< clip_near: before the near plane; clip_guard: outside the guard band
};

}  // namespace obscura
