// The nearest triangle before samples, bunches of sixteen neighbours on the light's grid. See
// exact_nearest_ref.cpp for the meaning of each step.

#include "raster/depth_tile.h"
#include "raster/exact/exact_bunch.h"
#include "raster/exact/exact_nearest.h"
#include "raster/exact/exact_receivers.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// What is known to stand before a bunch.
struct Before {
    alignas(64) double distance[16];
    std::uint32_t triangle[16];
};

/// Takes the triangle for those lanes of the bunch that it darkens and that it is nearer to.
OBSCURA_INLINE void consider(const CasterTriangle& t, float z_low, const ExactPoints& points,
                             const ExactLight& light, Bunch& s, Before& before) {
    // Planes first: most triangles lie farther off than what is known.
    const F64 height =
        (splat(t.n[0]) * load(s.px) + splat(t.n[1]) * load(s.py)) + (splat(t.n[2]) * load(s.pz) + splat(t.d));
    const F64 distance = (splat(0.0) - height) / splat(exact_cosine(t, light));
    const std::uint32_t all = s.open;
    s.open = all & bits(greater_equal(load(before.distance), distance));
    if (s.open != 0) {
        std::uint32_t dark = darkened(t, z_low, points, light, s);
        if (dark != 0) {
            alignas(64) double d[16];
            store(d, distance);
            for (; dark != 0; dark &= dark - 1) {
                const int k = __builtin_ctz(dark);
                if (!exact_is_nearer(d[k], t.triangle, before.distance[k], before.triangle[k])) continue;
                before.distance[k] = d[k];
                before.triangle[k] = t.triangle;
            }
        }
    }
    s.open = all;
}

OBSCURA_INLINE void consider_near(const ExactPoints& points, const ExactLight& light, const ExactView& view,
                                  const Nearby& nearby, Bunch& s, Before& before, ExactCounts& counts) {
    const std::uint32_t near = overlapping(nearby.around, s.extent);
    ++counts.groups;
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
        const int g = __builtin_ctz(left);
        ++counts.groups;
        for (std::uint32_t may = nearby.may_darken(16 * g, s); may != 0; may &= may - 1) {
            const int k = __builtin_ctz(may);
            ++counts.triangles;
            consider(view.triangles[nearby.triangle[16 * g + k]], nearby.boxes[g].z_low[k], points, light, s,
                     before);
        }
    }
}

/// All of what is before `n` bunches of one view.
void find_nearest(const ExactPoints& points, const ExactLight& light, const ExactView& view, Bunch* bunch,
                  Before* before, int n, Nearby& nearby, ExactCounts& counts) {
    // Halves, until what is near has room.
    while (n > 1 && !collect(light, view, bunch, n, nearby, counts)) {
        find_nearest(points, light, view, bunch, before, n / 2, nearby, counts);
        bunch += n / 2;
        before += n / 2;
        n -= n / 2;
    }
    if (n == 1) {
        walk(view, bunch->extent, counts.groups, [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
            ++counts.triangles;
            consider(view.triangles[first + static_cast<std::uint32_t>(k)], boxes.z_low[k], points, light,
                     *bunch, *before);
            return true;
        });
        return;
    }
    for (int b = 0; b < n; ++b)
        consider_near(points, light, view, nearby, bunch[b], before[b], counts);
}

}  // namespace

void exact_unlit(const ExactPoints& points, const ExactLight& light, const std::uint32_t* lit,
                 ExactSamples& samples) noexcept {
    std::int32_t n = 0;
    for (std::int32_t at = 0; at < points.count; at += lanes) {
        if ((points.covered[at / 16] & ~lit[at / 16]) == 0) continue;
        const Receivers r = receivers(points, light, at);
        for (std::int32_t v = 0; v < light.views; ++v) {
            std::uint32_t left = r.asking & ~lit[at / 16] & bits(equal(r.view, splat(v)));
            if (left == 0 || light.view[v].levels == 0) continue;
            const Located place = located(light, light.view[v], r.x, r.y, r.z, r.p, r.g);
            left &= place.looks;
            alignas(64) std::int32_t x[16], y[16];
            alignas(64) float z[16], rounding[16];
            store(x, place.x);
            store(y, place.y);
            store(z, place.z);
            store(rounding, place.rounding);
            for (; left != 0; left &= left - 1, ++n) {
                const int k = __builtin_ctz(left);
                samples.x[n] = x[k];
                samples.y[n] = y[k];
                samples.z[n] = z[k];
                samples.rounding[n] = rounding[k];
                samples.point[n] = static_cast<std::uint32_t>(at + k);
                samples.view[n] = static_cast<std::uint8_t>(v);
            }
        }
    }
    samples.count = n;
}

void exact_nearest(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,
                   const std::uint32_t* order, const ExactHits& hits, ExactCounts& counts) noexcept {
    Bunch bunch[bunches];
    Before before[bunches];
    Nearby nearby;
    std::int32_t next = 0;
    while (next < samples.count) {
        const std::int32_t first = next;
        const std::uint8_t view = samples.view[order[next]];
        const int n = gather_bunches(points, light, samples, order, next, bunch);
        for (int b = 0; b < n; ++b) {
            for (int k = 0; k < lanes; ++k) {
                before[b].distance[k] = __builtin_inf();
                before[b].triangle[k] = no_triangle;
            }
        }
        find_nearest(points, light, light.view[view], bunch, before, n, nearby, counts);
        for (std::int32_t i = first; i < next; ++i) {
            const std::int32_t at = i - first;
            const std::uint32_t point = samples.point[order[i]];
            hits.triangle[point] = before[at / lanes].triangle[at % lanes];
            hits.distance_m[point] = static_cast<float>(before[at / lanes].distance[at % lanes]);
        }
    }
    counts.samples += samples.count;
}

}  // namespace obscura::OBSCURA_ISA
