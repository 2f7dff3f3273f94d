#include "optics/field/mask_changes.h"

#include <algorithm>

#include "optics/field/row_runs.h"

namespace obscura {

LineChanges row_changes(ImageView<const float> mask) {
    const RowRuns runs = row_runs(mask, best_isa());
    LineChanges changes;
    for (std::size_t y = 0; y + 1 < runs.first.size(); ++y) {
        const auto begin = static_cast<std::size_t>(runs.first[y]),
                   end = static_cast<std::size_t>(runs.first[y + 1]);
        for (std::size_t r = begin; r < end; ++r) {
            const double weight = static_cast<double>(runs.weight[r]);
            // Where grey runs touch, one change takes the place of two.
            const bool touches = r > begin && runs.end[r - 1] == runs.begin[r];
            if (touches)
                changes.weight.back() += weight;
            else
                changes.add(runs.begin[r], weight);
            changes.add(runs.end[r], -weight);
        }
        changes.close_line();
    }
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
