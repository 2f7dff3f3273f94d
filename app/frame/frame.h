#pragma once
// A rendered frame: linear radiance, further channels (AOVs), and what it took.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/frame/light_shadow_stats.h"
#include "app/glare/lit_picture.h"
#include "core/buffer.h"
#include "core/image.h"
#include "core/sun_path.h"
#include "core/vec.h"
#include "raster/exact/exact.h"
#include "raster/layers.h"

namespace obscura {

struct FrameOptions {
    Region crop;  ///< pixels of the whole picture; empty (width or height 0) = all of it
    bool depth = false, normal = false, albedo = false, object = false, shadow = false;  ///< AOVs wanted
    bool shift = false;      ///< of eyes: Frame::shift_px
    bool sun_hours = false;  ///< needs a sun with a path
    /// Share of the work done, tiles and the lens's pattern, rising to 1; called from any thread, one call at
    /// a time, some hundred times.
    std::function<void(double)> progress;
    const std::atomic<bool>* cancel = nullptr;  ///< set it and the remaining tiles, of shadow
                                                ///< maps too, are left out
};

/// Hours of direct sun, when they were wanted.
struct SunHoursStats {
    std::string light;
    SunPath path;
    std::vector<SunSpan> sunlit;      ///< when the sun is up on it
    int suns = 0;                     ///< steps with the sun up
    int passes = 0;                   ///< over the tiles
    double order_s = 0, total_s = 0;  ///< putting in order what casts shadows; all of it
    ExactCounts exact;

    /// What open level ground has: the most there is.
    double sunlit_h() const {
        double hours = 0;
        for (const SunSpan& span : sunlit)
            hours += span.hours();
        return hours;
    }
};

/// Wall-clock seconds per stage, and exact counts.
struct FrameStats {
    double surface_s = 0;     ///< table of surface triangles; 0 when kept
    double shadow_s = 0;      ///< shadow maps, the next three included; near 0 when kept
    double sky_s = 0;         ///< of these, the sky's light and what surfaces send on of it
    double resolution_s = 0;  ///< finding resolutions
    double needed_s = 0;      ///< and finding what the picture looks up (scope "frame")
    double setup_s = 0;       ///< triangle setup and bins of the camera
    double tiles_s = 0;       ///< visibility, surface, shadow lookups, shading, resolve
    double total_s = 0;
    std::int64_t triangles = 0;              ///< in the scene
    std::int64_t records = 0;                ///< triangles that reach a sample of the picture, after clipping
    std::int64_t bin_items = 0;              ///< triangle-tile pairs
    std::int64_t samples = 0;                ///< taken
    std::int64_t covered_samples = 0;        ///< of these, on a surface
    ExactCounts exact;                       ///< of exact shadows, all lights
    std::int64_t shadow_maps = 0;            ///< views rendered for this frame, not kept ones
    std::int64_t shadow_bytes = 0;           ///< all maps
    std::int64_t bytes = 0;                  ///< estimate_memory(), checked before the work
    std::vector<LightShadowStats> lights;    ///< of the lights with shadows, in scene order
    std::optional<GlareStats> glare;         ///< none: the scene has no lens
    std::optional<SunHoursStats> sun_hours;  ///< none: not wanted
    std::vector<std::string> notices;        ///< what happened that one would want to know: caches made again
};

/// Pixels of the crop; channels that were not wanted are empty.
struct Frame {
    int x0 = 0, y0 = 0;  ///< the crop's corner in the whole picture
    int width = 0, height = 0;
    Raster<Vec3f> radiance;  ///< linear, W / (m^2 sr): the mean of the pixel's samples
    // Of sample 0 (which for one sample is the pixel's centre):
    Image<float> depth_m;         ///< metres along the view axis; infinity where nothing is
    Image<Vec3f> normal;          ///< world space, unit, towards the viewer; 0 where nothing is
    Image<std::uint32_t> object;  ///< index into Mesh::objects; no_object where nothing is
    /// How many pixels further right the scene's camera sees what an eye does; 0 where nothing is.
    Image<float> shift_px;
    // Means of the pixel's samples:
    Image<Vec3f> albedo;  ///< base colour times texture, linear; 0 where nothing is
    Image<float> shadow;  ///< visibility, averaged over the lights with shadows; surfaces that face away
                          ///< count 0; 1 where nothing is, or without such lights
    /// Hours that the sun reaches the samples on surfaces, their mean; NaN where nothing is.
    Image<float> sun_hours;
    /// Where the picture's lens is, from the camera's eye: that of the eye that sees it.
    Vec3d lens_offset_m;
    bool complete = false;  ///< false: cancelled
    FrameStats stats;
};

}  // namespace obscura
