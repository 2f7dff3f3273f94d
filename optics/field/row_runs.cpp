#include "optics/field/row_runs.h"

#include <cstddef>

namespace obscura {

RowRuns row_runs(ImageView<const float> mask, Isa isa) {
    RowRuns runs;
    runs.first.reserve(static_cast<std::size_t>(mask.height) + 1);
    std::vector<std::int32_t> places(static_cast<std::size_t>(mask.width) + 1);
    for (int y = 0; y < mask.height; ++y) {
        runs.first.push_back(static_cast<std::int32_t>(runs.begin.size()));
        const float* row = mask.row(y);
        int count = 0;
        OBSCURA_DISPATCH(isa, row_changes, row, mask.width, places.data(), &count);
        places[static_cast<std::size_t>(count)] = mask.width;
        std::int32_t begin = 0;
        for (std::size_t i = 0; i <= static_cast<std::size_t>(count); ++i) {
            if (row[begin] != 0) {
                runs.begin.push_back(begin);
                runs.end.push_back(places[i]);
                runs.weight.push_back(row[begin]);
            }
            begin = places[i];
        }
    }
    runs.first.push_back(static_cast<std::int32_t>(runs.begin.size()));
    return runs;
}

bool same_left_and_right(const RowRuns& runs, int width) {
    for (std::size_t y = 0; y + 1 < runs.first.size(); ++y) {
        auto left = static_cast<std::size_t>(runs.first[y]);
        auto right = static_cast<std::size_t>(runs.first[y + 1]);
        while (left < right) {
            --right;
            const bool mirrored = runs.begin[left] + runs.end[right] == width &&
                                  runs.end[left] + runs.begin[right] == width &&
                                  runs.weight[left] == runs.weight[right];
            if (!mirrored) return false;
            ++left;
        }
    }
    return true;
}

}  // namespace obscura
