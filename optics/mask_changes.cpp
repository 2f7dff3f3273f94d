#include "optics/mask_changes.h"

#include <algorithm>
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

namespace {

/// The changes of one line.
struct Line {
    const std::int32_t* edge;
    const double* weight;
    std::size_t size;
};

Line line_of(const LineChanges& changes, std::size_t line) {
    const auto first = static_cast<std::size_t>(changes.first[line]);
    return {changes.edge.data() + first, changes.weight.data() + first,
            static_cast<std::size_t>(changes.first[line + 1]) - first};
}

bool is_mirrored(const Line& line, int texels) {
    for (std::size_t i = 0; i < line.size; ++i) {
        const std::size_t j = line.size - 1 - i;
        if (line.edge[i] != texels - line.edge[j] || line.weight[i] != -line.weight[j]) return false;
    }
    return true;
}

bool same(const Line& a, const Line& b) {
    return a.size == b.size && std::equal(a.edge, a.edge + a.size, b.edge) &&
           std::equal(a.weight, a.weight + a.size, b.weight);
}

}  // namespace

MaskSymmetry symmetry_of(const LineChanges& changes, int texels) {
    MaskSymmetry symmetry{true, true};
    const auto lines = static_cast<std::size_t>(changes.lines());
    for (std::size_t y = 0; y < lines; ++y) {
        const Line line = line_of(changes, y);
        symmetry.left_right = symmetry.left_right && is_mirrored(line, texels);
        if (y < lines / 2)
            symmetry.top_bottom = symmetry.top_bottom && same(line, line_of(changes, lines - 1 - y));
    }
    return symmetry;
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
