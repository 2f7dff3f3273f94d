#pragma once
// Shadows of method "exact" against exact rays, and why they differ. Built only with Embree.

#include <cstdint>

#include "bench/shadows/wrong_pixels.h"
#include "raster/camera_rays.h"
#include "raster/exact/exact.h"

namespace obscura {

/// Exact shadows of one block at a time.
BlockLookup exact_lookup(const Mesh& mesh, const ExactLight& light, Isa isa);

/// A picture whose samples ask for the exact shadows of its parallel light. Borrows.
struct ExactPicture {
    const TrueShadows* scene = nullptr;
    const ExactLight* light = nullptr;
    CameraRays camera;
};

/// Why sample `at` of a block is wrong, the first that applies. u: what is uncertain of the sample's place,
/// in metres (raster/exact/exact.h).
///  - off: the ray of the pixel's centre meets the sample's plane beyond the edges of the sample's triangle;
///  - edge: rays from the place 1/256 pixel away on its plane, to one of eight sides, or a step away on the
///    light's grid, likewise, say what is shown;
///  - beside: rays say so from u away along its plane's normal, to either side, or (from its position in
///    floats, too) when they leave out every face whose plane passes within u, or from u away along the
///    normal of the face that the method has darken it;
///  - unexplained.
Wrong kind_of_exact(const ExactPicture& picture, std::size_t block, int at, Truth shown);

}  // namespace obscura
