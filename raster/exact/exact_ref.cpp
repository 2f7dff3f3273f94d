// Shadows of a picture's own samples, one sample and one triangle at a time: the definition.

#include <cmath>

#include "core/scalar_lanes.h"
#include "core/vec.h"
#include "raster/exact/exact_question.h"
#include "raster/exact/exact_shadow.h"
#include "raster/view.h"

namespace obscura::ref {
namespace {

/// Value of edge k at the sample: inside when >= 0 (edge_function() of raster/coverage.h).
std::int64_t edge(const CasterTriangle& t, int k, const Place& s) {
    const int n = k == 2 ? 0 : k + 1;
    const std::int64_t A = std::int64_t{t.y[k]} - t.y[n], B = std::int64_t{t.x[n]} - t.x[k];
    const bool keeps_its_edge = A > 0 || (A == 0 && B > 0);
    return A * (s.x - std::int64_t{t.x[k]}) + B * (s.y - std::int64_t{t.y[k]}) - (keeps_its_edge ? 0 : 1);
}

bool covers(const CasterTriangle& t, const Place& s) {
    return edge(t, 0, s) >= 0 && edge(t, 1, s) >= 0 && edge(t, 2, s) >= 0;
}

double height_above(const CasterTriangle& t, const Place& s) {
    return (t.n[0] * s.p.x + t.n[1] * s.p.y) + (t.n[2] * s.p.z + t.d);
}

/// Whether the camera and the light see the same side of the plane.
bool is_seen(const CasterTriangle& t, const double (&viewer)[4]) {
    return (t.n[0] * viewer[0] + t.n[1] * viewer[1]) + (t.n[2] * viewer[2] + t.d * viewer[3]) > 0;
}

/// Whether point `at` seems to be behind the plane only for being snapped beside its place.
bool is_snapped(const CasterTriangle& t, const ExactLight& light, const ExactPoints& points, int at,
                double behind, float rounding) {
    const double world[3] = {points.px[at], points.py[at], points.pz[at]};
    if (!is_seen(t, light.viewer) || is_on_triangle(light, points.triangle[at], world)) return false;
    const float p[3] = {static_cast<float>(points.px[at] - light.eye[0]),
                        static_cast<float>(points.py[at] - light.eye[1]),
                        static_cast<float>(points.pz[at] - light.eye[2])};
    const float g[3] = {points.gx[at], points.gy[at], points.gz[at]};
    return behind <= static_cast<double>(rounding + exact_snap(light, p, g, t.n));
}

}  // namespace

bool darkens(const CasterTriangle& t, float z_low, const ExactLight& light, const ExactPoints& points,
             const Place& s) {
    if (t.face == s.face || !(z_low <= s.z) || !covers(t, s)) return false;
    const double height = height_above(t, s);
    return !(height >= -static_cast<double>(s.rounding)) &&
           !is_snapped(t, light, points, s.point, -height, s.rounding);
}

namespace {

bool may_hold(const CasterBoxes& b, int k, const Place& s) {
    return b.x_low[k] <= s.x && s.x <= b.x_high[k] && b.y_low[k] <= s.y && s.y <= b.y_high[k] &&
           b.z_low[k] <= s.z;
}

/// Whether anything in group i of boxes of a level darkens the sample.
bool darkened_by(const ExactLight& light, const ExactPoints& points, const ExactView& view, int level,
                 std::size_t i, const Place& s, ExactCounts& counts) {
    const CasterBoxes& boxes = view.boxes[level][i];
    ++counts.groups;
    for (int k = 0; k < 16; ++k) {
        if (!may_hold(boxes, k, s)) continue;
        const std::size_t child = 16 * i + static_cast<std::size_t>(k);
        if (level > 0) {
            if (darkened_by(light, points, view, level - 1, child, s, counts)) return true;
        } else {
            ++counts.triangles;
            if (darkens(view.triangles[child], boxes.z_low[k], light, points, s)) return true;
        }
    }
    return false;
}

bool is(const std::uint32_t* mask, int at) {
    return (mask[at / 16] >> (at % 16) & 1u) != 0;
}

Vec3d position(const ExactPoints& points, int at) {
    return {points.px[at], points.py[at], points.pz[at]};
}

Vec3f relative(const ExactLight& light, Vec3d p) {
    return to_float(p - Vec3d{light.eye[0], light.eye[1], light.eye[2]});
}

Vec3f towards(const ExactLight& light, Vec3f p) {
    if (light.directional) return {light.to_light[0], light.to_light[1], light.to_light[2]};
    return Vec3f{light.position[0], light.position[1], light.position[2]} - p;
}

}  // namespace

Question question(const ExactPoints& points, const ExactLight& light, int at) {
    Question q;
    if (!is(points.covered, at)) return q;
    const Vec3f p = relative(light, position(points, at)), to_light = towards(light, p);
    const Vec3f g{points.gx[at], points.gy[at], points.gz[at]};
    if (!(0.0f < dot(g, to_light)) && !is(points.thin, at)) return q;
    q.asks = true;
    q.view = light.views == 6 ? cube_face(-to_light) : 0;

    const ExactView& view = light.view[q.view];
    Place& place = q.place;
    place.p = position(points, at);
    place.point = at;
    double w = 1.0;
    q.looks = view.levels > 0;
    if (view.perspective) {
        w = row_at(view.to_map[3], place.p);
        q.looks = q.looks && w >= view.near_w;
    }
    const double inv = 1.0 / w;
    const auto on_grid = [&](int r) {
        const double steps = (row_at(view.to_map[r], place.p) * inv) * 256.0;
        return static_cast<std::int32_t>(std::nearbyint(lane_min(lane_max(steps, -1.0), view.steps + 1.0)));
    };
    place.x = on_grid(0);
    place.y = on_grid(1);
    q.looks = q.looks && place.x >= 0 && place.x <= view.steps && place.y >= 0 && place.y <= view.steps;
    place.z = static_cast<float>(row_at(view.to_map[2], place.p) * inv);
    const float reach =
        light.viewer[3] != 0 ? std::fabs(dot(g, p)) : (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z);
    place.rounding = exact_depth_error * reach + static_cast<float>(view.step_m) * static_cast<float>(w);
    place.face = points.face[at];
    return q;
}

void add_sample(const Question& q, ExactSamples& samples) {
    const std::int32_t i = samples.count++;
    samples.x[i] = q.place.x;
    samples.y[i] = q.place.y;
    samples.z[i] = q.place.z;
    samples.rounding[i] = q.place.rounding;
    samples.point[i] = static_cast<std::uint32_t>(q.place.point);
    samples.view[i] = static_cast<std::uint8_t>(q.view);
}

void exact_locate(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                  std::uint32_t* lit, ExactCounts& /*counts*/) noexcept {
    samples.count = 0;
    for (int at = 0; at < points.count; ++at) {
        if (at % 16 == 0) lit[at / 16] = 0;
        const Question q = question(points, light, at);
        if (q.asks) lit[at / 16] |= 1u << (at % 16);
        if (q.looks) add_sample(q, samples);
    }
}

void exact_darken(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,
                  const std::uint32_t* order, std::uint32_t* lit, ExactCounts& counts) noexcept {
    for (std::int32_t k = 0; k < samples.count; ++k) {
        const std::uint32_t i = order[k];
        const auto at = static_cast<int>(samples.point[i]);
        const ExactView& view = light.view[samples.view[i]];
        const Place place{position(points, at),
                          samples.x[i],
                          samples.y[i],
                          samples.z[i],
                          samples.rounding[i],
                          points.face[at],
                          at};
        ++counts.samples;
        if (darkened_by(light, points, view, view.levels - 1, 0, place, counts))
            lit[at / 16] &= ~(1u << (at % 16));
    }
}

ExactShadow exact_shadow(const ExactPoints& points, const ExactLight& light, int at) {
    ExactShadow shadow;
    const Question q = question(points, light, at);
    if (!q.asks) return shadow;
    shadow.asks = shadow.lit = true;
    shadow.view = q.view;
    shadow.x = q.place.x;
    shadow.y = q.place.y;
    shadow.rounding_m = q.place.rounding;
    shadow.on_map = q.looks;
    if (!q.looks) return shadow;
    const ExactView& view = light.view[q.view];
    const Vec3d to_light = to_double(normalize(towards(light, relative(light, position(points, at)))));
    // Every triangle, whatever the boxes say.
    for (std::size_t i = 0; i < static_cast<std::size_t>(view.count); ++i) {
        const CasterTriangle& t = view.triangles[i];
        if (!darkens(t, view.boxes[0][i / 16].z_low[i % 16], light, points, q.place)) continue;
        ++shadow.triangles;
        const double behind = -height_above(t, q.place);
        const double distance = behind / dot(Vec3d{t.n[0], t.n[1], t.n[2]}, to_light);
        if (!shadow.lit && distance >= shadow.distance_m) continue;
        shadow.lit = false;
        shadow.triangle = t.triangle;
        shadow.distance_m = distance;
        shadow.behind_m = behind;
    }
    return shadow;
}

bool exact_darkens(const ExactPoints& points, const ExactLight& light, int at, std::size_t i) {
    const Question q = question(points, light, at);
    const ExactView& view = light.view[q.view];
    return q.looks && darkens(view.triangles[i], view.boxes[0][i / 16].z_low[i % 16], light, points, q.place);
}

}  // namespace obscura::ref
