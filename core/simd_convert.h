#pragma once
// Sixteen lanes: from one type to another. Include core/simd.h.

#include "core/simd_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE I32 bitcast_i32(const F32& a) {
    I32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::bitwise_cast<I32::Reg>(a.r[k]);
    return v;
}
OBSCURA_INLINE F32 bitcast_f32(const I32& a) {
    F32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::bitwise_cast<F32::Reg>(a.r[k]);
    return v;
}
/// Rounds to nearest, ties to even.
OBSCURA_INLINE F32 to_f32(const I32& a) {
    F32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::to_float(a.r[k]);
    return v;
}
/// Cuts towards zero; |a| must be below 2^31.
OBSCURA_INLINE I32 to_i32(const F32& a) {
    I32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::to_int(a.r[k]);
    return v;
}
/// Rounds to nearest, ties to even.
OBSCURA_INLINE F32 to_f32(const F64& a) {
    F32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = F32::Reg(
        _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(a.r[0])), _mm512_cvtpd_ps(a.r[1]), 1));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        v.r[k] = F32::Reg(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(a.r[2 * k])),
                                               _mm256_cvtpd_ps(a.r[2 * k + 1]), 1));
    }
#else
    for (int k = 0; k < 4; ++k) {
        v.r[k] = F32::Reg(_mm_movelh_ps(_mm_cvtpd_ps(a.r[2 * k]), _mm_cvtpd_ps(a.r[2 * k + 1])));
    }
#endif
    return v;
}
OBSCURA_INLINE F64 to_f64(const F32& a) {
    F64 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = F64::Reg(_mm512_cvtps_pd(_mm512_castps512_ps256(a.r[0])));
    v.r[1] = F64::Reg(_mm512_cvtps_pd(_mm512_extractf32x8_ps(a.r[0], 1)));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        v.r[2 * k] = F64::Reg(_mm256_cvtps_pd(_mm256_castps256_ps128(a.r[k])));
        v.r[2 * k + 1] = F64::Reg(_mm256_cvtps_pd(_mm256_extractf128_ps(a.r[k], 1)));
    }
#else
    for (int k = 0; k < 4; ++k) {
        v.r[2 * k] = F64::Reg(_mm_cvtps_pd(a.r[k]));
        v.r[2 * k + 1] = F64::Reg(_mm_cvtps_pd(_mm_movehl_ps(a.r[k], a.r[k])));
    }
#endif
    return v;
}
OBSCURA_INLINE F64 to_f64(const I32& a) {
    F64 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = F64::Reg(_mm512_cvtepi32_pd(_mm512_castsi512_si256(a.r[0])));
    v.r[1] = F64::Reg(_mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(a.r[0], 1)));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        v.r[2 * k] = F64::Reg(_mm256_cvtepi32_pd(_mm256_castsi256_si128(a.r[k])));
        v.r[2 * k + 1] = F64::Reg(_mm256_cvtepi32_pd(_mm256_extracti128_si256(a.r[k], 1)));
    }
#else
    for (int k = 0; k < 4; ++k) {
        v.r[2 * k] = F64::Reg(_mm_cvtepi32_pd(a.r[k]));
        v.r[2 * k + 1] = F64::Reg(_mm_cvtepi32_pd(_mm_shuffle_epi32(a.r[k], _MM_SHUFFLE(3, 2, 3, 2))));
    }
#endif
    return v;
}
/// Rounds to nearest, ties to even; |a| must be below 2^31.
OBSCURA_INLINE I32 round_to_i32(const F64& a) {
    I32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = I32::Reg(_mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtpd_epi32(a.r[0])),
                                         _mm512_cvtpd_epi32(a.r[1]), 1));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        v.r[k] = I32::Reg(_mm256_inserti128_si256(_mm256_castsi128_si256(_mm256_cvtpd_epi32(a.r[2 * k])),
                                                  _mm256_cvtpd_epi32(a.r[2 * k + 1]), 1));
    }
#else
    for (int k = 0; k < 4; ++k) {
        v.r[k] = I32::Reg(_mm_unpacklo_epi64(_mm_cvtpd_epi32(a.r[2 * k]), _mm_cvtpd_epi32(a.r[2 * k + 1])));
    }
#endif
    return v;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
