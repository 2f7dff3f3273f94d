#pragma once
// What one sample asks of a light's map: where its receiver stands and how its plane lies there. Shared by
// the scalar lookups in dense maps and trees; filters/pcf_lanes.h is the same for sixteen samples.

#include <cmath>
#include <cstdint>

#include "core/scalar_lanes.h"
#include "filters/pcf.h"

namespace obscura::ref {

/// Where the lookup of a sample falls.
struct PcfPlace {
    /// nothing_there: not covered. turned_away: dark without a lookup. before_near: lit without one.
    enum Kind { nothing_there, turned_away, before_near, on_map } kind = nothing_there;
    int view = 0;
    double X = 0, Y = 0;             ///< texels, not farther off the map than 8
    float depth = 0;                 ///< of the receiver; above 1 beyond the casters' range
    float slope_x = 0, slope_y = 0;  ///< of its plane: depth per texel
    float tap_texels = 1;            ///< hierarchical: texels a side that its taps want to span, in [1, size]
    bool asks() const { return kind == before_near || kind == on_map; }
};
PcfPlace pcf_place(const SurfaceBlock& surface, const PcfLight& light, int at);

/// Weight of tap k (0 .. side - 1), before the division by side - 1.
inline float tap_weight(int k, int side, float f) {
    if (side == 1) return 1.0f;
    if (k == 0) return 1.0f - f;
    return k == side - 1 ? f : 1.0f;
}

/// A kernel on the map of squares of 2^level texels: its first square, its weights, and the receiver's plane
/// over it.
struct Kernel {
    int side, level;
    std::int32_t x0, y0;  ///< in squares; may lie outside the map
    float fx, fy;
    float depth;
    float slope_x, slope_y;          ///< depth per square
    float to_centre_x, to_centre_y;  ///< from the receiver to the centre of its own square
    float bias;

    Kernel(const PcfPlace& r, int side_, int level_) : side(side_), level(level_), depth(r.depth) {
        const double scale = 1.0 / static_cast<double>(1 << level);
        const auto square = static_cast<float>(1 << level);
        const double X = r.X * scale, Y = r.Y * scale;
        // Place on a grid of 1/256 square: sums of weights are then exact, and full light is exactly 1.
        const auto x256 = static_cast<std::int32_t>(std::nearbyint(X * 256.0));
        const auto y256 = static_cast<std::int32_t>(std::nearbyint(Y * 256.0));
        const std::int32_t ix = x256 >> 8, iy = y256 >> 8;
        x0 = ix - side / 2;
        y0 = iy - side / 2;
        fx = static_cast<float>(x256 & 255) * (1.0f / 256.0f);
        fy = static_cast<float>(y256 & 255) * (1.0f / 256.0f);
        slope_x = r.slope_x * square;
        slope_y = r.slope_y * square;
        // Not rounded to the grid.
        to_centre_x = static_cast<float>((static_cast<double>(ix) + 0.5) - X);
        to_centre_y = static_cast<float>((static_cast<double>(iy) + 0.5) - Y);
        bias = (std::fabs(slope_x) + std::fabs(slope_y)) * (0.5f - 0.5f / square);
    }
    /// Squares from the receiver's own to tap k.
    float from_own(int k) const {
        const int reach = side / 2;
        return static_cast<float>(k - reach);
    }
    float rise_x(int i) const { return slope_x * (to_centre_x + from_own(i)); }
    float rise_y(int j) const { return slope_y * (to_centre_y + from_own(j)); }
    /// Of the receiver's plane at tap (i, j). Rises are monotone in i and in j, so corners are its extremes.
    /// Beyond the casters' range there is only background, at depth 1; the plane may come back from there.
    float depth_at(int i, int j) const {
        return lane_min(depth + lane_min((rise_x(i) + rise_y(j)) - bias, 0.0f), 1.0f);
    }
    /// Weighted mean of lit(i, j) over the taps.
    template <class Lit>
    float mean(Lit&& lit) const {
        float sum = 0.0f;
        for (int j = 0; j < side; ++j) {
            float row = 0.0f;
            for (int i = 0; i < side; ++i)
                row = row + (lit(i, j) ? tap_weight(i, side, fx) : 0.0f);
            sum = sum + row * tap_weight(j, side, fy);
        }
        return side == 1 ? sum : sum / static_cast<float>((side - 1) * (side - 1));
    }
};

/// The two levels around tap_texels; blend 0: the finer alone.
struct Levels {
    int fine = 0;
    float blend = 0;
};
Levels levels_of(const PcfPlace& r);

/// at_level(level), or the blend of two.
template <class AtLevel>
float filtered(const PcfPlace& r, const PcfLight& light, AtLevel&& at_level) {
    if (light.filter == PcfFilter::pcf) return at_level(0);
    const Levels levels = levels_of(r);
    const float fine = at_level(levels.fine);
    if (levels.blend == 0.0f) return fine;
    return fine + (at_level(levels.fine + 1) - fine) * levels.blend;
}

}  // namespace obscura::ref
