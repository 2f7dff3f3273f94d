// Rows of amplitudes into a target.

#include "optics/field/field_rows.h"

#include <algorithm>

#include "core/parallel.h"

namespace obscura {

void put_row(const FieldTarget& target, int y, int count, const float* re, const float* im) {
    const std::ptrdiff_t at = y * target.stride;
    if (target.re != nullptr) std::copy_n(re, count, target.re + at);
    if (target.im != nullptr) std::copy_n(im, count, target.im + at);
    if (target.power == nullptr) return;
    float* power = target.power + at;
    for (int x = 0; x < count; ++x)
        power[x] = re[x] * re[x] + im[x] * im[x];
}

void clear(const FieldTarget& target, int width, int height, const Exec& exec) {
    parallel_blocks(static_cast<std::size_t>(height), 64, exec, [&](std::size_t first, std::size_t end) {
        for (std::size_t y = first; y < end; ++y) {
            for (float* plane : {target.re, target.im, target.power}) {
                if (plane != nullptr)
                    std::fill_n(plane + static_cast<std::ptrdiff_t>(y) * target.stride, width, 0.0f);
            }
        }
    });
}

}  // namespace obscura
