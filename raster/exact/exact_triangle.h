#pragma once
// A triangle against sixteen samples. Kernel files only; the meaning of each step is in exact_ref.cpp.

#include "raster/exact/exact_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Whether the camera and the light see the same side of the plane.
OBSCURA_INLINE bool is_seen(const CasterTriangle& t, const double (&viewer)[4]) {
    return (t.n[0] * viewer[0] + t.n[1] * viewer[1]) + (t.n[2] * viewer[2] + t.d * viewer[3]) > 0;
}

/// An edge that some sample of a bunch may be outside of: value at the bunch's lowest place, and steps.
struct Crossing {
    std::int64_t e, A, B;
};

/// Lanes inside of the edges, whose values do not fit doubles.
std::uint32_t inside_of_long(const Crossing* edge, int edges, const Bunch& s) {
    std::uint32_t inside = 0;
    for (int lane = 0; lane < 16; ++lane) {
        const std::int64_t dx = std::int64_t{s.x[lane]} - s.extent.x_low,
                           dy = std::int64_t{s.y[lane]} - s.extent.y_low;
        bool all = true;
        for (int k = 0; k < edges; ++k)
            all = all && edge[k].A * dx + edge[k].B * dy + edge[k].e >= 0;
        inside |= static_cast<std::uint32_t>(all) << lane;
    }
    return inside;
}

/// Lanes of `lanes_of` whose samples the triangle covers; 0 where all of the bunch is outside of an edge.
OBSCURA_INLINE std::uint32_t covered(const CasterTriangle& t, const Bunch& s, std::uint32_t lanes_of) {
    // Edges over the bunch's extent: outside of one, done; inside of all of one, forgotten.
    Crossing edge[3];
    int edges = 0;
    bool fits = true;
    const std::int64_t width = std::int64_t{s.extent.x_high} - s.extent.x_low,
                       height = std::int64_t{s.extent.y_high} - s.extent.y_low;
    for (int k = 0; k < 3; ++k) {
        const int n = k == 2 ? 0 : k + 1;
        const std::int64_t A = std::int64_t{t.y[k]} - t.y[n], B = std::int64_t{t.x[n]} - t.x[k];
        const std::int64_t keeps_its_edge = (A > 0) | ((A == 0) & (B > 0));
        const std::int64_t e = A * (s.extent.x_low - std::int64_t{t.x[k]}) +
                               B * (s.extent.y_low - std::int64_t{t.y[k]}) + keeps_its_edge - 1;
        const std::int64_t across = A * width, down = B * height;
        if (e + (across > 0 ? across : 0) + (down > 0 ? down : 0) < 0) return 0;
        if (e + (across < 0 ? across : 0) + (down < 0 ? down : 0) >= 0) continue;
        edge[edges++] = {e, A, B};
        constexpr std::int64_t exact = std::int64_t{1} << 51;
        fits = fits && -exact < across && across < exact && -exact < down && down < exact;
    }
    if (edges == 0) return lanes_of;
    if (!fits) return lanes_of & inside_of_long(edge, edges, s);
    const F64 dx = to_f64(load(s.x) - splat(s.extent.x_low)), dy = to_f64(load(s.y) - splat(s.extent.y_low));
    for (int k = 0; k < edges && lanes_of != 0; ++k) {
        const F64 value =
            (splat(static_cast<double>(edge[k].A)) * dx + splat(static_cast<double>(edge[k].B)) * dy) +
            splat(static_cast<double>(edge[k].e));
        lanes_of &= bits(greater_equal(value, splat(0.0)));
    }
    return lanes_of;
}

/// Of dark lanes near the plane those that seem behind it only for being snapped beside their place.
OBSCURA_INLINE std::uint32_t snapped(const CasterTriangle& t, const ExactPoints& points,
                                     const ExactLight& light, const Bunch& s, const F64& height_above,
                                     std::uint32_t dark) {
    alignas(64) double height[16];
    store(height, height_above);
    std::uint32_t beside = 0;
    for (; dark != 0; dark &= dark - 1) {
        const int k = __builtin_ctz(dark);
        const std::int32_t at = s.point[k];
        const double world[3] = {s.px[k], s.py[k], s.pz[k]};
        if (is_on_triangle(light, points.triangle[at], world)) continue;
        const float p[3] = {static_cast<float>(s.px[k] - light.eye[0]),
                            static_cast<float>(s.py[k] - light.eye[1]),
                            static_cast<float>(s.pz[k] - light.eye[2])};
        const float g[3] = {points.gx[at], points.gy[at], points.gz[at]};
        const float most_behind = static_cast<float>(-s.lowest[k]) + exact_snap(light, p, g, t.n);
        beside |= static_cast<std::uint32_t>(-height[k] <= static_cast<double>(most_behind)) << k;
    }
    return beside;
}

/// Open lanes of the bunch that the triangle darkens.
OBSCURA_INLINE std::uint32_t darkened(const CasterTriangle& t, float z_low, const ExactPoints& points,
                                      const ExactLight& light, const Bunch& s) {
    if (s.one_face && static_cast<std::int32_t>(t.face) == s.face[0]) return 0;
    const F64 height_above =
        (splat(t.n[0]) * load(s.px) + splat(t.n[1]) * load(s.py)) + (splat(t.n[2]) * load(s.pz) + splat(t.d));
    std::uint32_t dark = s.open & ~bits(greater_equal(height_above, load(s.lowest)));
    if (dark == 0) return 0;
    if (!s.one_face) dark &= ~bits(equal(load(s.face), splat(static_cast<std::int32_t>(t.face))));
    if (!(z_low <= s.z_low)) dark &= bits(less_equal(splat(z_low), load(s.z)));
    if (dark != 0) dark = covered(t, s, dark);
    if (dark == 0 || !is_seen(t, light.viewer)) return dark;
    const std::uint32_t near = dark & bits(greater_equal(height_above, splat(s.near)));
    return near == 0 ? dark : dark & ~snapped(t, points, light, s, height_above, near);
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
