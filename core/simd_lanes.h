#pragma once
// Sixteen lanes: the types, and their way from and to memory. Include core/simd.h.

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
/// The inverse of store_interleaved: p[0] p[2] ... p[30], and p[1] p[3] ... p[31].
OBSCURA_INLINE void load_deinterleaved(const float* p, F32& even, F32& odd) {
#if defined(OBSCURA_ISA_avx512bw)
    const __m512i first = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
    const __m512i second = _mm512_set_epi32(31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1);
    const __m512 a = _mm512_loadu_ps(p), b = _mm512_loadu_ps(p + 16);
    even.r[0] = F32::Reg(_mm512_permutex2var_ps(a, first, b));
    odd.r[0] = F32::Reg(_mm512_permutex2var_ps(a, second, b));
#elif defined(OBSCURA_ISA_avx2)
    for (int k = 0; k < 2; ++k) {
        const __m256 a = _mm256_loadu_ps(p + 16 * k), b = _mm256_loadu_ps(p + 16 * k + 8);
        const __m256 low = _mm256_permute2f128_ps(a, b, 0x20), high = _mm256_permute2f128_ps(a, b, 0x31);
        even.r[k] = F32::Reg(_mm256_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0)));
        odd.r[k] = F32::Reg(_mm256_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1)));
    }
#else
    for (int k = 0; k < 4; ++k) {
        const __m128 a = _mm_loadu_ps(p + 8 * k), b = _mm_loadu_ps(p + 8 * k + 4);
        even.r[k] = F32::Reg(_mm_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0)));
        odd.r[k] = F32::Reg(_mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1)));
    }
#endif
}
/// Lane 15 first, lane 0 last.
OBSCURA_INLINE F32 reverse(const F32& a) {
    F32 v;
#if defined(OBSCURA_ISA_avx512bw)
    const __m512i order = _mm512_set_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    v.r[0] = F32::Reg(_mm512_permutexvar_ps(order, a.r[0]));
#elif defined(OBSCURA_ISA_avx2)
    const __m256i order = _mm256_set_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    for (int k = 0; k < 2; ++k)
        v.r[k] = F32::Reg(_mm256_permutevar8x32_ps(a.r[1 - k], order));
#else
    for (int k = 0; k < 4; ++k)
        v.r[k] = F32::Reg(_mm_shuffle_ps(a.r[3 - k], a.r[3 - k], _MM_SHUFFLE(0, 1, 2, 3)));
#endif
    return v;
}
/// 0, 1, ..., 15.
OBSCURA_INLINE I32 lane_index() {
    alignas(64) static constexpr std::int32_t index[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                           8, 9, 10, 11, 12, 13, 14, 15};
    return load(index);
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
