#pragma once
// Sixteen rows of sixteen: rows become columns. Include core/simd.h.

#include "core/simd_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// to[16 i + j] = from[16 j + i]; both 256 floats, aligned to 16 bytes. In blocks of 4 x 4, whatever the
/// instruction set: wider shuffles need more steps than they save.
OBSCURA_INLINE void transpose(const float* from, float* to) {
    for (int i = 0; i < 16; i += 4) {
        for (int j = 0; j < 16; j += 4) {
            __m128 a = _mm_load_ps(from + 16 * j + i), b = _mm_load_ps(from + 16 * (j + 1) + i);
            __m128 c = _mm_load_ps(from + 16 * (j + 2) + i), d = _mm_load_ps(from + 16 * (j + 3) + i);
            _MM_TRANSPOSE4_PS(a, b, c, d);
            _mm_store_ps(to + 16 * i + j, a);
            _mm_store_ps(to + 16 * (i + 1) + j, b);
            _mm_store_ps(to + 16 * (i + 2) + j, c);
            _mm_store_ps(to + 16 * (i + 3) + j, d);
        }
    }
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
