// Near field as one matrix product over the distinct columns of the mask.
//
// Equation 3.19 is a sum of products, one per quad; quads of the same column differ in one factor only. So
// columns of texels that are equal, wherever they stand, become one term, and there are never more terms than
// columns: a box or a grating has one, a mask with a mirror half as many as columns.

#include <algorithm>

#include "core/image.h"
#include "optics/field/near_field_separable.h"
#include "optics/near_field_methods.h"

namespace obscura {
namespace {

/// The block or one of its neighbours is bright.
bool is_wanted(const Image<float>& power, int x, int y, double cull) {
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, power.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, power.width - 1); ++i) {
            if (static_cast<double>(power(i, j)) >= cull) return true;
        }
    }
    return false;
}

/// Blocks of 8 x 8 pixels to compute, from one sample each. The thesis (section 3.5.2) takes the samples
/// alone; rings narrower than a block then go missing next to bright ones, so neighbours count here.
BlockSet bright_blocks(const NearFieldCase& c, const SeparableTerms& terms, double cull, const Exec& exec) {
    NearFieldCase sampled = c;
    sampled.grid.width = (c.grid.width + 7) / 8;
    sampled.grid.height = (c.grid.height + 7) / 8;
    sampled.grid.first_x = c.grid.first_x + 3.5 * c.grid.step;
    sampled.grid.first_y = c.grid.first_y + 3.5 * c.grid.step;
    sampled.grid.step = 8 * c.grid.step;
    Image<float> power(sampled.grid.width, sampled.grid.height);
    near_field_separable(sampled, terms, nullptr, {nullptr, nullptr, power.pixels.data(), sampled.grid.width},
                         exec);
    BlockSet blocks{power.width, power.height, {}};
    for (int y = 0; y < power.height; ++y) {
        for (int x = 0; x < power.width; ++x)
            blocks.active.push_back(is_wanted(power, x, y, cull) ? 1 : 0);
    }
    return blocks;
}

}  // namespace

void near_field_edges(const NearFieldCase& c, double cull, const FieldTarget& target, const Exec& exec,
                      NearFieldReport& report) {
    const SeparableTerms terms = separable_terms(c.mask);
    report.edges = terms.count();
    if (!(cull > 0)) {
        near_field_separable(c, terms, nullptr, target, exec);
        return;
    }
    const BlockSet blocks = bright_blocks(c, terms, cull, exec);
    report.blocks = static_cast<std::int64_t>(blocks.active.size());
    report.active_blocks = std::count(blocks.active.begin(), blocks.active.end(), 1);
    near_field_separable(c, terms, &blocks, target, exec);
}

}  // namespace obscura
