#pragma once
// Channels of a frame as the bytes of a picture file.

#include <cstdint>
#include <optional>
#include <string>

#include "app/frame/frame.h"
#include "app/report/output_plan.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "core/pixel.h"

namespace obscura {

/// The code of the farthest depth in a depth PNG; the nearest is 0.
constexpr std::uint16_t farthest_code = 65534;

/// Depths that a mapped PNG spans, metres.
struct PictureDepths {
    float nearest_m = 0, farthest_m = 0;
};

struct PictureFile {
    std::string bytes;
    std::optional<PictureDepths> depth;  ///< of a depth PNG that shows any surface
};

/// The frame must hold the channel.
///
/// .pfm has the numbers themselves, linear floats: beauty radiance before exposure, W / (m^2 sr); depth in
/// metres along the view axis, infinity where nothing is; world-space normals; albedo; the object's index,
/// -1 where nothing is; shadow visibility in [0, 1]; hours of sun, NaN where nothing is.
///
/// .png maps them:
///  - beauty: exposure, tone curve, 8-bit sRGB;
///  - depth: 16-bit grey, linear from the nearest (0) to the farthest (65534) depth of the picture, which
///    `depth` returns; 65535 where nothing is;
///  - normal: 8 bits per channel, 255 * (0.5 + 0.5 n), 128 where nothing is;
///  - albedo: 8-bit sRGB;
///  - object: a colour made from the object's index, black where nothing is;
///  - shadow: 16-bit grey, 65535 is full light;
///  - sun_hours: colours with their scale below (sun_hours_picture.h).
PictureFile encode_picture(const Frame& frame, Aov aov, FileKind kind, const RenderSettings& render,
                           const Exec& exec);

/// The colour of an object: bright enough to tell from black, the same for the same index always.
Rgb8 object_color(std::uint32_t object);

}  // namespace obscura
