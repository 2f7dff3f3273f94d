// Shadows of a light with a size, part by part against every triangle: the definition. And how far its size
// reaches.

#include <algorithm>
#include <cmath>

#include "core/emitter_surface.h"
#include "core/error.h"
#include "core/num.h"
#include "core/scalar_lanes.h"
#include "core/scene.h"
#include "core/vec.h"
#include "raster/exact/exact_question.h"
#include "raster/exact/exact_soft.h"
#include "raster/record.h"
#include "raster/view.h"

namespace obscura {
namespace {

double row_length(const double (&row)[4]) {
    return length(Vec3d{row[0], row[1], row[2]});
}

double largest_radius(const Light& l) {
    if (l.kind == LightKind::surface) {
        CHECK(l.surface != nullptr, "a light of surfaces without any");
        return l.surface->radius_m;
    }
    if (l.kind != LightKind::area) return l.radius_m;
    // The corner of a rectangle; of an ellipse, the end of the longer axis.
    if (l.shape == AreaShape::disc) return 0.5 * std::max(l.width_m, l.height_m);
    return 0.5 * std::sqrt(l.width_m * l.width_m + l.height_m * l.height_m);
}

}  // namespace

ExactSpread exact_spread(const Light& l, const ExactLight& light) {
    ExactSpread s;
    if (is_parallel(l.kind)) {
        s.sine = num::sin_deg(0.5 * l.angular_diameter_deg);
        s.tangent = num::tan(0.5 * l.angular_diameter_deg * (num::pi / 180));
    } else {
        s.radius_m = largest_radius(l);
    }
    for (int v = 0; v < light.views; ++v) {
        const ExactView& view = light.view[v];
        const double steps = 256 * std::max(row_length(view.to_map[0]), row_length(view.to_map[1]));
        const double depth = row_length(view.to_map[2]);
        if (is_parallel(l.kind)) {
            // A metre nearer moves the rim's view by `tangent` metres across.
            s.metres_per_depth = static_cast<float>(1 / depth);
            s.steps_per_depth[v] = static_cast<float>(s.tangent * steps / depth * 1.0001);
        } else {
            // Depth is k (1 - near / w), so 1 / w changes by depth / (k near); the first row holds texels
            // per tangent and half the width, so it is longer than what is wanted, never shorter.
            s.steps_per_depth[v] = static_cast<float>(s.radius_m * steps / (depth * view.near_w) * 1.0001);
        }
    }
    return s;
}

namespace ref {
namespace {

bool is(const std::uint32_t* mask, int at) {
    return (mask[at / 16] >> (at % 16) & 1u) != 0;
}

Vec3d position(const ExactPoints& points, int at) {
    return {points.px[at], points.py[at], points.pz[at]};
}

Vec3f relative(const ExactPoints& points, const ExactLight& light, int at) {
    return to_float(position(points, at) - Vec3d{light.eye[0], light.eye[1], light.eye[2]});
}

Vec3f normal(const ExactPoints& points, int at) {
    return {points.gx[at], points.gy[at], points.gz[at]};
}

/// Samples of one view that are taken together, at most sixteen.
struct Group {
    int n = 0;
    std::int32_t x_low = 0, x_high = 0, y_low = 0, y_high = 0;
    float z_high = 0;
    Vec3f low, high;  ///< what they span, relative to the eye
};

void add(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples, std::uint32_t i,
         Group& g) {
    const bool first = g.n++ == 0;
    const std::int32_t x = samples.x[i], y = samples.y[i];
    g.x_low = first ? x : std::min(g.x_low, x);
    g.x_high = first ? x : std::max(g.x_high, x);
    g.y_low = first ? y : std::min(g.y_low, y);
    g.y_high = first ? y : std::max(g.y_high, y);
    g.z_high = first ? samples.z[i] : std::max(g.z_high, samples.z[i]);
    const Vec3f p = relative(points, light, static_cast<int>(samples.point[i]));
    const auto low = [](Vec3f a, Vec3f b) {
        return Vec3f{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    };
    g.low = first ? p : low(g.low, p);
    g.high = first ? p : -low(-g.high, -p);
}

bool is_near(const CasterTriangle& t, const Group& g, std::int32_t reach) {
    const auto [x_low, x_high] = std::minmax({t.x[0], t.x[1], t.x[2]});
    const auto [y_low, y_high] = std::minmax({t.y[0], t.y[1], t.y[2]});
    return x_low <= g.x_high + reach && g.x_low - reach <= x_high && y_low <= g.y_high + reach &&
           g.y_low - reach <= y_high && !exact_outside(t, g.x_low, g.x_high, g.y_low, g.y_high, reach);
}

/// Part k of sixteen by itself, as ref::question() knows lights.
ExactLight light_of(const ExactParts& parts, std::size_t k, const ExactLight& middle) {
    ExactLight light = middle;
    ExactView& view = light.view[0];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            view.to_map[r][c] = parts.to_map[r][c][k];
        light.to_light[r] = parts.to_light[r][k];
    }
    view.step_m = static_cast<double>(parts.step_m[k]);
    return light;
}

/// A caster of the middle as part k of sixteen sees it, and its nearest depth.
CasterTriangle seen_by(const ExactParts& parts, std::size_t k, const ExactSoft& soft,
                       const CasterTriangle& of_middle, float& z_low) {
    const PartVertex* v[3];
    for (std::size_t c = 0; c < 3; ++c)
        v[c] = parts.vertices + soft.corners[3 * std::size_t{of_middle.triangle} + c];
    // Four units in the last place below the nearest corner's.
    z_low = std::min({v[0]->z[k], v[1]->z[k], v[2]->z[k]}) - 0x1p-22f;
    const std::int64_t area = std::int64_t{v[1]->x[k] - v[0]->x[k]} * (v[2]->y[k] - v[0]->y[k]) -
                              std::int64_t{v[2]->x[k] - v[0]->x[k]} * (v[1]->y[k] - v[0]->y[k]);
    if (area < 0) std::swap(v[1], v[2]);
    CasterTriangle t{};
    for (int c = 0; c < 3; ++c) {
        t.x[c] = v[c]->x[k];
        t.y[c] = v[c]->y[k];
    }
    t.triangle = of_middle.triangle;
    t.face = of_middle.face;
    const double(&plane)[4] = soft.planes[t.face];
    const double facing =
        (plane[0] * parts.way[0][k] + plane[1] * parts.way[1][k]) + plane[2] * parts.way[2][k];
    const double side = facing > 0 ? 1.0 : (facing < 0 ? -1.0 : 0.0);
    for (int c = 0; c < 3; ++c)
        t.n[c] = plane[c] * side;
    t.d = plane[3] * side;
    return t;
}

}  // namespace

void exact_reach(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread,
                 ExactSamples& samples) noexcept {
    samples.count = 0;
    const Vec3f axis{middle.to_light[0], middle.to_light[1], middle.to_light[2]};
    const Vec3f lamp{middle.position[0], middle.position[1], middle.position[2]};
    for (int group = 0; group < points.count; group += 16) {
        for (int v = 0; v < middle.views; ++v) {
            const ExactView& view = middle.view[v];
            for (int at = group; at < group + 16; ++at) {
                if (!is(points.covered, at)) continue;
                const Vec3f p = relative(points, middle, at), g = normal(points, at);
                const Vec3f l = middle.directional ? axis : lamp - p;
                const float facing = dot(g, l), least = middle.directional ? exact_facing(spread) : 0.0f;
                if (!(least < facing) && !is(points.thin, at)) continue;
                if ((middle.views == 6 ? cube_face(-l) : 0) != v) continue;
                const Vec3d world = position(points, at);
                const double w = view.perspective ? row_at(view.to_map[3], world) : 1.0, inv = 1.0 / w;
                const auto on_grid = [&](int r) {
                    const double steps = (row_at(view.to_map[r], world) * inv) * 256.0;
                    return static_cast<std::int32_t>(
                        std::nearbyint(lane_min(lane_max(steps, -exact_beyond), view.steps + exact_beyond)));
                };
                const std::int32_t x = on_grid(0), y = on_grid(1);
                const bool on_map = x >= 0 && x <= view.steps && y >= 0 && y <= view.steps;
                if (!middle.directional && (!(w >= view.near_w) || !on_map)) continue;
                const float reach = middle.viewer[3] != 0
                                        ? std::fabs(dot(g, p))
                                        : (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z);
                const std::int32_t i = samples.count++;
                samples.x[i] = x;
                samples.y[i] = y;
                samples.z[i] = static_cast<float>(row_at(view.to_map[2], world) * inv);
                samples.rounding[i] =
                    exact_depth_error * reach + static_cast<float>(view.step_m) * static_cast<float>(w);
                samples.point[i] = static_cast<std::uint32_t>(at);
                samples.view[i] = static_cast<std::uint8_t>(v);
            }
        }
    }
}

void exact_widest(const ExactPoints& points, const ExactLight& middle, const ExactSpread& spread,
                  const ExactSamples& samples, const std::uint32_t* order, float /*stop_px*/,
                  float& widest_px, ExactCounts& counts) noexcept {
    widest_px = 0;
    std::int32_t next = 0;
    while (next < samples.count) {
        const std::int32_t first = next;
        const std::uint8_t v = samples.view[order[first]];
        Group g;
        for (; next < samples.count && next < first + 16 && samples.view[order[next]] == v; ++next)
            add(points, middle, samples, order[next], g);
        const ExactView& view = middle.view[v];
        const auto beyond = static_cast<std::int32_t>(exact_beyond);
        if (std::min(g.x_low, g.y_low) <= -beyond || std::max(g.x_high, g.y_high) >= 2 * beyond) continue;
        const Vec3f m = (g.low + g.high) * 0.5f;
        const float place[3] = {m.x, m.y, m.z};
        for (std::int64_t t = 0; t < view.count; ++t) {
            const CasterTriangle& caster = view.triangles[t];
            const float z_low = view.boxes[0][t / 16].z_low[t % 16], depth = g.z_high - z_low;
            if (!(z_low <= g.z_high) || !is_near(caster, g, exact_steps(spread, v, depth))) continue;
            ++counts.triangles;
            for (std::int32_t k = first; k < next; ++k) {
                const auto at = static_cast<int>(samples.point[order[k]]);
                if (points.face[at] == caster.face) continue;
                const double p[3] = {points.px[at], points.py[at], points.pz[at]};
                const double height =
                    (caster.n[0] * p[0] + caster.n[1] * p[1]) + (caster.n[2] * p[2] + caster.d);
                const float before = exact_distance(caster, middle, spread, depth, p, height,
                                                    -static_cast<double>(samples.rounding[order[k]]));
                if (before > 0)
                    widest_px = std::max(widest_px, exact_penumbra_px(middle, spread, place, before));
            }
        }
    }
    counts.samples += samples.count;
}

void exact_see(const float* xyz, std::size_t begin, std::size_t end, const ExactParts& parts,
               PartVertex* out) noexcept {
    for (std::size_t i = begin; i < end; ++i) {
        const double x = static_cast<double>(xyz[3 * i]), y = static_cast<double>(xyz[3 * i + 1]),
                     z = static_cast<double>(xyz[3 * i + 2]);
        for (int k = 0; k < 16; ++k) {
            const auto coordinate = [&](int r) {
                const double(&m)[4][16] = parts.to_map[r];
                return (m[0][k] * x + m[1][k] * y) + (m[2][k] * z + m[3][k]);
            };
            const auto on_grid = [&](int r) {
                const double texels =
                    lane_min(lane_max(coordinate(r), -1.0 * exact_view_texels), 2.0 * exact_view_texels);
                return static_cast<std::int32_t>(std::nearbyint(texels * 256.0));
            };
            out[i].x[k] = on_grid(0);
            out[i].y[k] = on_grid(1);
            out[i].z[k] = lane_max(lane_min(static_cast<float>(coordinate(2)), 1.0f), 0.0f);
        }
    }
}

void exact_soft(const ExactPoints& points, const ExactSoft& light, const ExactSamples& samples,
                const std::uint32_t* /*order*/, std::uint32_t* lit, std::int32_t stride,
                ExactCounts& counts) noexcept {
    const ExactView& view = light.middle.view[0];
    for (std::int32_t p = 0; p < 16 * light.groups; ++p) {
        const ExactParts& parts = light.parts[p / 16];
        const auto part = static_cast<std::size_t>(p % 16);
        if (p % 16 >= parts.count) continue;
        const ExactLight own = light_of(parts, part, light.middle);
        for (std::int32_t i = 0; i < samples.count; ++i) {
            const auto at = static_cast<int>(samples.point[i]);
            const Question q = question(points, own, at);
            bool is_lit = q.asks;
            counts.samples += q.looks ? 1 : 0;
            for (std::int64_t t = 0; q.looks && is_lit && t < view.count; ++t) {
                float z_low = 0;
                const CasterTriangle caster = seen_by(parts, part, light, view.triangles[t], z_low);
                ++counts.triangles;
                is_lit = !darkens(caster, z_low, own, points, q.place);
            }
            std::uint32_t& word = lit[p * stride + at / 16];
            word = (word & ~(1u << (at % 16))) | static_cast<std::uint32_t>(is_lit) << (at % 16);
        }
    }
}

}  // namespace ref
}  // namespace obscura
