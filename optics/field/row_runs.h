#pragma once
// The rows of a mask as runs of constant transmission.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "optics/field/run_table.h"

namespace obscura {

/// Maximal runs [begin, end) of equal texels that are not 0, row by row, left to right.
struct RowRuns {
    std::vector<std::int32_t> first, begin, end;
    std::vector<float> weight;
    RunTable table() const {
        return {static_cast<int>(first.size()) - 1, first.data(), begin.data(), end.data(), weight.data()};
    }
};

RowRuns row_runs(ImageView<const float> mask, Isa isa);

/// True when every row is its own mirror image.
bool same_left_and_right(const RowRuns& runs, int width);

}  // namespace obscura
