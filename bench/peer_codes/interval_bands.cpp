#include "bench/peer_codes/interval_bands.h"

#include <algorithm>

#include "raster/interval_map.h"

namespace obscura {

void for_each_band(const Mesh& mesh, const LightView& view, int rows, const Exec& exec,
                   const std::function<void(int, ImageView<const DepthInterval>)>& take) {
    RasterScratch scratch;
    for (int y = 0; y < view.height; y += rows) {
        IntervalParams params;
        params.region = {0, y, view.width, std::min(rows, view.height - y)};
        Image<DepthInterval> band(params.region.width, params.region.height);
        interval_map(mesh, view, params, exec, scratch, band.view());
        take(y, band.view());
    }
}

}  // namespace obscura
