#pragma once
// Sixteen lanes: comparisons, masks, choice. Include core/simd.h.

#include "core/simd_arithmetic.h"

namespace obscura::OBSCURA_ISA {
namespace {

#if defined(OBSCURA_ISA_avx512bw)
OBSCURA_INLINE Mask::Reg as_float_mask(const xsimd::batch_bool<std::int32_t, Arch>& m) {
    return Mask::Reg(static_cast<__mmask16>(m));
}
OBSCURA_INLINE xsimd::batch_bool<std::int32_t, Arch> as_int_mask(const Mask::Reg& m) {
    return xsimd::batch_bool<std::int32_t, Arch>(static_cast<__mmask16>(m));
}
#elif defined(OBSCURA_ISA_avx2)
OBSCURA_INLINE Mask::Reg as_float_mask(const xsimd::batch_bool<std::int32_t, Arch>& m) {
    return Mask::Reg(_mm256_castsi256_ps(m));
}
OBSCURA_INLINE xsimd::batch_bool<std::int32_t, Arch> as_int_mask(const Mask::Reg& m) {
    return xsimd::batch_bool<std::int32_t, Arch>(_mm256_castps_si256(m));
}
#else
OBSCURA_INLINE Mask::Reg as_float_mask(const xsimd::batch_bool<std::int32_t, Arch>& m) {
    return Mask::Reg(_mm_castsi128_ps(m));
}
OBSCURA_INLINE xsimd::batch_bool<std::int32_t, Arch> as_int_mask(const Mask::Reg& m) {
    return xsimd::batch_bool<std::int32_t, Arch>(_mm_castps_si128(m));
}
#endif

#define OBSCURA_COMPARE(NAME, OP)                          \
    OBSCURA_INLINE Mask NAME(const F32& a, const F32& b) { \
        Mask m;                                            \
        for (int k = 0; k < F32::regs; ++k)                \
            m.r[k] = a.r[k] OP b.r[k];                     \
        return m;                                          \
    }                                                      \
    OBSCURA_INLINE Mask NAME(const I32& a, const I32& b) { \
        Mask m;                                            \
        for (int k = 0; k < I32::regs; ++k)                \
            m.r[k] = as_float_mask(a.r[k] OP b.r[k]);      \
        return m;                                          \
    }
OBSCURA_COMPARE(less, <)
OBSCURA_COMPARE(less_equal, <=)
OBSCURA_COMPARE(equal, ==)
#undef OBSCURA_COMPARE

/// a >= b; false where either is a NaN.
OBSCURA_INLINE Mask greater_equal(const F64& a, const F64& b) {
    Mask m;
#if defined(OBSCURA_ISA_avx512bw)
    const unsigned lo = _mm512_cmp_pd_mask(a.r[0], b.r[0], _CMP_GE_OQ);
    const unsigned hi = _mm512_cmp_pd_mask(a.r[1], b.r[1], _CMP_GE_OQ);
    m.r[0] = Mask::Reg(static_cast<__mmask16>(lo | (hi << 8)));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        const __m256 lo = _mm256_castpd_ps(_mm256_cmp_pd(a.r[2 * k], b.r[2 * k], _CMP_GE_OQ));
        const __m256 hi = _mm256_castpd_ps(_mm256_cmp_pd(a.r[2 * k + 1], b.r[2 * k + 1], _CMP_GE_OQ));
        const __m256 picked = _mm256_shuffle_ps(lo, hi, _MM_SHUFFLE(2, 0, 2, 0));
        m.r[k] = Mask::Reg(
            _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(picked), _MM_SHUFFLE(3, 1, 2, 0))));
    }
#else
    for (int k = 0; k < 4; ++k) {
        const __m128 lo = _mm_castpd_ps(_mm_cmpge_pd(a.r[2 * k], b.r[2 * k]));
        const __m128 hi = _mm_castpd_ps(_mm_cmpge_pd(a.r[2 * k + 1], b.r[2 * k + 1]));
        m.r[k] = Mask::Reg(_mm_shuffle_ps(lo, hi, _MM_SHUFFLE(2, 0, 2, 0)));
    }
#endif
    return m;
}

OBSCURA_INLINE Mask operator&(const Mask& a, const Mask& b) {
    Mask m;
    for (int k = 0; k < F32::regs; ++k)
        m.r[k] = a.r[k] & b.r[k];
    return m;
}
OBSCURA_INLINE Mask operator|(const Mask& a, const Mask& b) {
    Mask m;
    for (int k = 0; k < F32::regs; ++k)
        m.r[k] = a.r[k] | b.r[k];
    return m;
}
OBSCURA_INLINE Mask operator~(const Mask& a) {
    Mask m;
    for (int k = 0; k < F32::regs; ++k)
        m.r[k] = ~a.r[k];
    return m;
}

/// Lane i becomes bit i.
OBSCURA_INLINE std::uint32_t bits(const Mask& m) {
#if defined(OBSCURA_ISA_avx512bw)
    return static_cast<std::uint32_t>(static_cast<__mmask16>(m.r[0]));
#elif defined(OBSCURA_ISA_avx2)
    return static_cast<std::uint32_t>(_mm256_movemask_ps(m.r[0])) |
           (static_cast<std::uint32_t>(_mm256_movemask_ps(m.r[1])) << 8);
#else
    std::uint32_t all = 0;
    for (int k = 0; k < 4; ++k)
        all |= static_cast<std::uint32_t>(_mm_movemask_ps(m.r[k])) << (4 * k);
    return all;
#endif
}
/// Bit i becomes lane i; bits beyond the 16th are ignored.
OBSCURA_INLINE Mask mask_of(std::uint32_t lane_bits) {
#if defined(OBSCURA_ISA_avx512bw)
    return {{Mask::Reg(static_cast<__mmask16>(lane_bits))}};
#else
    alignas(64) static constexpr std::int32_t bit[16] = {1 << 0,  1 << 1,  1 << 2,  1 << 3, 1 << 4,  1 << 5,
                                                         1 << 6,  1 << 7,  1 << 8,  1 << 9, 1 << 10, 1 << 11,
                                                         1 << 12, 1 << 13, 1 << 14, 1 << 15};
    const I32 own = load(bit);
    return equal(splat(static_cast<std::int32_t>(lane_bits)) & own, own);
#endif
}
OBSCURA_INLINE bool any(const Mask& m) {
    return bits(m) != 0;
}
OBSCURA_INLINE bool all(const Mask& m) {
    return bits(m) == 0xffffu;
}
OBSCURA_INLINE bool none(const Mask& m) {
    return bits(m) == 0;
}

OBSCURA_INLINE F32 select(const Mask& m, const F32& a, const F32& b) {
    F32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::select(m.r[k], a.r[k], b.r[k]);
    return v;
}
OBSCURA_INLINE I32 select(const Mask& m, const I32& a, const I32& b) {
    I32 v;
    for (int k = 0; k < I32::regs; ++k) {
        v.r[k] = xsimd::select(as_int_mask(m.r[k]), a.r[k], b.r[k]);
    }
    return v;
}
/// Lanes in which a and b have a set bit in common.
OBSCURA_INLINE Mask any_bit(const I32& a, const I32& b) {
#if defined(OBSCURA_ISA_avx512bw)
    return {{Mask::Reg(_mm512_test_epi32_mask(a.r[0], b.r[0]))}};
#else
    return ~equal(a & b, splat(std::int32_t{0}));
#endif
}
/// Lanes whose sign bit is clear, that is >= 0.
OBSCURA_INLINE Mask not_negative(const I32& a) {
    Mask m;
#if defined(OBSCURA_ISA_avx512bw)
    m.r[0] = Mask::Reg(static_cast<__mmask16>(~_mm512_movepi32_mask(a.r[0])));
#else
    for (int k = 0; k < I32::regs; ++k) {
        m.r[k] = as_float_mask(a.r[k] > I32::Reg(-1));
    }
#endif
    return m;
}
OBSCURA_INLINE Mask not_negative(const I64& a) {
    Mask m;
#if defined(OBSCURA_ISA_avx512bw)
    const unsigned lo = _mm512_movepi64_mask(a.r[0]), hi = _mm512_movepi64_mask(a.r[1]);
    m.r[0] = Mask::Reg(static_cast<__mmask16>(~(lo | (hi << 8))));
#elif defined(OBSCURA_ISA_avx2)
    // The high halves hold the signs: pick them from pairs of registers, in lane order.
    for (int k = 0; k < 2; ++k) {
        const __m256 picked = _mm256_shuffle_ps(_mm256_castsi256_ps(a.r[2 * k]),
                                                _mm256_castsi256_ps(a.r[2 * k + 1]), _MM_SHUFFLE(3, 1, 3, 1));
        const __m256i ordered =
            _mm256_permute4x64_epi64(_mm256_castps_si256(picked), _MM_SHUFFLE(3, 1, 2, 0));
        m.r[k] = Mask::Reg(_mm256_castsi256_ps(_mm256_cmpgt_epi32(ordered, _mm256_set1_epi32(-1))));
    }
#else
    for (int k = 0; k < 4; ++k) {
        const __m128 picked = _mm_shuffle_ps(_mm_castsi128_ps(a.r[2 * k]), _mm_castsi128_ps(a.r[2 * k + 1]),
                                             _MM_SHUFFLE(3, 1, 3, 1));
        m.r[k] = Mask::Reg(_mm_castsi128_ps(_mm_cmpgt_epi32(_mm_castps_si128(picked), _mm_set1_epi32(-1))));
    }
#endif
    return m;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
