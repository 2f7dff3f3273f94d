#pragma once
// The rows of a mask as runs of constant transmission.

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace obscura {

/// Runs of one row lie in [first[y], first[y + 1]). POD.
struct RunTable {
    int rows = 0;
    const std::int32_t* first = nullptr;  ///< rows + 1
    const std::int32_t* begin = nullptr;
    const std::int32_t* end = nullptr;
    const float* weight = nullptr;
};

/// Maximal runs [begin, end) of equal texels that are not 0, row by row, left to right.
struct RowRuns {
    std::vector<std::int32_t> first, begin, end;
    std::vector<float> weight;
    RunTable table() const {
        return {static_cast<int>(first.size()) - 1, first.data(), begin.data(), end.data(), weight.data()};
    }
};

RowRuns row_runs(ImageView<const float> mask);

}  // namespace obscura
