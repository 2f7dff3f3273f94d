#pragma once
// What a lens makes of light brighter than the sensor can show: every such pixel spreads by the point spread
// function, and nothing is lost.

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/psf.h"

namespace obscura {

struct GlareParams {
    double clip = 1;  ///< radiance, after exposure, from which on a pixel (its largest channel) glares
};

struct GlareReport {
    std::int64_t sources = 0;  ///< pixels above the clip level
    bool fft = false;          ///< else splats
    double cost_ms = 0;
    std::string reason;  ///< one line; says so when nothing clips
    double spread = 0;   ///< share of the sources' light that left its pixel
    double lost = 0;     ///< share that fell outside the picture
};

/// Replaces every pixel brighter than the clip level by its light spread over the kernel. Linear radiance;
/// what falls outside the picture is lost (and counted). Energy: sum of the picture + lost = sum before,
/// within 1e-4 of the sources'.
Image<Vec3f> add_glare(ImageView<const Vec3f> radiance, const Image<Vec3f>& kernel, const GlareParams& params,
                       const Exec& exec, GlareReport* report = nullptr);

}  // namespace obscura
