// Spectra of thirty-two rows, by blocks of 16 x 16 that are transposed. See row_spectra_ref.cpp.

#include "optics/row_spectra.h"

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Sixteen rows (every second one from `first` on), 16 columns from x on, transposed: out[16 i + l].
void load_block(const MaskRows& rows, int first, int x, float* out) {
    alignas(64) float block[256];
    for (int l = 0; l < 16; ++l) {
        const int row = 2 * l + first;
        const float* from = rows.first + row * rows.stride + x;
        if (row >= rows.count) {
            store(block + 16 * l, splat(0.0f));
        } else if (x + 16 <= rows.width) {
            store(block + 16 * l, load(from));
        } else {
            for (int i = 0; i < 16; ++i)
                block[16 * l + i] = x + i < rows.width ? from[i] : 0.0f;
        }
    }
    transpose(block, out);
}

/// X = A + i B of two real rows, one pair per lane: A for parity 0, B for 1.
OBSCURA_INLINE void split(const F32& a, const F32& b, const F32& c, const F32& d, int parity, float* re,
                          float* im) {
    const F32 half = splat(0.5f);
    store(re, half * (parity == 0 ? a + c : b + d));
    store(im, half * (parity == 0 ? b - d : c - a));
}

}  // namespace

void load_rows16(const MaskRows& rows, int length, float* re, float* im) noexcept {
    alignas(64) float block[256];
    for (int x = 0; x < length; x += 16) {
        const int columns = length - x < 16 ? length - x : 16;
        for (int parity = 0; parity < 2; ++parity) {
            float* out = (parity == 0 ? re : im) + 16 * x;
            if (x >= rows.width) {
                for (int i = 0; i < columns; ++i)
                    store(out + 16 * i, splat(0.0f));
                continue;
            }
            load_block(rows, parity, x, block);
            for (int i = 0; i < columns; ++i)
                store(out + 16 * i, load(block + 16 * i));
        }
    }
}

void split_rows16(const float* re, const float* im, int log2_length, const std::uint32_t* position,
                  const SpectraTarget& target) noexcept {
    const int length = 1 << log2_length;
    const int groups = length >= 32 ? length / 32 : 1;
    const int used = length > 1 ? length / 2 : 1;
    alignas(64) float block_re[256], block_im[256], turned_re[256], turned_im[256];
    for (int group = 0; group < groups; ++group) {
        for (int parity = 0; parity < 2; ++parity) {
            for (int i = 0; i < 16; ++i) {
                const int j = 16 * group + i;
                if (j >= used) {
                    store(block_re + 16 * i, splat(0.0f));
                    store(block_im + 16 * i, splat(0.0f));
                    continue;
                }
                const std::size_t at = std::size_t{16} * position[j];
                const std::size_t opposite = std::size_t{16} * position[(length - j) & (length - 1)];
                split(load(re + at), load(im + at), load(re + opposite), load(im + opposite), parity,
                      block_re + 16 * i, block_im + 16 * i);
                if (j == 0 && length > 1) {
                    const std::size_t half = std::size_t{16} * position[length / 2];
                    store(block_im, load((parity == 0 ? re : im) + half));
                }
            }
            transpose(block_re, turned_re);
            transpose(block_im, turned_im);
            for (int l = 0; 2 * l + parity < target.count; ++l) {
                const std::ptrdiff_t to =
                    (std::ptrdiff_t{group} * target.height + target.first_row + 2 * l + parity) * 16;
                store(target.re + to, load(turned_re + 16 * l));
                store(target.im + to, load(turned_im + 16 * l));
            }
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
