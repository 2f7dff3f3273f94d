// Near field of quads in the thesis's two passes (section 3.4.5, "Efficient Rendering"): first the factors of
// every quad at every u and at every v (equation 3.20, from a table of Fresnel integrals), then at every
// pixel the sum of their products (3.19), which is a matrix product.

#include "optics/thesis/near_field.h"

#include "optics/field/near_field_separable.h"

namespace obscura {

void near_field_two_pass(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                         const Exec& exec) {
    near_field_separable(c, separable_terms(quads), nullptr, target, exec);
}

}  // namespace obscura
