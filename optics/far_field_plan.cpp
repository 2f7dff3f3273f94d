// Which method is cheapest: a fixed model, so that every machine makes the same choice.

#include "optics/far_field.h"
#include "optics/far_field_methods.h"
#include "optics/natural_grid.h"

namespace obscura {

FarFieldReport plan_far_field(const Aperture& aperture, const FrequencyGrid& grid,
                              const FarFieldParams& params) {
    FarFieldReport report;
    report.method = params.method;
    if (params.method == FarFieldMethod::automatic) {
        const bool natural = natural_grid(aperture.mask.width, aperture.mask.height, grid).has_value();
        report.method = natural ? FarFieldMethod::runs : FarFieldMethod::edges;
    }
    return report;
}

}  // namespace obscura
