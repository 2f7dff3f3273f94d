#pragma once
// Sixteen lanes: sums, products, bits. Include core/simd.h.

#include "core/simd_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

#define OBSCURA_BINARY(OP)                                                      \
    template <class T>                                                          \
    OBSCURA_INLINE Lanes<T> operator OP(const Lanes<T>& a, const Lanes<T>& b) { \
        Lanes<T> v;                                                             \
        for (int k = 0; k < Lanes<T>::regs; ++k)                                \
            v.r[k] = a.r[k] OP b.r[k];                                          \
        return v;                                                               \
    }
OBSCURA_BINARY(+)
OBSCURA_BINARY(-)
OBSCURA_BINARY(*)
OBSCURA_BINARY(/)
OBSCURA_BINARY(&)
OBSCURA_BINARY(|)
OBSCURA_BINARY(^)
#undef OBSCURA_BINARY

/// Products wrap, as sums do: without a vector instruction for it (SSE2) lanes are multiplied one by one,
/// where signed integers must not overflow.
OBSCURA_INLINE I32 operator*(const I32& a, const I32& b) {
    using Unsigned = xsimd::batch<std::uint32_t, I32::Reg::arch_type>;
    I32 v;
    for (int k = 0; k < I32::regs; ++k)
        v.r[k] = xsimd::bitwise_cast<I32::Reg>(xsimd::bitwise_cast<Unsigned>(a.r[k]) *
                                               xsimd::bitwise_cast<Unsigned>(b.r[k]));
    return v;
}

template <class T>
OBSCURA_INLINE Lanes<T> min(const Lanes<T>& a, const Lanes<T>& b) {
    Lanes<T> v;
    for (int k = 0; k < Lanes<T>::regs; ++k)
        v.r[k] = xsimd::min(a.r[k], b.r[k]);
    return v;
}
template <class T>
OBSCURA_INLINE Lanes<T> max(const Lanes<T>& a, const Lanes<T>& b) {
    Lanes<T> v;
    for (int k = 0; k < Lanes<T>::regs; ++k)
        v.r[k] = xsimd::max(a.r[k], b.r[k]);
    return v;
}
template <class T>
OBSCURA_INLINE Lanes<T> sqrt(const Lanes<T>& a) {
    Lanes<T> v;
    for (int k = 0; k < Lanes<T>::regs; ++k)
        v.r[k] = xsimd::sqrt(a.r[k]);
    return v;
}
OBSCURA_INLINE F32 abs(const F32& a) {
    F32 v;
    for (int k = 0; k < F32::regs; ++k)
        v.r[k] = xsimd::abs(a.r[k]);
    return v;
}
template <int bits>
OBSCURA_INLINE I32 shift_left(const I32& a) {
    I32 v;
    for (int k = 0; k < I32::regs; ++k)
        v.r[k] = a.r[k] << bits;
    return v;
}
/// Arithmetic shift: the sign is kept.
template <int bits>
OBSCURA_INLINE I32 shift_right(const I32& a) {
    I32 v;
    for (int k = 0; k < I32::regs; ++k)
        v.r[k] = a.r[k] >> bits;
    return v;
}

/// Fills with zeros from above.
template <int bits>
OBSCURA_INLINE I32 shift_right_logical(const I32& a) {
    I32 v;
    for (int k = 0; k < I32::regs; ++k) {
#if defined(OBSCURA_ISA_avx512bw)
        v.r[k] = I32::Reg(_mm512_srli_epi32(a.r[k], bits));
#elif defined(OBSCURA_ISA_avx2)
        v.r[k] = I32::Reg(_mm256_srli_epi32(a.r[k], bits));
#else
        v.r[k] = I32::Reg(_mm_srli_epi32(a.r[k], bits));
#endif
    }
    return v;
}
/// Every lane by the same number of bits, 0 to 31, not known in advance; the sign is kept.
OBSCURA_INLINE I32 shift_right(const I32& a, std::int32_t bits) {
    I32 v;
    const __m128i count = _mm_cvtsi32_si128(bits);
    for (int k = 0; k < I32::regs; ++k) {
#if defined(OBSCURA_ISA_avx512bw)
        v.r[k] = I32::Reg(_mm512_sra_epi32(a.r[k], count));
#elif defined(OBSCURA_ISA_avx2)
        v.r[k] = I32::Reg(_mm256_sra_epi32(a.r[k], count));
#else
        v.r[k] = I32::Reg(_mm_sra_epi32(a.r[k], count));
#endif
    }
    return v;
}
OBSCURA_INLINE I32 shift_left(const I32& a, std::int32_t bits) {
    I32 v;
    const __m128i count = _mm_cvtsi32_si128(bits);
    for (int k = 0; k < I32::regs; ++k) {
#if defined(OBSCURA_ISA_avx512bw)
        v.r[k] = I32::Reg(_mm512_sll_epi32(a.r[k], count));
#elif defined(OBSCURA_ISA_avx2)
        v.r[k] = I32::Reg(_mm256_sll_epi32(a.r[k], count));
#else
        v.r[k] = I32::Reg(_mm_sll_epi32(a.r[k], count));
#endif
    }
    return v;
}
/// Every lane by its own number of bits, 0 to 31; fills with zeros from above.
OBSCURA_INLINE I32 shift_right_logical(const I32& a, const I32& bits) {
    I32 v;
#if defined(OBSCURA_ISA_avx512bw)
    v.r[0] = I32::Reg(_mm512_srlv_epi32(a.r[0], bits.r[0]));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k)
        v.r[k] = I32::Reg(_mm256_srlv_epi32(a.r[k], bits.r[k]));
#else
    alignas(64) std::int32_t value[16], count[16];
    store(value, a);
    store(count, bits);
    for (int k = 0; k < 16; ++k)
        value[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(value[k]) >> count[k]);
    v = load(value);
#endif
    return v;
}
/// table[index[i]] for every lane, indices 0 to 15; table[0] must be 0.
OBSCURA_INLINE I32 small_table(const std::uint8_t (&table)[16], const I32& index) {
    I32 v;
#if defined(OBSCURA_ISA_avx512bw)
    const __m128i entries = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    v.r[0] = I32::Reg(_mm512_shuffle_epi8(_mm512_broadcast_i32x4(entries), index.r[0]));
#elif defined(OBSCURA_ISA_avx2)
    const __m128i entries = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    for (int k = 0; k < 2; ++k)
        v.r[k] = I32::Reg(_mm256_shuffle_epi8(_mm256_broadcastsi128_si256(entries), index.r[k]));
#else
    alignas(64) std::int32_t at[16];
    store(at, index);
    for (int k = 0; k < 16; ++k)
        at[k] = table[at[k]];
    v = load(at);
#endif
    return v;
}
/// Bits that are set in any lane.
OBSCURA_INLINE std::uint32_t united_bits(const I32& a) {
#if defined(OBSCURA_ISA_avx512bw)
    const __m256i half =
        _mm256_or_si256(_mm512_castsi512_si256(a.r[0]), _mm512_extracti64x4_epi64(a.r[0], 1));
    const __m128i q = _mm_or_si128(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
#elif defined(OBSCURA_ISA_avx2)
    const __m256i half = _mm256_or_si256(a.r[0], a.r[1]);
    const __m128i q = _mm_or_si128(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
#else
    const __m128i q = _mm_or_si128(_mm_or_si128(a.r[0], a.r[1]), _mm_or_si128(a.r[2], a.r[3]));
#endif
    const __m128i d = _mm_or_si128(q, _mm_shuffle_epi32(q, _MM_SHUFFLE(1, 0, 3, 2)));
    return static_cast<std::uint32_t>(
        _mm_cvtsi128_si32(_mm_or_si128(d, _mm_shuffle_epi32(d, _MM_SHUFFLE(2, 3, 0, 1)))));
}

/// Least and greatest of all lanes; of floats no lane may be a NaN.
OBSCURA_INLINE float lowest(const F32& a) {
#if defined(OBSCURA_ISA_avx512bw)
    const __m256 half = _mm256_min_ps(_mm512_castps512_ps256(a.r[0]), _mm512_extractf32x8_ps(a.r[0], 1));
    const __m128 q = _mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
#elif defined(OBSCURA_ISA_avx2)
    const __m256 half = _mm256_min_ps(a.r[0], a.r[1]);
    const __m128 q = _mm_min_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1));
#else
    const __m128 q = _mm_min_ps(_mm_min_ps(a.r[0], a.r[1]), _mm_min_ps(a.r[2], a.r[3]));
#endif
    const __m128 d = _mm_min_ps(q, _mm_movehl_ps(q, q));
    return _mm_cvtss_f32(_mm_min_ss(d, _mm_shuffle_ps(d, d, 1)));
}
OBSCURA_INLINE float highest(const F32& a) {
    return -lowest(splat(-0.0f) ^ a);
}
OBSCURA_INLINE std::int32_t lowest(const I32& a) {
#if defined(OBSCURA_ISA_avx512bw)
    const __m256i half =
        _mm256_min_epi32(_mm512_castsi512_si256(a.r[0]), _mm512_extracti64x4_epi64(a.r[0], 1));
    const __m128i q = _mm_min_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
#elif defined(OBSCURA_ISA_avx2)
    const __m256i half = _mm256_min_epi32(a.r[0], a.r[1]);
    const __m128i q = _mm_min_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
#else
    const __m128i q = xsimd::min(xsimd::min(a.r[0], a.r[1]), xsimd::min(a.r[2], a.r[3]));
#endif
    alignas(16) std::int32_t v[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(v), q);
    const std::int32_t x = v[0] < v[1] ? v[0] : v[1], y = v[2] < v[3] ? v[2] : v[3];
    return x < y ? x : y;
}
/// ~a turns the order round.
OBSCURA_INLINE std::int32_t highest(const I32& a) {
    return ~lowest(a ^ splat_as<I32>(std::int32_t{-1}));
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
