// A light with a size, sixteen samples at a time: what any part of it may find before them, and what each
// does. See exact_soft_ref.cpp for the meaning of each step.

#include "raster/exact/exact_gather.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Whether parallel light may have the triangle before some of the bunch: distance_before() is not negative.
OBSCURA_INLINE bool may_darken(const CasterTriangle& t, float z_low, const ExactSoft& soft, const Bunch& s) {
    if (s.one_face && static_cast<std::int32_t>(t.face) == s.face[0]) return false;
    const float(&l)[3] = soft.middle.to_light;
    const double facing = (t.n[0] * static_cast<double>(l[0]) + t.n[1] * static_cast<double>(l[1])) +
                          t.n[2] * static_cast<double>(l[2]);
    if (facing > 1.01 * soft.spread.sine + exact_least_facing) {
        const F64 height = (splat(t.n[0]) * load(s.px) + splat(t.n[1]) * load(s.py)) +
                           (splat(t.n[2]) * load(s.pz) + splat(t.d));
        if ((s.open & ~bits(greater_equal(height, splat(0.0)))) == 0) return false;
    }
    return !exact_outside(t, s.extent.x_low, s.extent.x_high, s.extent.y_low, s.extent.y_high,
                          exact_steps(soft.spread, 0, s.extent.z_high - z_low));
}

/// What may darken something of sixteen samples, sixteen by sixteen.
struct Candidates {
    static constexpr int room = 256;
    alignas(64) std::int32_t x[3][room], y[3][room];
    alignas(64) float z_low[room];
    alignas(64) float n[3][room], d[room];  ///< planes that all of the light sees the same side of, relative
                                            ///< to the eye; others are 0 and lie below everything
    std::uint32_t place[room];
    int count = 0;

    OBSCURA_INLINE void add(const CasterTriangle& t, float z, std::uint32_t index, const ExactSoft& soft) {
        const int i = count++;
        for (int c = 0; c < 3; ++c) {
            x[c][i] = t.x[c];
            y[c][i] = t.y[c];
        }
        z_low[i] = z;
        place[i] = index;
        const ExactLight& light = soft.middle;
        const double facing = (t.n[0] * static_cast<double>(light.to_light[0]) +
                               t.n[1] * static_cast<double>(light.to_light[1])) +
                              t.n[2] * static_cast<double>(light.to_light[2]);
        const bool one_side = facing > 1.01 * soft.spread.sine + exact_least_facing;
        for (int c = 0; c < 3; ++c)
            n[c][i] = one_side ? static_cast<float>(t.n[c]) : 0.0f;
        d[i] = one_side ? static_cast<float>((t.n[0] * light.eye[0] + t.n[1] * light.eye[1]) +
                                             (t.n[2] * light.eye[2] + t.d))
                        : -1e30f;
    }

    /// Of the sixteen from `first` on those that some part of the light may have before sample k. Floats, so
    /// generous by their rounding.
    OBSCURA_INLINE std::uint32_t before(int first, const ExactSoft& soft, const Bunch& s, int k) const {
        std::uint32_t may = count - first >= lanes ? 0xffffu : (1u << (count - first)) - 1u;
        const F32 depth = splat(s.z[k]) - load(z_low + first);
        may &= bits(less_equal(splat(0.0f), depth));
        // It is before the plane by more than rounding.
        const float p[3] = {static_cast<float>(s.px[k] - soft.middle.eye[0]),
                            static_cast<float>(s.py[k] - soft.middle.eye[1]),
                            static_cast<float>(s.pz[k] - soft.middle.eye[2])};
        const F32 offset = load(d + first);
        const F32 height = (load(n[0] + first) * splat(p[0]) + load(n[1] + first) * splat(p[1])) +
                           (load(n[2] + first) * splat(p[2]) + offset);
        const float size = (__builtin_fabsf(p[0]) + __builtin_fabsf(p[1])) + __builtin_fabsf(p[2]);
        may &= bits(less(height - splat(0x1p-20f) * (splat(size) + abs(offset)), splat(0.0f)));
        if (may == 0) return 0;
        const F32 reach = min(splat(soft.spread.steps_per_depth[0]) * depth, splat(exact_most_reach)) +
                          splat(static_cast<float>(soft.spread.slack));
        const I32 sx = splat(s.x[k]), sy = splat(s.y[k]);
        for (int c = 0; c < 3 && may != 0; ++c) {
            const int next = c == 2 ? 0 : c + 1;
            const I32 xc = load(x[c] + first), yc = load(y[c] + first);
            const F32 A = to_f32(yc - load(y[next] + first)), B = to_f32(load(x[next] + first) - xc);
            const F32 across = A * to_f32(sx - xc), down = B * to_f32(sy - yc);
            const F32 slack =
                (abs(A) + abs(B)) * reach + splat(0x1p-20f) * (abs(across) + abs(down)) + splat(1.0f);
            may &= bits(less_equal(splat(0.0f), (across + down) + slack));
        }
        return may;
    }
};

/// A sample on the grids of sixteen parts.
struct PartPlaces {
    I32 x, y;
    F32 z, rounding;
    std::uint32_t looks;
};

OBSCURA_INLINE PartPlaces places(const ExactParts& parts, const ExactLight& middle, const double (&p)[3],
                                 float reach) {
    const auto row = [&](int r) {
        const double(&m)[4][16] = parts.to_map[r];
        return (load(m[0]) * splat(p[0]) + load(m[1]) * splat(p[1])) +
               (load(m[2]) * splat(p[2]) + load(m[3]));
    };
    const double steps = middle.view[0].steps;
    const auto on_grid = [&](int r) {
        return round_to_i32(min(max(row(r) * splat(256.0), splat(-1.0)), splat(steps + 1.0)));
    };
    PartPlaces to;
    to.x = on_grid(0);
    to.y = on_grid(1);
    const I32 zero = splat(std::int32_t{0}), last = splat(middle.view[0].steps);
    to.looks = bits(less_equal(zero, to.x) & less_equal(to.x, last) & less_equal(zero, to.y) &
                    less_equal(to.y, last));
    to.z = to_f32(row(2));
    to.rounding = splat(exact_depth_error * reach) + load(parts.step_m);
    return to;
}

/// Depths are floats in [0, 1], rounded twice on their way here (casters.cpp).
constexpr float depth_error = 0x1p-22f;

/// Whether part k sees the sample covered by the triangle, in integers.
bool is_covered(const PartVertex* const (&v)[3], int k, std::int32_t x, std::int32_t y) {
    const std::int64_t area = static_cast<std::int64_t>(v[1]->x[k] - v[0]->x[k]) * (v[2]->y[k] - v[0]->y[k]) -
                              static_cast<std::int64_t>(v[2]->x[k] - v[0]->x[k]) * (v[1]->y[k] - v[0]->y[k]);
    const std::int64_t turn = area < 0 ? -1 : 1;
    bool inside = true;
    for (int c = 0; c < 3; ++c) {
        const PartVertex &a = *v[c], &b = *v[c == 2 ? 0 : c + 1];
        const std::int64_t A = turn * (std::int64_t{a.y[k]} - b.y[k]),
                           B = turn * (std::int64_t{b.x[k]} - a.x[k]);
        const std::int64_t keeps_its_edge = (A > 0) | ((A == 0) & (B > 0));
        inside =
            inside && A * (x - std::int64_t{a.x[k]}) + B * (y - std::int64_t{a.y[k]}) + keeps_its_edge > 0;
    }
    return inside;
}

/// Parts of `of` that see the sample covered by the triangle.
OBSCURA_INLINE std::uint32_t covering(const PartVertex* const (&v)[3], const PartPlaces& s,
                                      std::uint32_t of) {
    // Terms to 2^59 in doubles: sums are right to 2^8, and so are their signs beyond it.
    const F64 unsure = splat(0x1p9);
    const F64 x = to_f64(s.x), y = to_f64(s.y);
    F64 vx[3], vy[3];
    for (int c = 0; c < 3; ++c) {
        vx[c] = to_f64(load(v[c]->x));
        vy[c] = to_f64(load(v[c]->y));
    }
    const F64 area = (vx[1] - vx[0]) * (vy[2] - vy[0]) - (vx[2] - vx[0]) * (vy[1] - vy[0]);
    const F64 zero = splat(0.0);
    std::uint32_t ahead = of, behind = of, near = ~bits(greater_equal(max(area, zero - area), unsure));
    for (int c = 0; c < 3; ++c) {
        const int next = c == 2 ? 0 : c + 1;
        const F64 e = (vy[c] - vy[next]) * (x - vx[c]) + (vx[next] - vx[c]) * (y - vy[c]);
        const std::uint32_t above = bits(greater_equal(e, unsure)),
                            below = bits(greater_equal(zero - e, unsure));
        near |= ~(above | below);
        ahead &= above;
        behind &= below;
        // Both sides of the outline are outside.
        if ((near & of) == 0 && (ahead | behind) == 0) return 0;
    }
    const std::uint32_t positive = bits(greater_equal(area, zero));
    std::uint32_t inside = ((ahead & positive) | (behind & ~positive)) & ~near;
    near &= of;
    if (near == 0) return inside;
    alignas(64) std::int32_t px[16], py[16];
    store(px, s.x);
    store(py, s.y);
    for (; near != 0; near &= near - 1) {
        const int k = __builtin_ctz(near);
        inside |= static_cast<std::uint32_t>(is_covered(v, k, px[k], py[k])) << k;
    }
    return inside;
}

/// One sample, as all parts of a light have it in common.
struct Asker {
    double world[3];
    float p[3], g[3];  ///< relative to the eye; its plane's normal
    float reach;       ///< times exact_depth_error: what is uncertain of its depth
    float wide;        ///< how far 1/256 pixel takes it at most
    std::uint32_t triangle;
    std::int32_t face;
};

OBSCURA_INLINE Asker asker(const ExactPoints& points, const ExactLight& middle, const Gathered& from, int k) {
    Asker a;
    const Bunch& s = from.bunch;
    const double world[3] = {s.px[k], s.py[k], s.pz[k]};
    for (int c = 0; c < 3; ++c) {
        a.world[c] = world[c];
        a.p[c] = static_cast<float>(world[c] - middle.eye[c]);
    }
    a.g[0] = from.gx[k];
    a.g[1] = from.gy[k];
    a.g[2] = from.gz[k];
    const float far = (__builtin_fabsf(a.p[0]) + __builtin_fabsf(a.p[1])) + __builtin_fabsf(a.p[2]);
    const float above = (a.g[0] * a.p[0] + a.g[1] * a.p[1]) + a.g[2] * a.p[2];
    a.reach = middle.viewer[3] != 0 ? __builtin_fabsf(above) : far;
    a.wide = (middle.snapping_m + middle.snapping_per_m * far) / exact_least_cosine;
    a.triangle = points.triangle[s.point[k]];
    a.face = s.face[k];
    return a;
}

/// Of the parts in `open` those that a caster, of the middle's, keeps from the sample.
OBSCURA_INLINE std::uint32_t darkened(const CasterTriangle& t, const ExactSoft& soft, const ExactParts& parts,
                                      const Asker& a, const PartPlaces& s, std::uint32_t open) {
    if (static_cast<std::int32_t>(t.face) == a.face) return 0;
    const double(&plane)[4] = soft.planes[t.face];
    const double height =
        (plane[0] * a.world[0] + plane[1] * a.world[1]) + (plane[2] * a.world[2] + plane[3]);
    // Turned to each part's light.
    const F64 facing = (splat(plane[0]) * load(parts.way[0]) + splat(plane[1]) * load(parts.way[1])) +
                       splat(plane[2]) * load(parts.way[2]);
    const F64 zero = splat(0.0), lowest = zero - to_f64(s.rounding);
    const std::uint32_t not_behind = bits(greater_equal(zero, facing)),
                        not_before = bits(greater_equal(facing, zero));
    const std::uint32_t before = ~not_behind, behind = ~not_before;
    std::uint32_t dark = open & ((before & ~bits(greater_equal(splat(height), lowest))) |
                                 (behind & ~bits(greater_equal(splat(-height), lowest))));
    if (dark == 0) return 0;
    const std::uint32_t* corner = soft.corners + 3 * static_cast<std::size_t>(t.triangle);
    const PartVertex* const v[3] = {parts.vertices + corner[0], parts.vertices + corner[1],
                                    parts.vertices + corner[2]};
    const F32 z_low = min(min(load(v[0]->z), load(v[1]->z)), load(v[2]->z)) - splat(depth_error);
    dark &= bits(less_equal(z_low, s.z));
    if (dark != 0) dark = covering(v, s, dark);
    if (dark == 0) return 0;
    // Those near the plane may seem behind it only for being snapped beside their place.
    const double(&viewer)[4] = soft.middle.viewer;
    const double seen =
        (plane[0] * viewer[0] + plane[1] * viewer[1]) + (plane[2] * viewer[2] + plane[3] * viewer[3]);
    std::uint32_t near = dark & (seen > 0 ? before : (seen < 0 ? behind : 0u));
    const double depth = height < 0 ? -height : height;
    if (near == 0 || depth > 1.001 * static_cast<double>(highest(s.rounding) + a.wide)) return dark;
    alignas(64) float rounding[16];
    store(rounding, s.rounding);
    if (is_on_triangle(soft.middle, a.triangle, a.world)) return dark;
    const double n[3] = {plane[0], plane[1], plane[2]};
    const float snap = exact_snap(soft.middle, a.p, a.g, n);
    for (; near != 0; near &= near - 1) {
        const int k = __builtin_ctz(near);
        if (depth <= static_cast<double>(rounding[k] + snap)) dark &= ~(1u << k);
    }
    return dark;
}

/// Takes from each sample's `lit` parts those that one of the candidates darkens, and forgets these. False
/// when nothing is lit any more.
bool darken_parts(const ExactPoints& points, const ExactSoft& soft, const Gathered& g, Candidates& near,
                  std::uint32_t (*lit)[most_soft_groups], ExactCounts& counts) {
    bool any = false;
    for (std::uint32_t samples = g.bunch.open; samples != 0; samples &= samples - 1) {
        const int k = __builtin_ctz(samples);
        std::uint32_t may[Candidates::room / 16], some = 0;
        for (int first = 0; first < near.count; first += 16) {
            may[first / 16] = g.is_far ? 0xffffu : near.before(first, soft, g.bunch, k);
            some |= may[first / 16];
        }
        if (some == 0) {
            any = true;
            continue;
        }
        const Asker a = asker(points, soft.middle, g, k);
        for (std::int32_t group = 0; group < soft.groups; ++group) {
            std::uint32_t& left = lit[k][group];
            if (left == 0) continue;
            const PartPlaces s = places(soft.parts[group], soft.middle, a.world, a.reach);
            std::uint32_t open = left & s.looks;
            left &= ~s.looks;
            counts.samples += __builtin_popcount(open);
            for (int first = 0; first < near.count && open != 0; first += 16) {
                std::uint32_t of = may[first / 16];
                for (; of != 0 && open != 0; of &= of - 1) {
                    const int i = first + __builtin_ctz(of);
                    if (i >= near.count) break;
                    ++counts.triangles;
                    open &= ~darkened(soft.middle.view[0].triangles[near.place[i]], soft, soft.parts[group],
                                      a, s, open);
                }
            }
            left |= open;
            any = any || left != 0;
        }
    }
    near.count = 0;
    return any;
}

/// Whether any part of the light would look one of the samples up.
bool looks_anywhere(const ExactSoft& soft, const Gathered& g) {
    for (std::uint32_t samples = g.bunch.open; samples != 0; samples &= samples - 1) {
        const int k = __builtin_ctz(samples);
        const double p[3] = {g.bunch.px[k], g.bunch.py[k], g.bunch.pz[k]};
        for (std::int32_t group = 0; group < soft.groups; ++group) {
            if (places(soft.parts[group], soft.middle, p, 0.0f).looks != 0) return true;
        }
    }
    return false;
}

}  // namespace

void exact_see(const float* xyz, std::size_t begin, std::size_t end, const ExactParts& parts,
               PartVertex* out) noexcept {
    const F64 low = splat(-1.0 * exact_view_texels), high = splat(2.0 * exact_view_texels),
              steps = splat(256.0);
    for (std::size_t i = begin; i < end; ++i) {
        const F64 x = splat(static_cast<double>(xyz[3 * i])), y = splat(static_cast<double>(xyz[3 * i + 1])),
                  z = splat(static_cast<double>(xyz[3 * i + 2]));
        const auto row = [&](int r) {
            const double(&m)[4][16] = parts.to_map[r];
            return (load(m[0]) * x + load(m[1]) * y) + (load(m[2]) * z + load(m[3]));
        };
        store(out[i].x, round_to_i32(min(max(row(0), low), high) * steps));
        store(out[i].y, round_to_i32(min(max(row(1), low), high) * steps));
        store(out[i].z, max(min(to_f32(row(2)), splat(1.0f)), splat(0.0f)));
    }
}

void exact_soft(const ExactPoints& points, const ExactSoft& light, const ExactSamples& samples,
                const std::uint32_t* order, std::uint32_t* lit, std::int32_t stride,
                ExactCounts& counts) noexcept {
    const ExactView& view = light.middle.view[0];
    std::uint32_t parts_lit[16][most_soft_groups];
    Gathered g;
    Candidates near;
    for (std::int32_t next = 0; next < samples.count; next += lanes) {
        gather(points, light.middle, samples, order + next, least(lanes, samples.count - next), g);
        for (std::uint32_t left = g.bunch.open; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            const Vec3x16 n = splat3(g.gx[k], g.gy[k], g.gz[k]);
            for (std::int32_t group = 0; group < light.groups; ++group) {
                const ExactParts& parts = light.parts[group];
                const F32 facing = dot(n, load3(parts.to_light[0], parts.to_light[1], parts.to_light[2]));
                const std::uint32_t there = parts.count >= 16 ? 0xffffu : (1u << parts.count) - 1u;
                const bool thin = (g.thin >> k & 1u) != 0;
                parts_lit[k][group] = there & (thin ? 0xffffu : bits(less(splat(0.0f), facing)));
            }
        }
        // A few at first, which may darken all of it.
        near.count = 0;
        int enough = 16;
        const auto collect = [&](std::uint32_t i, float z_low) {
            near.add(view.triangles[i], z_low, i, light);
            if (near.count < enough) return true;
            enough = least(4 * enough, Candidates::room);
            return darken_parts(points, light, g, near, parts_lit, counts);
        };
        if (g.is_far) {
            // Anything may be before it, as some part sees it.
            const std::int64_t all = looks_anywhere(light, g) ? view.count : 0;
            for (std::int64_t i = 0; i < all && collect(static_cast<std::uint32_t>(i), 0.0f);)
                ++i;
        } else if (view.levels > 0) {
            walk_reach(view, g.bunch.extent, light.spread, 0, counts.groups,
                       [&](std::uint32_t i, float z_low) {
                           ++counts.triangles;
                           return !may_darken(view.triangles[i], z_low, light, g.bunch) || collect(i, z_low);
                       });
        }
        if (near.count > 0) darken_parts(points, light, g, near, parts_lit, counts);
        for (std::uint32_t left = g.bunch.open; left != 0; left &= left - 1) {
            const int k = __builtin_ctz(left);
            const std::int32_t at = g.bunch.point[k];
            std::uint32_t* word = lit + at / 16;
            for (std::int32_t group = 0; group < light.groups; ++group) {
                for (int part = 0; part < light.parts[group].count; ++part, word += stride) {
                    *word &= ~(1u << (at % 16));
                    *word |= (parts_lit[k][group] >> part & 1u) << (at % 16);
                }
            }
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
