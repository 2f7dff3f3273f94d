// One lane at a time: what row_spectra_kernel.cpp does sixteen at a time.

#include "optics/row_spectra.h"

namespace obscura::ref {

void load_rows16(const MaskRows& rows, int length, float* re, float* im) noexcept {
    for (int x = 0; x < length; ++x) {
        for (int lane = 0; lane < 16; ++lane) {
            const float* even = rows.first + 2 * lane * rows.stride;
            re[16 * x + lane] = x < rows.width && 2 * lane < rows.count ? even[x] : 0.0f;
            im[16 * x + lane] = x < rows.width && 2 * lane + 1 < rows.count ? even[rows.stride + x] : 0.0f;
        }
    }
}

void split_rows16(const float* re, const float* im, int log2_length, const std::uint32_t* position,
                  const SpectraTarget& target) noexcept {
    const int length = 1 << log2_length;
    const int groups = length >= 32 ? length / 32 : 1;
    for (int row = 0; row < target.count; ++row) {
        for (int j = 0; j < 16 * groups; ++j) {
            const bool used = j < (length > 1 ? length / 2 : 1);
            float a = 0, b = 0;
            if (used) {
                // X = A + i B of two real rows: X(j) and X(-j) tell them apart.
                const std::uint32_t lane = static_cast<std::uint32_t>(row / 2);
                const std::uint32_t at = 16 * position[j] + lane;
                const std::uint32_t opposite = 16 * position[(length - j) & (length - 1)] + lane;
                const float c = re[opposite], d = im[opposite];
                a = 0.5f * (row % 2 == 0 ? re[at] + c : im[at] + d);
                b = 0.5f * (row % 2 == 0 ? im[at] - d : c - re[at]);
                if (j == 0 && length > 1) {
                    const std::uint32_t half = 16 * position[length / 2] + lane;
                    b = row % 2 == 0 ? re[half] : im[half];
                }
            }
            const std::ptrdiff_t to =
                (std::ptrdiff_t{j / 16} * target.height + target.first_row + row) * 16 + j % 16;
            target.re[to] = a;
            target.im[to] = b;
        }
    }
}

}  // namespace obscura::ref
