#pragma once
// The sky of a frame: what is seen of it, and the lights that stand for it.

#include <optional>
#include <vector>

#include "core/isa.h"
#include "core/scene.h"
#include "core/sky/sky_model.h"
#include "raster/shade.h"

namespace obscura {

struct TileWork;

/// Kept between frames while the scene's sky stays.
struct FrameSky {
    Sky sky;                        ///< what it was made for
    std::optional<SkyModel> model;  ///< none: a gradient
    ShadeSky shade;                 ///< what surfaces mirror, and a gradient's background
    /// With occlusion: parallel lights, Sky::samples from above the horizon, and from below, evenly, a
    /// sixteenth as many, at least 4; half as many when surfaces send light on, most of which they hide.
    std::vector<Light> lights;
    std::vector<double> solid_angle_sr;  ///< that each stands for
    /// The same light from few directions, 16 and 8 from below: what patches of surfaces ask.
    std::vector<Light> few;
    std::vector<double> few_sr;
};

FrameSky frame_sky(const Sky& sky, const Exec& exec);

/// How many lights stand for a sky that surfaces occlude.
int sky_light_count(const Sky& sky);

/// Puts the model's radiance, with the sun's disc, where a block of samples shows nothing else.
void draw_sky(const SkyModel& model, TileWork& work);

}  // namespace obscura
