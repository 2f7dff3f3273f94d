#pragma once
// Nearest depth per texel of a view.

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "raster/bin.h"
#include "raster/setup.h"

namespace obscura {

/// Buffers of one view after the other: reuse it and nothing is allocated twice.
struct RasterScratch {
    TriangleSetup setup;
    TileBins bins;
};

/// out(x, y) = least depth over the centre of texel (x, y) of params.region (empty: of the view);
/// view.max_depth where nothing is. `out` must have that size.
void depth_map(const Mesh& mesh, const View& view, const SetupParams& params, const Exec& exec,
               RasterScratch& scratch, ImageView<float> out);

/// The region that `wanted` means in a view: itself, or all of it.
inline Region region_of(const View& view, const Region& wanted) {
    return wanted.empty() ? Region{0, 0, view.width, view.height} : wanted;
}

/// The same as a new picture.
Image<float> depth_map(const Mesh& mesh, const View& view, const Exec& exec);

}  // namespace obscura
