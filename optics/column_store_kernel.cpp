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

/// One sample of a strip into every row that shows it: `first` and those a period apart.
OBSCURA_INLINE void put(const SpectrumRows& rows, int first, const ColumnStrip& strip, const F32& re,
                        const F32& im, const FieldTarget& target) {
    const int step = 1 << rows.log2_period;
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

/// The strips of one group: sample k to its own rows, and its conjugate to those of -k.
OBSCURA_INLINE void put_both(const SpectrumRows& rows, int own, int opposite, const ColumnStrip* strips,
                             int count, const F32& re, const F32& im, bool twice, const FieldTarget& target) {
    const F32 conjugate = splat(0.0f) - im;
    for (int s = 0; s < count; ++s) {
        put(rows, own, strips[s], re, im, target);
        if (twice) put(rows, opposite, strips[s], re, conjugate, target);
    }
}

}  // namespace

void store_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows,
                     const FieldTarget& target) noexcept {
    for (std::int64_t k = 0; k < std::int64_t{1} << rows.log2_period; ++k) {
        const std::size_t at = std::size_t{16} * rows.position[k];
        const int own = first_row(rows, k), opposite = first_row(rows, -k);
        for (const SpectrumBlock* block = blocks; block != blocks + count; ++block) {
            const F32 a = load(block->re + at), b = load(block->im + at);
            for (int s = 0; s < block->strip_count; ++s) {
                const ColumnStrip& strip = block->strips[s];
                if (strip.mirrored)
                    put(rows, opposite, strip, a, splat(0.0f) - b, target);
                else
                    put(rows, own, strip, a, b, target);
            }
        }
    }
}

void store_real_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows,
                          const FieldTarget& target) noexcept {
    const std::int64_t period = std::int64_t{1} << rows.log2_period;
    const F32 half = splat(0.5f);
    for (std::int64_t k = 0; k <= period / 2; ++k) {
        const std::int64_t other = (period - k) & (period - 1);
        const std::size_t at = std::size_t{16} * rows.position[k];
        const std::size_t from_opposite = std::size_t{16} * rows.position[other];
        const int own = first_row(rows, k), opposite = first_row(rows, -k);
        for (const SpectrumBlock* block = blocks; block != blocks + count; ++block) {
            // X = A + i B, A and B with conjugate symmetry: X(k) and X(-k) tell them apart.
            const F32 a = load(block->re + at), b = load(block->im + at);
            const F32 c = load(block->re + from_opposite), d = load(block->im + from_opposite);
            put_both(rows, own, opposite, block->strips, block->strip_count, half * (a + c), half * (b - d),
                     other != k, target);
            put_both(rows, own, opposite, block->partner_strips, block->partner_count, half * (b + d),
                     half * (c - a), other != k, target);
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
