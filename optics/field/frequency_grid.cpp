#include "optics/field/frequency_grid.h"

#include "core/error.h"

namespace obscura {

FrequencyGrid centred_grid(int width, int height, double step, double centre_u, double centre_v) {
    CHECK(width > 0 && height > 0 && step > 0);
    return {width, height, centre_u - (width / 2) * step, centre_v - (height / 2) * step, step, step};
}

FrequencyGrid half_grid(int width, int height, double step) {
    FrequencyGrid grid = centred_grid(width, height, step);
    grid.width = width / 2 + 1;
    grid.first_u = 0;
    return grid;
}

}  // namespace obscura
