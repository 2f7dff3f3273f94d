// One lane at a time: what column_store_kernel.cpp does sixteen at a time.

#include "optics/column_store.h"

namespace obscura::ref {
namespace {

struct Complex {
    float re, im;
};

/// The first row at or below which sample k is shown; those after it follow every period.
int first_row(const SpectrumRows& rows, std::int64_t k) {
    const std::int64_t last = (std::int64_t{1} << rows.log2_period) - 1;
    return static_cast<int>((k - rows.first) & last);
}

/// Sample k of one lane into every row that shows it.
void put(const SpectrumRows& rows, std::int64_t k, const ColumnStrip& strip, int lane, Complex value,
         const FieldTarget& target) {
    if (strip.keep != nullptr && strip.keep[lane] == 0) return;
    const int column = strip.column + (strip.mirrored ? 15 - lane : lane);
    for (int r = first_row(rows, k); r < rows.count; r += 1 << rows.log2_period) {
        const std::ptrdiff_t at = r * target.stride + column;
        if (target.power != nullptr) {
            const float power = value.re * value.re + value.im * value.im;
            target.power[at] = power * strip.power[lane] * rows.power[r];
        }
        if (target.re != nullptr) {
            const float a = value.re * strip.re[lane] - value.im * strip.im[lane];
            const float b = value.re * strip.im[lane] + value.im * strip.re[lane];
            target.re[at] = a * rows.re[r] - b * rows.im[r];
            target.im[at] = a * rows.im[r] + b * rows.re[r];
        }
    }
}

}  // namespace

void store_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows,
                     const FieldTarget& target) noexcept {
    for (std::int64_t k = 0; k < std::int64_t{1} << rows.log2_period; ++k) {
        const std::uint32_t at = 16 * rows.position[k];
        for (const SpectrumBlock* block = blocks; block != blocks + count; ++block) {
            for (int s = 0; s < block->strip_count; ++s) {
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    const float a = block->re[at + lane], b = block->im[at + lane];
                    const ColumnStrip& strip = block->strips[s];
                    if (strip.mirrored)
                        put(rows, -k, strip, static_cast<int>(lane), {a, 0.0f - b}, target);
                    else
                        put(rows, k, strip, static_cast<int>(lane), {a, b}, target);
                }
            }
        }
    }
}

void store_real_columns16(const SpectrumBlock* blocks, int count, const SpectrumRows& rows,
                          const FieldTarget& target) noexcept {
    const std::int64_t period = std::int64_t{1} << rows.log2_period;
    for (std::int64_t k = 0; k <= period / 2; ++k) {
        const std::int64_t other = (period - k) & (period - 1);
        for (const SpectrumBlock* block = blocks; block != blocks + count; ++block) {
            for (int s = 0; s < block->strip_count + block->partner_count; ++s) {
                const bool own = s < block->strip_count;
                const ColumnStrip& strip =
                    own ? block->strips[s] : block->partner_strips[s - block->strip_count];
                for (std::uint32_t lane = 0; lane < 16; ++lane) {
                    // X = A + i B, A and B with conjugate symmetry: X(k) and X(-k) tell them apart.
                    const std::uint32_t at = 16 * rows.position[k] + lane;
                    const std::uint32_t opposite = 16 * rows.position[other] + lane;
                    const float a = block->re[at], b = block->im[at];
                    const float c = block->re[opposite], d = block->im[opposite];
                    const Complex value = own ? Complex{0.5f * (a + c), 0.5f * (b - d)}
                                              : Complex{0.5f * (b + d), 0.5f * (c - a)};
                    put(rows, k, strip, static_cast<int>(lane), value, target);
                    if (other != k)
                        put(rows, -k, strip, static_cast<int>(lane), {value.re, 0.0f - value.im}, target);
                }
            }
        }
    }
}

}  // namespace obscura::ref
