#pragma once
// Dual depths: the depth interval of every texel of a light view.

#include <span>

#include "core/types.h"
#include "raster/depth_map.h"
#include "raster/intervals.h"
#include "raster/layer_memory.h"

namespace obscura {

struct IntervalParams {
    Receivers receivers = Receivers::any;
    bool only_casters = true;
    Region region = {};  ///< texels to render; empty = the whole view
};

/// Interval of every texel of `tile` (at most layer_tile_side square, width a multiple of 16), row by row
/// into `out`, from the records in `list`. `scratch` holds one thread's layers.
class IntervalTiler {
  public:
    IntervalTiler();
    void run(const TriangleSetup& setup, std::span<const std::uint32_t> list, const TileRect& tile,
             Receivers receivers, Isa isa, DepthInterval* out);

  private:
    LayerMemory layers_;
};

/// out(x, y) = interval of the ray of texel (x, y) of params.region (see raster/intervals.h). `out` must have
/// that size.
void interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params, const Exec& exec,
                  RasterScratch& scratch, ImageView<DepthInterval> out);

/// The same as a new picture.
Image<DepthInterval> interval_map(const Mesh& mesh, const LightView& view, const IntervalParams& params,
                                  const Exec& exec);

}  // namespace obscura
