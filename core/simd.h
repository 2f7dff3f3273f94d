#pragma once
// Sixteen lanes, on every machine: the vocabulary that kernels are written in.
//
// A kernel file is compiled once per instruction set with OBSCURA_ISA = sse2, avx2 or avx512bw (see
// add_simd_kernels). One logical vector of 16 lanes is 4, 2 or 1 registers, so tails and reductions have one
// order everywhere and the results are the same bits. Everything here has internal linkage: a wide object
// must leave no symbol that the linker could hand to code meant for a lesser machine.
//
// F32, I32, F64, I64: 16 lanes each. Mask: 16 booleans. min/max follow SSE: min(a, b) = a < b ? a : b, so
// with a NaN the second operand wins; the scalar twins in core/scalar_lanes.h agree.
//
// xsimd 8.1 has no bit mask of batch_bool, no gather and no 64-bit sign test; those are intrinsics below.

#ifndef OBSCURA_ISA
#error "core/simd.h is for kernel files: build them with add_simd_kernels()"
#endif

#include <immintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#define OBSCURA_INLINE inline __attribute__((always_inline))

namespace obscura::OBSCURA_ISA {
namespace {

using Arch = xsimd::OBSCURA_ISA;

constexpr int lanes = 16;

template <class T>
struct Lanes {
    using Reg = xsimd::batch<T, Arch>;
    static constexpr int regs = lanes / static_cast<int>(Reg::size);
    static constexpr int width = static_cast<int>(Reg::size);
    Reg r[regs];
};

using F32 = Lanes<float>;
using I32 = Lanes<std::int32_t>;
using F64 = Lanes<double>;
using I64 = Lanes<std::int64_t>;

/// 16 booleans in the form that 32-bit comparisons produce.
struct Mask {
    using Reg = xsimd::batch_bool<float, Arch>;
    Reg r[F32::regs];
};

// --- memory ------------------------------------------------------------------------------------------------

template <class V, class T>
OBSCURA_INLINE V splat_as(T value) {
    V v;
    for (auto& reg : v.r)
        reg = typename V::Reg(value);
    return v;
}
OBSCURA_INLINE F32 splat(float value) {
    return splat_as<F32>(value);
}
OBSCURA_INLINE I32 splat(std::int32_t value) {
    return splat_as<I32>(value);
}
OBSCURA_INLINE F64 splat(double value) {
    return splat_as<F64>(value);
}
OBSCURA_INLINE I64 splat(std::int64_t value) {
    return splat_as<I64>(value);
}

template <class T>
OBSCURA_INLINE Lanes<T> load(const T* p) {
    Lanes<T> v;
    for (int k = 0; k < Lanes<T>::regs; ++k) {
        v.r[k] = Lanes<T>::Reg::load_unaligned(p + k * Lanes<T>::width);
    }
    return v;
}
template <class T>
OBSCURA_INLINE void store(T* p, const Lanes<T>& v) {
    for (int k = 0; k < Lanes<T>::regs; ++k)
        v.r[k].store_unaligned(p + k * Lanes<T>::width);
}
/// Past the caches: for what is not read again soon. p must be aligned to 64 bytes.
OBSCURA_INLINE void store_streaming(float* p, const F32& v) {
#if defined(OBSCURA_ISA_avx512bw)
    _mm512_stream_ps(p, v.r[0]);
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k)
        _mm256_stream_ps(p + 8 * k, v.r[k]);
#else
    for (int k = 0; k < 4; ++k)
        _mm_stream_ps(p + 4 * k, v.r[k]);
#endif
}
/// a0 b0 a1 b1 ... a15 b15.
OBSCURA_INLINE void store_interleaved(float* p, const F32& a, const F32& b) {
#if defined(OBSCURA_ISA_avx512bw)
    const __m512i low = _mm512_set_epi32(23, 7, 22, 6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
    const __m512i high = _mm512_set_epi32(31, 15, 30, 14, 29, 13, 28, 12, 27, 11, 26, 10, 25, 9, 24, 8);
    _mm512_storeu_ps(p, _mm512_permutex2var_ps(a.r[0], low, b.r[0]));
    _mm512_storeu_ps(p + 16, _mm512_permutex2var_ps(a.r[0], high, b.r[0]));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        const __m256 low = _mm256_unpacklo_ps(a.r[k], b.r[k]), high = _mm256_unpackhi_ps(a.r[k], b.r[k]);
        _mm256_storeu_ps(p + 16 * k, _mm256_permute2f128_ps(low, high, 0x20));
        _mm256_storeu_ps(p + 16 * k + 8, _mm256_permute2f128_ps(low, high, 0x31));
    }
#else
    for (int k = 0; k < 4; ++k) {
        _mm_storeu_ps(p + 8 * k, _mm_unpacklo_ps(a.r[k], b.r[k]));
        _mm_storeu_ps(p + 8 * k + 4, _mm_unpackhi_ps(a.r[k], b.r[k]));
    }
#endif
}
/// 0, 1, ..., 15.
OBSCURA_INLINE I32 lane_index() {
    alignas(64) static constexpr std::int32_t index[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                           8, 9, 10, 11, 12, 13, 14, 15};
    return load(index);
}

// --- arithmetic --------------------------------------------------------------------------------------------

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

// --- comparison and choice ---------------------------------------------------------------------------------

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

// --- conversion --------------------------------------------------------------------------------------------

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

// --- gather ------------------------------------------------------------------------------------------------

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

}  // namespace
}  // namespace obscura::OBSCURA_ISA
