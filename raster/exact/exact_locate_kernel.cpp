// Points of the camera on the grids of a light's views, sixteen at a time; and the shadows of those that
// stand together before the light in the order in which they come. See exact_ref.cpp for the meaning of each
// step.

#include "raster/cube_lanes.h"
#include "raster/exact/exact_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE F64 row(const double (&m)[4], const F64& x, const F64& y, const F64& z) {
    return (splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3]));
}

/// How much larger than its share of the box of all a bunch's may be.
constexpr double most_of_share = 3;

/// Sixteen points on the grid of one view.
struct Located {
    I32 x, y;
    F32 z, rounding;
    std::uint32_t looks;
};

OBSCURA_INLINE Located located(const ExactLight& light, const ExactView& view, const F64& x, const F64& y,
                               const F64& z, const Vec3x16& p, const Vec3x16& g) {
    Located to;
    F64 w = splat(1.0);
    to.looks = 0xffffu;
    if (view.perspective) {
        w = row(view.to_map[3], x, y, z);
        to.looks &= bits(greater_equal(w, splat(view.near_w)));
    }
    const F64 inv = splat(1.0) / w;
    const auto on_grid = [&](int k) {
        const F64 steps = (row(view.to_map[k], x, y, z) * inv) * splat(256.0);
        return round_to_i32(min(max(steps, splat(-1.0)), splat(view.steps + 1.0)));
    };
    to.x = on_grid(0);
    to.y = on_grid(1);
    const I32 zero = splat(std::int32_t{0}), last = splat(view.steps);
    to.looks &= bits(less_equal(zero, to.x) & less_equal(to.x, last) & less_equal(zero, to.y) &
                     less_equal(to.y, last));
    to.z = to_f32(row(view.to_map[2], x, y, z) * inv);
    const F32 reach = light.viewer[3] != 0 ? abs(dot(g, p)) : (abs(p.x) + abs(p.y)) + abs(p.z);
    to.rounding = splat(exact_depth_error) * reach + splat(static_cast<float>(view.step_m)) * to_f32(w);
    return to;
}

/// Sixteen points as a bunch of a view, of which `open` lanes ask.
OBSCURA_INLINE void fill_bunch(const ExactPoints& points, const ExactLight& light, const Located& place,
                               std::int32_t at, std::uint32_t open, Bunch& to) {
    store(to.x, place.x);
    store(to.y, place.y);
    store(to.z, place.z);
    alignas(64) float rounding[16];
    store(rounding, place.rounding);
    store(to.px, load(points.px + at));
    store(to.py, load(points.py + at));
    store(to.pz, load(points.pz + at));
    store(to.face, load(reinterpret_cast<const std::int32_t*>(points.face + at)));
    store(to.point, splat(at) + lane_index());
    const int first = __builtin_ctz(open);
    for (std::uint32_t left = ~open & 0xffffu; left != 0; left &= left - 1) {
        const int k = __builtin_ctz(left);
        to.x[k] = to.x[first];
        to.y[k] = to.y[first];
        to.z[k] = to.z[first];
        rounding[k] = rounding[first];
        to.px[k] = to.px[first];
        to.py[k] = to.py[first];
        to.pz[k] = to.pz[first];
        to.face[k] = to.face[first];
    }
    finish_bunch(light, load(rounding), open, to);
}

OBSCURA_INLINE double area(const Extent& e) {
    return (1.0 + e.x_high - e.x_low) * (1.0 + e.y_high - e.y_low);
}

/// Samples that wait for an order of their own.
OBSCURA_INLINE void append(const Bunch& from, std::int32_t view, ExactSamples& to) {
    std::int32_t n = to.count;
    for (std::uint32_t left = from.open; left != 0; left &= left - 1, ++n) {
        const int k = __builtin_ctz(left);
        to.x[n] = from.x[k];
        to.y[n] = from.y[k];
        to.z[n] = from.z[k];
        to.rounding[n] = static_cast<float>(-from.lowest[k]);
        to.point[n] = static_cast<std::uint32_t>(from.point[k]);
        to.view[n] = static_cast<std::uint8_t>(view);
    }
    to.count = n;
}

/// Leaves those of n bunches that stand together before the light: neighbours on a surface do, whose boxes
/// share out the box of all of them; leaves and what is seen between them do not, and their samples wait.
/// Returns how many are left.
OBSCURA_INLINE int keep_together(Bunch* bunch, int n, std::int32_t view, ExactSamples& samples) {
    Extent all = bunch[0].extent;
    for (int b = 1; b < n; ++b)
        all = united(all, bunch[b].extent);
    const double largest = area(all) * most_of_share / n;
    int left = 0;
    for (int b = 0; b < n; ++b) {
        if (area(bunch[b].extent) > largest) {
            append(bunch[b], view, samples);
        } else {
            if (left != b) bunch[left] = bunch[b];
            ++left;
        }
    }
    return left;
}

/// Sixteen points as the light sees them.
struct Receivers {
    F64 x, y, z;
    Vec3x16 p, g;
    I32 view;
    std::uint32_t asking;
};

OBSCURA_INLINE Receivers receivers(const ExactPoints& points, const ExactLight& light, std::int32_t at) {
    Receivers r;
    r.x = load(points.px + at);
    r.y = load(points.py + at);
    r.z = load(points.pz + at);
    r.p = {to_f32(r.x - splat(light.eye[0])), to_f32(r.y - splat(light.eye[1])),
           to_f32(r.z - splat(light.eye[2]))};
    r.g = load3(points.gx + at, points.gy + at, points.gz + at);
    const Vec3x16 l = light.directional ? splat3(light.to_light) : splat3(light.position) - r.p;
    r.asking = points.covered[at / 16] & (bits(less(splat(0.0f), dot(r.g, l))) | points.thin[at / 16]);
    r.view = light.views == 6 ? cube_faces(negated(mask_of(0xffffu), l)) : splat(std::int32_t{0});
    return r;
}

}  // namespace

void exact_locate(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                  std::uint32_t* lit, ExactCounts& counts) noexcept {
    samples.count = 0;
    Bunch bunch[bunches];
    Nearby nearby;
    for (std::int32_t chunk = 0; chunk < points.count; chunk += lanes * bunches) {
        const std::int32_t end = least(chunk + lanes * bunches, points.count);
        std::uint32_t views = 0;
        for (std::int32_t at = chunk; at < end; at += lanes) {
            lit[at / 16] = 0;
            if (points.covered[at / 16] == 0) continue;
            const Receivers r = receivers(points, light, at);
            lit[at / 16] = r.asking;
            for (std::int32_t v = 0; v < light.views; ++v)
                views |= static_cast<std::uint32_t>((r.asking & bits(equal(r.view, splat(v)))) != 0) << v;
        }
        for (; views != 0; views &= views - 1) {
            const std::int32_t v = __builtin_ctz(views);
            const ExactView& view = light.view[v];
            if (view.levels == 0) continue;
            int n = 0;
            for (std::int32_t at = chunk; at < end; at += lanes) {
                if (points.covered[at / 16] == 0) continue;
                const Receivers r = receivers(points, light, at);
                const std::uint32_t of_view = r.asking & bits(equal(r.view, splat(v)));
                if (of_view == 0) continue;
                const Located place = located(light, view, r.x, r.y, r.z, r.p, r.g);
                const std::uint32_t open = of_view & place.looks;
                if (open != 0) fill_bunch(points, light, place, at, open, bunch[n++]);
            }
            if (n > 0) n = keep_together(bunch, n, v, samples);
            if (n == 0) continue;
            // Where too much is near, samples wait.
            const bool fits = collect(light, view, bunch, n, nearby, counts);
            for (int b = 0; b < n; ++b) {
                const std::uint32_t asked = bunch[b].open;
                if (fits && darken_near(points, light, view, nearby, most_near, bunch[b], counts)) {
                    counts.samples += __builtin_popcount(asked);
                    lit[bunch[b].point[0] / 16] &= ~(asked & ~bunch[b].open);
                } else {
                    append(bunch[b], v, samples);
                }
            }
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
