#pragma once
// Lamps on a picture: objects whose own light clips, and the pixels that show them.

#include <cstdint>
#include <map>
#include <vector>

#include "app/glare/lit_picture.h"
#include "app/scene/scene.h"

namespace obscura {

/// A pixel that clips and the point of its lamp that it shows.
struct LampPixel {
    int x = 0, y = 0;  ///< in the picture
    Vec3d point;
};

/// True when the sensor clips at this pixel. `clip`: radiance.
bool clips(const LitPicture& picture, int x, int y, double clip);

/// Pixels that clip, lamp by lamp (object id), row by row.
std::map<std::uint32_t, std::vector<LampPixel>> lamp_pixels(const Scene& scene, const LitPicture& picture,
                                                            double clip);

/// Objects of the scene whose own light clips: only they have patterns of their own when partly hidden.
std::int64_t lamp_count(const Scene& scene);

}  // namespace obscura
