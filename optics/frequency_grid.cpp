// Grids of frequencies.

#include "optics/far_field.h"

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

const char* far_field_method_name(FarFieldMethod method) {
    switch (method) {
        case FarFieldMethod::automatic:
            return "automatic";
        case FarFieldMethod::direct:
            return "direct";
        case FarFieldMethod::shift:
            return "shift";
        case FarFieldMethod::gemm:
            return "gemm";
        case FarFieldMethod::edges:
            return "edges";
        case FarFieldMethod::levels:
            return "levels";
        case FarFieldMethod::runs:
            return "runs";
        case FarFieldMethod::raster_fft:
            return "raster_fft";
        case FarFieldMethod::polygon:
            return "polygon";
    }
    return "?";
}

}  // namespace obscura
