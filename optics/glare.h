#pragma once
// What a lens makes of light brighter than the sensor can show: every such pixel spreads by the point spread
// function, and nothing is lost.
//
// L. Scandolo: thesis, 2019, sections 3.6.1 (glare) and 3.6.3 (bloom); the convolution is that of M. Kakimoto
// et al.: Glare generation based on wave optics, 2004.

#include <cstdint>
#include <span>
#include <string>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/psf.h"

namespace obscura {

struct GlareParams {
    /// Radiance from which on a pixel (its largest channel) glares: a growing share of its light, all of it
    /// from twice as much on, so that a sky that passes the level shows no contour. Pixels with a kernel of
    /// their own glare as a whole. Exposure is the caller's to take out. Above 0.
    double clip = 1;
    /// 1, 2, 4 or 8: what lies farther than 2 to 4 bloom_scale pixels from a source is computed at 1 /
    /// bloom_scale of the resolution, and interpolated.
    int bloom_scale = 1;
};

struct GlareReport {
    std::int64_t sources = 0;  ///< pixels above the clip level
    bool fft = false;          ///< some kernel by FFT, else splats
    double cost_ms = 0;        ///< the planner's estimate for one thread
    std::string reason;        ///< one line; says so when nothing clips
    double spread = 0;         ///< share of the sources' light that left its pixel
    double lost = 0;           ///< share that fell outside the picture
    double blocked = 0;        ///< share that kernels of a sum below 1 do not pass on
};

/// Kernels of the sources: pixel (x, y) spreads by kernels[choice(x, y)], or by the first where `choice` is
/// empty. Sides are odd; channels sum to 1 where energy is to be kept.
struct GlareKernels {
    std::span<const Image<Vec3f>> kernels;
    ImageView<const std::uint16_t> choice;
};

/// Spreads what glares of every pixel brighter than the clip level over its kernel. Linear radiance;
/// what falls outside the picture is lost, what kernels of a sum below 1 hold back is blocked (both are
/// counted). Energy: sum of the picture + lost + blocked = sum before, within 1e-4 of the sources', unless
/// pixels would grow beyond the largest float, where they stop. Negative channels are no light: they stay,
/// and what falls on them adds to them. Pixels that are not finite stay as they are. The same bits for any
/// exec.
void spread_glare(ImageView<Vec3f> radiance, const GlareKernels& kernels, const GlareParams& params,
                  const Exec& exec, GlareReport* report = nullptr);

/// The same with one kernel, into a picture of its own.
Image<Vec3f> add_glare(ImageView<const Vec3f> radiance, const Image<Vec3f>& kernel, const GlareParams& params,
                       const Exec& exec, GlareReport* report = nullptr);

/// What the glare of a picture takes at most, when all of it is bright.
struct GlareCost {
    double ms = 0;  ///< one thread
    std::int64_t bytes = 0;
};
GlareCost most_glare(int width, int height, int kernel_side, const GlareParams& params);

/// Every channel scaled to sum 1, so that sources keep their colours; a channel in which the kernel holds
/// less than a thousandth of its light (as blue under sodium lamps) takes the shape of the sum of all three.
Image<Vec3f> unit_kernel(const Image<Vec3f>& kernel);

}  // namespace obscura
