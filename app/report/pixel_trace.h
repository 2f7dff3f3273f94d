#pragma once
// Every number that made one pixel.

#include <string>

#include "app/frame/render_frame.h"
#include "core/pixel.h"

namespace obscura {

struct PixelTrace {
    Vec3f radiance;    ///< linear: the very bits that render_frame() gives this pixel
    Rgb8 pixel;        ///< after exposure and tone curve
    std::string text;  ///< the account, line by line
};

/// Follows pixel (x, y) of the whole picture through the stages of app/frame/tile.h, in their reference form:
/// samples, triangle, depth, barycentrics, position, normals, texture level, then light by light the shadow
/// lookup with its taps, the terms of the surface model, and what they add up to. `cache`: as for
/// render_frame().
PixelTrace trace_pixel(const Scene& scene, int x, int y, const Exec& exec, FrameCache& cache);
/// The same, nothing kept.
PixelTrace trace_pixel(const Scene& scene, int x, int y, const Exec& exec = {});

}  // namespace obscura
