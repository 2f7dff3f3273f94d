// Rows of amplitudes into a target.

#include "optics/field_rows.h"

#include <algorithm>

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

}  // namespace obscura
