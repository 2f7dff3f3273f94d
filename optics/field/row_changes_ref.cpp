// One texel at a time: what row_changes_kernel.cpp does sixteen at a time.

#include "optics/field/run_table.h"

namespace obscura::ref {

void row_changes(const float* row, int width, std::int32_t* places, int* count) noexcept {
    *count = 0;
    for (std::int32_t x = 1; x < width; ++x) {
        if (row[x] != row[x - 1]) places[(*count)++] = x;
    }
}

}  // namespace obscura::ref
