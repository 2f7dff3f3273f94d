#pragma once
// Sixteen lanes: from sixteen places. Include core/simd.h.

#include <cstddef>

#include "core/simd_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// base[index[i]] for every lane; all indices must be valid.
OBSCURA_INLINE F32 gather(const float* base, const I32& index) {
    F32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = F32::Reg(_mm512_i32gather_ps(index.r[0], base, 4));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k)
        v.r[k] = F32::Reg(_mm256_i32gather_ps(base, index.r[k], 4));
#else
    alignas(64) std::int32_t at[16];
    alignas(64) float value[16];
    store(at, index);
    for (int k = 0; k < 16; ++k)
        value[k] = base[at[k]];
    v = load(value);
#endif
    return v;
}
OBSCURA_INLINE I32 gather(const std::int32_t* base, const I32& index) {
    I32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = I32::Reg(_mm512_i32gather_epi32(index.r[0], base, 4));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k)
        v.r[k] = I32::Reg(_mm256_i32gather_epi32(base, index.r[k], 4));
#else
    alignas(64) std::int32_t at[16];
    alignas(64) std::int32_t value[16];
    store(at, index);
    for (int k = 0; k < 16; ++k)
        value[k] = base[at[k]];
    v = load(value);
#endif
    return v;
}

/// The 32 bits at base + step * index[i], for every lane; step is 1, 4 or 8 bytes, any alignment.
template <int step>
OBSCURA_INLINE I32 gather_bytes(const std::uint8_t* base, const I32& index) {
    I32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = I32::Reg(_mm512_i32gather_epi32(index.r[0], base, step));
#elif defined(OBSCURA_ISA_avx2)
    const auto* words = reinterpret_cast<const int*>(base);
    for (int k = 0; k < 2; ++k)
        v.r[k] = I32::Reg(_mm256_i32gather_epi32(words, index.r[k], step));
#else
    alignas(64) std::int32_t at[16];
    store(at, index);
    for (int k = 0; k < 16; ++k)
        __builtin_memcpy(&at[k], base + static_cast<std::ptrdiff_t>(at[k]) * step, 4);
    v = load(at);
#endif
    return v;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
