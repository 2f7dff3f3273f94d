// The far field as one matrix product over quads.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.1,
// equation 3.13: a quad's transform is a function of u times a function of v, so that the sum over quads is
// the product of a matrix [rows x quads] and a matrix [quads x columns]. 3.12 must read h(u c), not h(c).
//
// The paper sums on a GPU, pixel by pixel. Here both matrices are tabulated once and multiplied by
// optics/field/product.h, where rows v and -v share the work.

#include "optics/thesis/far_field.h"

#include "core/parallel.h"
#include "optics/field/separable_field.h"

namespace obscura {

void far_field_gemm(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                    const Exec& exec) {
    separable_field(separable_terms(quads), grid, {}, target, exec);
}

}  // namespace obscura
