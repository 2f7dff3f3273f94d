#pragma once
// Runs of rows as kernels see them, and the search for their ends. POD.

#include <cstdint>

namespace obscura {

/// Runs of row y lie in [first[y], first[y + 1]).
struct RunTable {
    int rows = 0;
    const std::int32_t* first = nullptr;  ///< rows + 1
    const std::int32_t* begin = nullptr;
    const std::int32_t* end = nullptr;
    const float* weight = nullptr;
};

/// Writes the places x in [1, width) where row[x] differs from row[x - 1], ascending, and their number to
/// *count. `places` has room for width values.
#define OBSCURA_ROW_CHANGES \
    void row_changes(const float* row, int width, std::int32_t* places, int* count) noexcept;
namespace ref {
OBSCURA_ROW_CHANGES
}
namespace sse2 {
OBSCURA_ROW_CHANGES
}
namespace avx2 {
OBSCURA_ROW_CHANGES
}
namespace avx512bw {
OBSCURA_ROW_CHANGES
}
#undef OBSCURA_ROW_CHANGES

}  // namespace obscura
