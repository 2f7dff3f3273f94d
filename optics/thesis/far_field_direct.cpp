// The far field as a sum over quads at every frequency.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.1,
// equations 3.9 (the sum) and 3.13 (a quad's transform is the product of two intervals'). Equation 3.12
// prints the interval's transform with h(c); it must be h(u c).
//
// Every interval is transformed afresh at every frequency, which is what this strategy is: the measure for
// the others, and the cheapest for a handful of quads on a small grid.

#include "optics/thesis/far_field.h"

#include "core/parallel.h"
#include "optics/field/field_rows.h"
#include "optics/field/separable_terms.h"
#include "optics/thesis/direct_row.h"

namespace obscura {

void far_field_direct(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                      const Exec& exec) {
    CHECK(target.stride >= grid.width);
    const SeparableTerms terms = separable_terms(quads);
    const FrequencyRamp u{grid.first_u, grid.step_u, grid.width}, v{grid.first_v, grid.step_v, grid.height};
    constexpr int rows = 16;
    parallel_for(static_cast<std::size_t>((grid.height + rows - 1) / rows), exec, [&](std::size_t block) {
        const int first = static_cast<int>(block) * rows;
        const auto count = static_cast<std::size_t>(terms.count());
        std::vector<float> y_re(count * rows), y_im(count * rows);
        OBSCURA_DISPATCH(exec.isa, box_panel, v, first, terms.y.view(), y_re.data(), y_im.data());
        std::vector<float> re(static_cast<std::size_t>(grid.width)), im(re.size());
        for (int y = first; y < grid.height && y < first + rows; ++y) {
            OBSCURA_DISPATCH(exec.isa, direct_row, u, terms.x.view(), y_re.data() + (y - first),
                             y_im.data() + (y - first), re.data(), im.data());
            put_row(target, y, grid.width, re.data(), im.data());
        }
    });
}

}  // namespace obscura
