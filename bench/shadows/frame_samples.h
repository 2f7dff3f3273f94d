#pragma once
// All samples of a frame, tile by tile, as exact shadows ask for them.

#include <cstdint>

#include "app/scene/scene.h"
#include "core/buffer.h"
#include "core/isa.h"
#include "raster/camera_rays.h"
#include "raster/exact/exact.h"
#include "raster/gbuffer.h"

namespace obscura {

/// Sample k of pixel (x, y) of tile t stands at t * per_tile() + exact_point_index(); those outside of the
/// picture count as not there. About 40 bytes a sample.
struct FrameSamples {
    std::size_t tiles = 0;
    int per_pixel = 1;  ///< 1 or 4: as many as exact shadows take together
    std::size_t covered = 0;
    CameraRays rays;
    Buffer<double> px, py, pz;  ///< as ExactPoints
    Buffer<float> gx, gy, gz;
    Buffer<std::uint32_t> face, triangle, covered_words, thin_words;

    std::size_t per_tile() const {
        return static_cast<std::size_t>(per_pixel) * frame_tile_side * frame_tile_side;
    }
    ExactPoints points(std::size_t tile) const;
};

/// Stages 1 and 2 of the renderer for scene.render's picture, of 1 or 4 samples a pixel.
FrameSamples frame_samples(const Scene& scene, const Exec& exec);

}  // namespace obscura
