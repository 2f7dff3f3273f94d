#include "optics/mask_changes.h"

#include <cstring>

namespace obscura {

namespace {

constexpr int span = 32;

/// First x >= from, x <= width, that differs from its left neighbour; width where none does. Long runs are
/// compared in spans.
int next_change(const float* row, int from, int width) {
    int x = from;
    while (x + span <= width && std::memcmp(row + x, row + x - 1, span * sizeof(float)) == 0)
        x += span;
    while (x < width && row[x] == row[x - 1])
        ++x;
    return x;
}

void append_row(const float* row, int width, LineChanges& changes) {
    double before = 0;
    for (int x = 0; x <= width; x = x < width ? next_change(row, x + 1, width) : width + 1) {
        const double here = x < width ? static_cast<double>(row[x]) : 0;
        if (here == before) continue;
        changes.edge.push_back(x);
        changes.weight.push_back(here - before);
        before = here;
    }
    changes.close_line();
}

}  // namespace

LineChanges row_changes(ImageView<const float> mask) {
    LineChanges changes;
    for (int y = 0; y < mask.height; ++y)
        append_row(mask.row(y), mask.width, changes);
    return changes;
}

bool has_mirror(const LineChanges& changes, int texels) {
    for (std::size_t line = 0; line + 1 < changes.first.size(); ++line) {
        auto low = static_cast<std::size_t>(changes.first[line]),
             high = static_cast<std::size_t>(changes.first[line + 1]);
        for (; low < high; ++low) {
            --high;
            if (changes.edge[low] != texels - changes.edge[high] ||
                changes.weight[low] != -changes.weight[high])
                return false;
        }
    }
    return true;
}

std::vector<std::int32_t> distinct_edges(const LineChanges& changes, int texels) {
    std::vector<char> used(static_cast<std::size_t>(texels) + 1, 0);
    for (const std::int32_t e : changes.edge)
        used[static_cast<std::size_t>(e)] = 1;
    std::vector<std::int32_t> edges;
    for (int e = 0; e <= texels; ++e) {
        if (used[static_cast<std::size_t>(e)]) edges.push_back(e);
    }
    return edges;
}

}  // namespace obscura
