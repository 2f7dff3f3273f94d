#include "optics/field/frequency_grid.h"

#include "core/error.h"

namespace obscura {

FrequencyGrid centred_grid(int width, int height, double step, double centre_u, double centre_v) {
    CHECK(width > 0 && height > 0 && step > 0);
    const int left = width / 2, above = height / 2;
    return {width, height, centre_u - left * step, centre_v - above * step, step, step};
}

FrequencyGrid half_grid(int width, int height, double step) {
    FrequencyGrid grid = centred_grid(width, height, step);
    grid.width = width / 2 + 1;
    grid.first_u = 0;
    return grid;
}

}  // namespace obscura
