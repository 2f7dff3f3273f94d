#pragma once
// An elevation model for scenes: mountains by chance, worn down by water.

#include <cstdint>

#include "core/image.h"

namespace obscura {

/// Steps of the codes that ridges() gives.
constexpr double ridges_step_m = 0.05;

struct RidgesParams {
    int side_log2 = 8;        ///< 2^n + 1 samples a side; 3 to 12
    double height_m = 1900;   ///< from the lowest to the highest before erosion
    double roughness = 0.47;  ///< how much of its height a feature of half the size has, in (0, 1)
    int drops = 90000;        ///< that erode; 0: none
    std::int64_t seed = 1;
};

/// Heights in ridges_step_m above the lowest, row 0 in the north. Midpoints are displaced on diamonds and
/// squares in turn (Fournier, Fussell, Carpenter, "Computer rendering of stochastic models", 1982); then
/// drops run downhill, take up what their speed carries and drop it where they slow down (Beyer,
/// "Implementation of a method for hydraulic erosion", 2015). The same on every machine.
Image<std::uint16_t> ridges(const RidgesParams& params);

/// Of textures/ridges.png, the model of mountains.toml.
inline RidgesParams mountains_params() {
    RidgesParams p;
    p.seed = 7;
    return p;
}

}  // namespace obscura
