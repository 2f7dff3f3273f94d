// Percentage-closer filtering, one receiver and one texel at a time.

#include <algorithm>
#include <cmath>

#include "core/scalar_lanes.h"
#include "core/vec.h"
#include "filters/pcf.h"
#include "filters/shadow_lookup.h"
#include "raster/view.h"

namespace obscura::ref {
namespace {

/// Which way the light is, not normalised.
Vec3f towards(const PcfLight& light, Vec3f p) {
    if (light.directional) return {light.to_light[0], light.to_light[1], light.to_light[2]};
    return Vec3f{light.position[0], light.position[1], light.position[2]} - p;
}

/// A receiver on its way to the map, relative to the eye; `n` turned to the light's side.
struct Moved {
    double x, y, z;
    Vec3f n, to_light;
    double row(const double (&m)[4]) const { return (m[0] * x + m[1] * y) + (m[2] * z + m[3]); }
};

/// Distance of p from the light along the axis of the map that sees it; 1 for parallel light.
double axial_distance(const PcfLight& light, const Moved& p) {
    if (light.views == 1) return light.view[0].perspective ? p.row(light.view[0].to_map[3]) : 1.0;
    const Vec3f l = p.to_light;
    return static_cast<double>(lane_max(lane_max(std::fabs(l.x), std::fabs(l.y)), std::fabs(l.z)));
}

Moved move(const PcfLight& light, Vec3f p, Vec3f n, Vec3f to_light, bool open) {
    Moved m{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z), n, to_light};
    if (!open) return m;
    double offset = light.view[0].offset_m * axial_distance(light, m);
    if (!light.directional) {
        offset = lane_min(offset, static_cast<double>(pcf_nearest_offset * dot(n, to_light)));
    }
    m.x = m.x + static_cast<double>(n.x) * offset;
    m.y = m.y + static_cast<double>(n.y) * offset;
    m.z = m.z + static_cast<double>(n.z) * offset;
    m.to_light = towards(light, {static_cast<float>(m.x), static_cast<float>(m.y), static_cast<float>(m.z)});
    return m;
}

PcfPlace place(const PcfView& view, const Moved& p) {
    PcfPlace r;
    const double w = p.row(view.to_map[3]);
    const double inv = view.perspective ? 1.0 / w : 1.0;
    r.kind = view.perspective && !(w >= view.near_w) ? PcfPlace::before_near : PcfPlace::on_map;
    // Far off the map any place will do, as long as its number fits an integer.
    const double low = -8.0, high = static_cast<double>(view.size) + 8.0;
    r.X = lane_min(lane_max(p.row(view.to_map[0]) * inv, low), high);
    r.Y = lane_min(lane_max(p.row(view.to_map[1]) * inv, low), high);
    // Beyond the map's depth range there is only background, at depth 1.
    r.depth = lane_min(static_cast<float>(p.row(view.to_map[2]) * inv), 1.0f);
    const float least = pcf_least_cosine * std::sqrt(dot(p.to_light, p.to_light));
    const float inv_nl = 1.0f / lane_max(dot(p.n, p.to_light), least);
    r.slope_x = dot(p.n, Vec3f{view.slope_x[0], view.slope_x[1], view.slope_x[2]}) * inv_nl;
    r.slope_y = dot(p.n, Vec3f{view.slope_y[0], view.slope_y[1], view.slope_y[2]}) * inv_nl;
    return r;
}

/// Weight of tap k (0 .. side - 1), before the division by side - 1.
float tap_weight(int k, int side, float f) {
    if (side == 1) return 1.0f;
    if (k == 0) return 1.0f - f;
    return k == side - 1 ? f : 1.0f;
}

/// Twin of StoredDepths::index().
std::int64_t block_index(std::int64_t x, std::int64_t y, std::int64_t size) {
    return ((y / 4) * (size / 4) + x / 4) * 16 + (y % 4) * 4 + x % 4;
}

/// Calls tap(x, y, depth, weight_x) for each texel of the kernel, with the depth of the receiver's plane at
/// its centre, and returns the filtered visibility.
template <class Tap>
float filtered(const PcfPlace& r, int side, Tap&& tap) {
    // Place on a grid of 1/256 texel: the sums below are then exact, and full light is exactly 1.
    const auto x256 = static_cast<std::int32_t>(std::nearbyint(r.X * 256.0));
    const auto y256 = static_cast<std::int32_t>(std::nearbyint(r.Y * 256.0));
    const std::int32_t ix = x256 >> 8, iy = y256 >> 8;
    const float fx = static_cast<float>(x256 & 255) * (1.0f / 256.0f);
    const float fy = static_cast<float>(y256 & 255) * (1.0f / 256.0f);
    // From the receiver to the centre of its own texel, not rounded to the grid.
    const float to_centre_x = static_cast<float>((static_cast<double>(ix) + 0.5) - r.X);
    const float to_centre_y = static_cast<float>((static_cast<double>(iy) + 0.5) - r.Y);
    const int reach = side / 2;
    float sum = 0.0f;
    for (int j = 0; j < side; ++j) {
        const float rise_y = r.slope_y * (to_centre_y + static_cast<float>(j - reach));
        float row = 0.0f;
        for (int i = 0; i < side; ++i) {
            const float rise_x = r.slope_x * (to_centre_x + static_cast<float>(i - reach));
            const float depth = r.depth + lane_min(rise_x + rise_y, 0.0f);
            const float weight = tap_weight(i, side, fx);
            row = row + (tap(ix + i - reach, iy + j - reach, depth, weight) ? weight : 0.0f);
        }
        sum = sum + row * tap_weight(j, side, fy);
    }
    const float scale = side == 1 ? 1.0f : (side == 3 ? 0.25f : 0.0625f);
    return sum * scale;
}

}  // namespace

PcfPlace pcf_place(const SurfaceBlock& s, const PcfLight& light, int at) {
    PcfPlace nowhere;
    const int group = at / 16;
    const std::uint32_t bit = 1u << (at & 15);
    if ((s.covered[group] & bit) == 0) return nowhere;

    // A face that looks away from the light is dark: no lookup.
    const Vec3f p = {s.px[at], s.py[at], s.pz[at]}, g = {s.gx[at], s.gy[at], s.gz[at]};
    const Vec3f l = towards(light, p);
    const float cosine = dot(g, l);
    nowhere.kind = PcfPlace::turned_away;
    if (!(0.0f < cosine) && (s.thin[group] & bit) == 0) return nowhere;

    const Moved receiver = move(light, p, cosine < 0.0f ? -g : g, l, (s.open[group] & bit) != 0);
    const int face = light.views == 6 ? cube_face(-receiver.to_light) : 0;
    PcfPlace r = place(light.view[face], receiver);
    r.view = face;
    return r;
}

PcfTrace trace_pcf(const SurfaceBlock& s, const PcfLight& light, int at) {
    PcfTrace trace;
    const PcfPlace r = pcf_place(s, light, at);
    if (r.kind == PcfPlace::nothing_there || r.kind == PcfPlace::turned_away) return trace;
    trace.view = r.view;
    trace.X = r.X;
    trace.Y = r.Y;
    trace.depth = r.depth;
    if (r.kind == PcfPlace::before_near) {
        trace.visibility = 1.0f;
        return trace;
    }
    const PcfView& view = light.view[r.view];
    trace.looked_up = true;
    const std::int32_t last = view.size - 1;
    trace.visibility =
        filtered(r, light.side, [&](std::int32_t x, std::int32_t y, float depth, float weight) {
            PcfTap tap{x, y, weight, false, depth, 1.0f, true};
            if (!light.directional) {
                tap.x = std::clamp(x, 0, last);
                tap.y = std::clamp(y, 0, last);
            }
            tap.inside = tap.x >= 0 && tap.y >= 0 && tap.x <= last && tap.y <= last;
            if (tap.inside) {
                tap.stored = view.stored[block_index(tap.x, tap.y, view.size)];
                tap.lit = depth <= tap.stored;
            }
            trace.taps.push_back(tap);
            return tap.lit;
        });
    return trace;
}

void pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    for (int at = 0; at < block_samples; ++at)
        visibility[at] = trace_pcf(surface, light, at).visibility;
}

}  // namespace obscura::ref
