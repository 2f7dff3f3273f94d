// Spectra of sixteen columns into the pixels that repeat them. See column_store_ref.cpp for the meaning.

#include "optics/column_store.h"

#include <cstddef>

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE int first_row(const SpectrumRows& rows, std::int64_t k) {
    const std::int64_t last = (std::int64_t{1} << rows.log2_period) - 1;
    return static_cast<int>((k - rows.first) & last);
}

/// All lanes of a strip, or those that it keeps.
OBSCURA_INLINE void store_kept(float* to, const F32& value, const ColumnStrip& strip) {
    const F32 ordered = strip.mirrored ? reverse(value) : value;
    if (strip.keep == nullptr) {
        store(to, ordered);
        return;
    }
    alignas(64) float lanes_of[16];
    store(lanes_of, ordered);
    for (int l = 0; l < 16; ++l) {
        if (strip.keep[strip.mirrored ? 15 - l : l] != 0) to[l] = lanes_of[l];
    }
}

/// Sample k of a strip into every row that shows it.
OBSCURA_INLINE void put(const SpectrumRows& rows, std::int64_t k, const ColumnStrip& strip, const F32& re,
                        const F32& im, const FieldTarget& target) {
    const int step = 1 << rows.log2_period;
    const int first = first_row(rows, k);
    if (target.power != nullptr) {
        const F32 power = (re * re + im * im) * load(strip.power);
        for (int r = first; r < rows.count; r += step) {
            store_kept(target.power + (r * target.stride + strip.column), power * splat(rows.power[r]),
                       strip);
        }
    }
    if (target.re != nullptr) {
        const F32 c = load(strip.re), d = load(strip.im);
        const F32 a = re * c - im * d, b = re * d + im * c;
        for (int r = first; r < rows.count; r += step) {
            const std::ptrdiff_t at = r * target.stride + strip.column;
            const F32 e = splat(rows.re[r]), f = splat(rows.im[r]);
            store_kept(target.re + at, a * e - b * f, strip);
            store_kept(target.im + at, a * f + b * e, strip);
        }
    }
}

}  // namespace

void store_columns16(const float* re, const float* im, const SpectrumRows& rows, const ColumnStrip* strips,
                     int strip_count, const FieldTarget& target) noexcept {
    for (std::int64_t k = 0; k < std::int64_t{1} << rows.log2_period; ++k) {
        const std::size_t at = std::size_t{16} * rows.position[k];
        const F32 a = load(re + at), b = load(im + at);
        for (int s = 0; s < strip_count; ++s) {
            if (strips[s].mirrored)
                put(rows, -k, strips[s], a, splat(0.0f) - b, target);
            else
                put(rows, k, strips[s], a, b, target);
        }
    }
}

void store_real_columns16(const float* re, const float* im, const SpectrumRows& rows,
                          const ColumnStrip* strips, int strip_count, const ColumnStrip* partner_strips,
                          int partner_count, const FieldTarget& target) noexcept {
    const std::int64_t period = std::int64_t{1} << rows.log2_period;
    const F32 half = splat(0.5f), zero = splat(0.0f);
    for (std::int64_t k = 0; k <= period / 2; ++k) {
        const std::int64_t other = (period - k) & (period - 1);
        const std::size_t at = std::size_t{16} * rows.position[k];
        const std::size_t opposite = std::size_t{16} * rows.position[other];
        const F32 a = load(re + at), b = load(im + at), c = load(re + opposite), d = load(im + opposite);
        // X = A + i B, A and B with conjugate symmetry: X(k) and X(-k) tell them apart.
        const F32 value_re[2] = {half * (a + c), half * (b + d)};
        const F32 value_im[2] = {half * (b - d), half * (c - a)};
        for (int s = 0; s < strip_count + partner_count; ++s) {
            const int group = s < strip_count ? 0 : 1;
            const ColumnStrip& strip = group == 0 ? strips[s] : partner_strips[s - strip_count];
            put(rows, k, strip, value_re[group], value_im[group], target);
            if (other != k) put(rows, -k, strip, value_re[group], zero - value_im[group], target);
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
