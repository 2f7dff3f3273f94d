#include "optics/row_runs.h"

namespace obscura {

RowRuns row_runs(ImageView<const float> mask) {
    RowRuns runs;
    runs.first.reserve(static_cast<std::size_t>(mask.height) + 1);
    for (int y = 0; y < mask.height; ++y) {
        runs.first.push_back(static_cast<std::int32_t>(runs.begin.size()));
        const float* row = mask.row(y);
        for (int x = 0; x < mask.width;) {
            const float value = row[x];
            const int begin = x;
            while (x < mask.width && row[x] == value)
                ++x;
            if (value == 0) continue;
            runs.begin.push_back(begin);
            runs.end.push_back(x);
            runs.weight.push_back(value);
        }
    }
    runs.first.push_back(static_cast<std::int32_t>(runs.begin.size()));
    return runs;
}

}  // namespace obscura
