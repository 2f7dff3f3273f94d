// The far field as one matrix product over the distinct columns at which a mask changes.
//
// After L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section
// 3.4.1, whose quads are separable (equation 3.13): what matters is then not how many rectangles there are
// but how many different columns. Columns of texels that are equal, wherever they stand, are one term: their
// runs of open texels, transformed in v, times the intervals they cover, transformed in u. A convex shape of
// n columns has at most n terms, a symmetric one n / 2, a box or grating 1.
//
// Factors that sum antiderivatives over the mask's edges, e^(-2 pi i u x) / (-2 pi i u), need as many terms
// but lose accuracy towards u = 0, where large numbers cancel. Intervals do not: at u = v = 0 all terms are
// positive and their sum is the open area.

#include <cmath>

#include "optics/far_field_cull.h"
#include "optics/far_field_methods.h"
#include "optics/field/field_rows.h"
#include "optics/field/separable_field.h"

namespace obscura {

void far_field_edges(ImageView<const float> mask, const FrequencyGrid& grid, double cull,
                     const FieldTarget& target, const Exec& exec, FarFieldReport* report) {
    const SeparableTerms terms = separable_terms(mask);
    if (report != nullptr) report->edges = terms.count();
    if (cull <= 0) {
        separable_field(terms, grid, {}, target, exec);
        return;
    }
    const double amplitude = std::sqrt(cull) * open_area(mask);
    const BlockSet blocks = bright_blocks(terms, grid, amplitude, CullTest::with_neighbours, exec);
    if (report != nullptr) {
        report->active_blocks = active_count(blocks);
        report->blocks = static_cast<std::int64_t>(blocks.active.size());
    }
    clear(target, grid.width, grid.height, exec);
    SeparableParams params;
    params.blocks = &blocks;
    separable_field(terms, grid, params, target, exec);
}

}  // namespace obscura
