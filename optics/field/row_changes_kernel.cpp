// Where a row changes, sixteen texels at a time. See row_changes_ref.cpp.

#include "core/simd.h"
#include "optics/field/run_table.h"

namespace obscura::OBSCURA_ISA {

void row_changes(const float* row, int width, std::int32_t* places, int* count) noexcept {
    int found = 0;
    std::int32_t x = 1;
    for (; x + 16 <= width; x += 16) {
        std::uint32_t changed = bits(~equal(load(row + x), load(row + x - 1)));
        for (; changed != 0; changed &= changed - 1)
            places[found++] = x + __builtin_ctz(changed);
    }
    for (; x < width; ++x) {
        if (row[x] != row[x - 1]) places[found++] = x;
    }
    *count = found;
}

}  // namespace obscura::OBSCURA_ISA
