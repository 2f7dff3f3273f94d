#pragma once
// Shadows of a light with a size: of many lights without (raster/light_samples.h), found together. POD:
// kernels include this.
//
// What parallel light from somewhere on a disc finds between itself and a point lies within a cone around the
// point's place as seen from the disc's middle: a caster that is nearer to the light by some depth stands
// beside that place by no more than the depth times a slope. So one walk through the boxes of the middle's
// casters, the extent of sixteen points widened by that, finds all that any part of the disc may have before
// them. Where there is nothing, the points are lit by all; else each part asks the few that were found,
// exactly as if it shone alone: the same bits as exact shadows of that part.
//
// The search for blockers of R. Fernando, "Percentage-Closer Soft Shadows", SIGGRAPH 2005, made conservative
// and without a map, and the cones of J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, for sixteen
// points at once.
//
// A light with a position sees a cone, too, with 1 / w for the depth, which is what depth is in perspective.
// It is used to tell how wide penumbrae are; parts of such a light are asked one by one.

#include <cstddef>
#include <cstdint>

#include "raster/exact/exact.h"

namespace obscura {

struct Light;

/// How a light's size reaches, from its middle.
struct ExactSpread {
    float steps_per_depth[6] = {};  ///< of each view: steps on its grid per unit of depth
    float metres_per_depth = 0;     ///< parallel: of the view
    double sine = 0;                ///< parallel: of the angle from the middle of the disc to its rim,
    double tangent = 0;             ///< and its tangent
    std::int32_t slack = 4;         ///< steps: rounding of the middle's grid and of all parts' grids
    double radius_m = 0;            ///< otherwise: no part of the light is farther from its middle
};

/// Of a light whose middle is `middle`.
ExactSpread exact_spread(const Light& light, const ExactLight& middle);

/// A vertex of the mesh on the grids of sixteen parts of a light.
struct alignas(64) PartVertex {
    std::int32_t x[16], y[16];
    float z[16];
};

/// Sixteen of the parallel lights that one with a size is taken for, or fewer: the rest repeat the first.
struct alignas(64) ExactParts {
    double to_map[3][4][16];  ///< rows of LightView::to_map
    double way[3][16];        ///< against the light's way
    float to_light[3][16];    ///< the same, unit
    float step_m[16];         ///< metres that a step of the grid spans
    std::int32_t count = 16;
    const PartVertex* vertices = nullptr;
};

constexpr std::size_t most_soft_groups = 64;

/// A parallel light with a size.
struct ExactSoft {
    ExactLight middle;  ///< whose casters are all, those too that it sees along their plane
    ExactSpread spread;
    const std::uint32_t* corners = nullptr;  ///< three of each triangle that casts: vertices of `parts`
    const double (*planes)[4] = nullptr;     ///< of its faces: unit normal and distance
    const ExactParts* parts = nullptr;
    std::int32_t groups = 0;  ///< of sixteen parts
};

constexpr double exact_beyond = 0x1p28;         ///< steps: how far off the grid places of samples are kept
constexpr float exact_most_reach = 0x1.8p29f;   ///< steps: anything, from anywhere that near
constexpr double exact_least_facing = 0x1p-20;  ///< cosine: below it the side that is seen is uncertain

/// Steps that a thing before a point, nearer by `depth`, may stand beside its place, seen from the middle.
[[gnu::always_inline]] inline std::int32_t exact_steps(const ExactSpread& spread, int view, float depth) {
    const float steps = spread.steps_per_depth[view] * depth;
    const float some = steps > 0 ? steps : 0.0f;
    return static_cast<std::int32_t>(some < exact_most_reach ? some : exact_most_reach) + spread.slack;
}

/// Whether all of a rectangle on the grid, widened by `reach`, is outside of an edge.
[[gnu::always_inline]] inline bool exact_outside(const CasterTriangle& t, std::int32_t x_low,
                                                 std::int32_t x_high, std::int32_t y_low, std::int32_t y_high,
                                                 std::int32_t reach) {
    bool outside = false;
    for (int k = 0; k < 3; ++k) {
        const int n = k == 2 ? 0 : k + 1;
        const double A = static_cast<double>(t.y[k]) - t.y[n], B = static_cast<double>(t.x[n]) - t.x[k];
        const double x = A > 0 ? static_cast<double>(x_high) + reach : static_cast<double>(x_low) - reach;
        const double y = B > 0 ? static_cast<double>(y_high) + reach : static_cast<double>(y_low) - reach;
        // Terms to 2^60: exact but for 2^8 each.
        outside = outside || A * (x - t.x[k]) + B * (y - t.y[k]) < -0x1p10;
    }
    return outside;
}

/// Cosine to the light's middle down to which a surface may face some of a disc of light.
[[gnu::always_inline]] inline float exact_facing(const ExactSpread& spread) {
    return static_cast<float>(-1.001 * spread.sine) - 0x1p-20f;
}

/// How far before point p the triangle lies on the way to the light, at most, metres, when it is within
/// reach; negative when p is before it as all of the light sees it. `depth`: how much nearer it may be, in
/// the view; `height` above its plane, which is behind it below `lowest`.
[[gnu::always_inline]] inline float exact_distance(const CasterTriangle& t, const ExactLight& light,
                                                   const ExactSpread& spread, float depth,
                                                   const double (&p)[3], double height, double lowest) {
    double l[3];
    for (int k = 0; k < 3; ++k) {
        l[k] = static_cast<double>(light.to_light[k]);
        if (!light.directional) l[k] = static_cast<double>(light.position[k]) + light.eye[k] - p[k];
    }
    double facing = (t.n[0] * l[0] + t.n[1] * l[1]) + t.n[2] * l[2];
    if (!light.directional) facing /= __builtin_sqrt((l[0] * l[0] + l[1] * l[1]) + l[2] * l[2]);
    const float most = depth * spread.metres_per_depth;
    // A plane that some of the light sees from the other side, or along.
    if (!(facing > 1.01 * spread.sine + exact_least_facing)) return light.directional ? most : -1.0f;
    if (height >= 0.5 * lowest) return -1;
    const auto d = static_cast<float>(-height / facing);
    return light.directional && most < d ? most : d;
}

/// Width of a penumbra in pixels at p, relative to the eye, of what stands `before_m` metres before it.
[[gnu::always_inline]] inline float exact_penumbra_px(const ExactLight& light, const ExactSpread& spread,
                                                      const float (&p)[3], float before_m) {
    const float seen = __builtin_sqrtf((p[0] * p[0] + p[1] * p[1]) + p[2] * p[2]);
    const float pixel_m = 256.0f * (light.snapping_m + light.snapping_per_m * seen);
    if (light.directional) return 2.0f * static_cast<float>(spread.tangent) * before_m / pixel_m;
    float to[3];
    for (int k = 0; k < 3; ++k)
        to[k] = light.position[k] - p[k];
    const float away = __builtin_sqrtf((to[0] * to[0] + to[1] * to[1]) + to[2] * to[2]);
    // What touches the light has penumbrae as wide as anything.
    const float left = away - before_m, least = 0x1p-10f * away;
    return 2.0f * static_cast<float>(spread.radius_m) * before_m / (left > least ? left : least) / pixel_m;
}

/// exact_reach: every point that some of the light may reach, as samples on the grid of its middle.
/// exact_widest: of the samples' penumbrae, in pixels; of sixteen samples no wider one is looked for once one
/// is `stop_px` wide, so the result is exact below that alone. exact_see: vertices begin to end, x y z each,
/// on the grids of sixteen parts; clamped to them where they lie beyond, as nothing does that casts.
/// exact_soft, parallel light: lit[p * stride + i / 16], bit i % 16, is whether part p reaches point i; bits
/// of points that are no samples stay. Orders as exact_darken's.
#define OBSCURA_EXACT_SOFT                                                                            \
    void exact_reach(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread,  \
                     ExactSamples& samples) noexcept;                                                 \
    void exact_widest(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread, \
                      const ExactSamples& samples, const std::uint32_t* order, float stop_px,         \
                      float& widest_px, ExactCounts& counts) noexcept;                                \
    void exact_see(const float* xyz, std::size_t begin, std::size_t end, const ExactParts& parts,     \
                   PartVertex* out) noexcept;                                                         \
    void exact_soft(const ExactPoints& points, const ExactSoft& light, const ExactSamples& samples,   \
                    const std::uint32_t* order, std::uint32_t* lit, std::int32_t stride,              \
                    ExactCounts& counts) noexcept;
namespace ref {
OBSCURA_EXACT_SOFT
}
namespace sse2 {
OBSCURA_EXACT_SOFT
}
namespace avx2 {
OBSCURA_EXACT_SOFT
}
namespace avx512bw {
OBSCURA_EXACT_SOFT
}
#undef OBSCURA_EXACT_SOFT

}  // namespace obscura
