#pragma once
// Values that cross rooms.

#include <cstdint>

#include "core/vec.h"

namespace obscura {

/// Closed interval of light-space depths: every stored depth inside it gives the same shadow test for every
/// receiver that may ask (Scandolo, Bauszat, Eisemann 2016, section 3: any outside solids; raster/intervals.h
/// has the scene's own surfaces, too). 0 <= entry <= exit <= 1; [1, 1] is background.
struct DepthInterval {
    float entry = 1.0f, exit = 1.0f;
    friend bool operator==(const DepthInterval&, const DepthInterval&) = default;
};

/// The depth that a shadow map stores of an interval: its middle, but no farther behind the entry than
/// deepest_stored, inside the interval after rounding. Where nothing solid follows a sheet for long, the
/// middle would be in the air, and whoever stands between, beside the sheet's edge, would be lit through it
/// by the taps that miss it.
constexpr float deepest_stored = 1.0f / 256.0f;
constexpr float stored_depth(DepthInterval i) {
    const float half = 0.5f * (i.exit - i.entry);
    const float depth = i.entry + (half < deepest_stored ? half : deepest_stored);
    return depth < i.entry ? i.entry : (depth > i.exit ? i.exit : depth);
}

/// Map from world space to the texels of an image: to_map * (x, y, z, 1) = (X w, Y w, Z w, w), with X right
/// and Y down in texels of a width x height grid (texel (i, j) has its centre at (i + 0.5, j + 0.5)) and
/// depth Z growing away from the viewer. Z is affine in X and Y over any plane.
///  - orthographic (w = 1): Z in [0, 1].
///  - perspective light: Z = (1 - near/z) * far/(far - near), in [0, 1].
///  - perspective camera: Z = -near/z, in [-1, 0): floats are dense near 0, so distant depths keep precision.
/// Points with w < near_w lie before the near plane and are clipped.
struct View {
    Mat4 to_map;
    int width = 0, height = 0;
    bool perspective = false;
    double near_w = 0.0;
    float min_depth = 0.0f, max_depth = 1.0f;  ///< range that depths are clamped to
    friend bool operator==(const View&, const View&) = default;
};

/// Texels [x0, x0 + width) x [y0, y0 + height) of a view or picture. Without texels it stands for all of it,
/// where a parameter says so.
struct Region {
    int x0 = 0, y0 = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
    friend bool operator==(const Region&, const Region&) = default;
};

/// A view from a light.
using LightView = View;

}  // namespace obscura
