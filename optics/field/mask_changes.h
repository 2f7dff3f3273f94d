#pragma once
// Where a mask changes: all that closed forms need to know of it.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "optics/field/aperture.h"

namespace obscura {

/// Changes along lines. Those of line l are first[l] to first[l + 1]: at edge `edge` (between the texels edge
/// - 1 and edge) the mask rises by `weight`. Edges ascend; the weights of a line add up to 0, since what is
/// outside the mask is closed.
struct LineChanges {
    std::vector<std::int32_t> first{0}, edge;
    std::vector<double> weight;
    int lines() const { return static_cast<int>(first.size()) - 1; }
    void add(std::int32_t at, double rise) {
        edge.push_back(at);
        weight.push_back(rise);
    }
    void close_line() { first.push_back(static_cast<std::int32_t>(edge.size())); }
};

/// Along every row.
LineChanges row_changes(ImageView<const float> mask);

/// Edges at which any line changes, ascending.
std::vector<std::int32_t> distinct_edges(const LineChanges& changes, int texels);

/// mask_symmetry(), told from the changes of the rows alone.
MaskSymmetry symmetry_of(const LineChanges& changes, int texels);

}  // namespace obscura
