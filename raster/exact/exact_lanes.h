#pragma once
// Sixteen samples against the casters of a view. Kernel files only; the meaning of each step is in
// exact_ref.cpp.
//
// Samples come in an order in which neighbours lie close together on the light's grid. Boxes are asked for
// sixteen of their children at once: first for sixteen bunches of samples together, then for each bunch among
// what is left. Triangles are asked for the sixteen samples of a bunch.

#include "core/simd_vec.h"
#include "raster/exact/exact.h"

namespace obscura::OBSCURA_ISA {
namespace {

constexpr int bunches = 16;

OBSCURA_INLINE std::int32_t least(std::int32_t a, std::int32_t b) {
    return a < b ? a : b;
}
OBSCURA_INLINE std::int32_t most(std::int32_t a, std::int32_t b) {
    return a > b ? a : b;
}
OBSCURA_INLINE float least(float a, float b) {
    return a < b ? a : b;
}
OBSCURA_INLINE float most(float a, float b) {
    return a > b ? a : b;
}

/// What samples of one view lie in, on its grid, and the deepest of them.
struct Extent {
    std::int32_t x_low, x_high, y_low, y_high;
    float z_high;
};

/// Sixteen samples of one view, or fewer: lanes that are not open repeat one that is.
struct Bunch {
    alignas(64) std::int32_t x[16], y[16], face[16];
    alignas(64) float z[16];
    alignas(64) double px[16], py[16], pz[16];  ///< world space
    alignas(64) double lowest[16];              ///< height above a plane below which it is behind it
    Extent extent;
    float z_low;
    float middle[3], half[3];  ///< of what the samples span, metres, relative to the eye
    float rounding;            ///< the least that is uncertain of one
    double near;               ///< height above a plane below which no snapping takes any of them
    std::int32_t point[16];
    std::uint32_t open;  ///< lanes that nothing has darkened yet
    bool one_face;       ///< all lanes have the first one's
};

/// What follows from the samples of a bunch, all of whose lanes are filled; `open`: those that are some.
OBSCURA_INLINE void finish_bunch(const ExactLight& light, const F32& rounding, std::uint32_t open,
                                 Bunch& to) {
    store(to.lowest, splat(0.0) - to_f64(rounding));
    const I32 x = load(to.x), y = load(to.y), face = load(to.face);
    const F32 z = load(to.z);
    to.extent = {lowest(x), highest(x), lowest(y), highest(y), highest(z)};
    to.z_low = lowest(z);
    to.rounding = lowest(rounding);
    float reach = 0;
    const double* const axis[3] = {to.px, to.py, to.pz};
    for (int k = 0; k < 3; ++k) {
        const F32 p = to_f32(load(axis[k]) - splat(light.eye[k]));
        const float low = lowest(p), high = highest(p);
        to.middle[k] = 0.5f * (low + high);
        // Half, and as much again as its rounding may be.
        to.half[k] = 0.5f * (high - low) + 0x1p-22f * most(high, -low);
        reach += most(high, -low);
    }
    to.near =
        -1.001 * static_cast<double>(highest(rounding) +
                                     (light.snapping_m + light.snapping_per_m * reach) / exact_least_cosine);
    to.open = open;
    to.one_face = all(equal(face, splat(to.face[0])));
}

/// Which of sixteen boxes may hold what darkens something in `e`.
OBSCURA_INLINE std::uint32_t overlapping(const CasterBoxes& boxes, const Extent& e) {
    return bits(
        less_equal(load(boxes.x_low), splat(e.x_high)) & less_equal(splat(e.x_low), load(boxes.x_high)) &
        less_equal(load(boxes.y_low), splat(e.y_high)) & less_equal(splat(e.y_low), load(boxes.y_high)) &
        less_equal(load(boxes.z_low), splat(e.z_high)));
}

/// Calls visit(group of boxes, child) for every triangle whose box overlaps e, until it returns false.
template <class Visit>
OBSCURA_INLINE void walk(const ExactView& view, const Extent& e, std::int64_t& groups, Visit&& visit) {
    struct Entry {
        std::int32_t level;
        std::uint32_t group;
    };
    Entry stack[16 * most_caster_levels];
    int top = 0;
    stack[top++] = {view.levels - 1, 0};
    while (top > 0) {
        const Entry at = stack[--top];
        ++groups;
        const CasterBoxes& boxes = view.boxes[at.level][at.group];
        std::uint32_t inside = overlapping(boxes, e);
        if (at.level == 0) {
            for (; inside != 0; inside &= inside - 1) {
                if (!visit(boxes, 16 * at.group, __builtin_ctz(inside))) return;
            }
            continue;
        }
        // Last first, so that the first is on top.
        while (inside != 0) {
            const int k = 31 - __builtin_clz(inside);
            inside &= ~(1u << k);
            stack[top++] = {at.level - 1, 16 * at.group + static_cast<std::uint32_t>(k)};
        }
    }
}

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

/// Triangles near many bunches, sixteen by sixteen as boxes are: what tells quickly that one darkens none of
/// a bunch.
struct Nearby {
    static constexpr int room = 256;
    CasterBoxes boxes[room / 16], around;  ///< around: of each sixteen boxes
    alignas(64) std::int32_t x[3][room], y[3][room];
    alignas(64) float n[3][room], d[room];  ///< the plane, relative to the eye
    std::uint32_t triangle[room];
    int count = 0;

    OBSCURA_INLINE void add(const CasterTriangle& t, const ExactLight& light, const CasterBoxes& from,
                            std::uint32_t index, int k) {
        CasterBoxes& to = boxes[count / 16];
        const int i = count % 16;
        to.x_low[i] = from.x_low[k];
        to.x_high[i] = from.x_high[k];
        to.y_low[i] = from.y_low[k];
        to.y_high[i] = from.y_high[k];
        to.z_low[i] = from.z_low[k];
        const int g = count / 16;
        around.x_low[g] = i == 0 ? to.x_low[i] : least(around.x_low[g], to.x_low[i]);
        around.x_high[g] = i == 0 ? to.x_high[i] : most(around.x_high[g], to.x_high[i]);
        around.y_low[g] = i == 0 ? to.y_low[i] : least(around.y_low[g], to.y_low[i]);
        around.y_high[g] = i == 0 ? to.y_high[i] : most(around.y_high[g], to.y_high[i]);
        around.z_low[g] = i == 0 ? to.z_low[i] : least(around.z_low[g], to.z_low[i]);
        for (int c = 0; c < 3; ++c) {
            x[c][count] = t.x[c];
            y[c][count] = t.y[c];
            n[c][count] = static_cast<float>(t.n[c]);
        }
        d[count] = static_cast<float>((t.n[0] * light.eye[0] + t.n[1] * light.eye[1]) +
                                      (t.n[2] * light.eye[2] + t.d));
        triangle[count++] = index;
    }
    /// Places after the last hold nothing.
    OBSCURA_INLINE void close() {
        for (int i = count; i % 16 != 0; ++i) {
            boxes[i / 16].x_low[i % 16] = 0x7fffffff;
            boxes[i / 16].x_high[i % 16] = -0x7fffffff;
        }
        for (int g = (count + 15) / 16; g < 16; ++g) {
            around.x_low[g] = 0x7fffffff;
            around.x_high[g] = -0x7fffffff;
        }
    }

    /// Of triangles first .. first + 15 those that may darken something in the bunch. Floats, so generous by
    /// their rounding.
    OBSCURA_INLINE std::uint32_t may_darken(int first, const Bunch& s) const {
        std::uint32_t may = overlapping(boxes[first / 16], s.extent);
        if (may == 0) return 0;
        // Nothing is behind the plane: its height above it is at least that of the middle less the reach.
        const F32 n0 = load(n[0] + first), n1 = load(n[1] + first), n2 = load(n[2] + first);
        const F32 offset = load(d + first);
        const F32 height =
            (n0 * splat(s.middle[0]) + n1 * splat(s.middle[1])) + (n2 * splat(s.middle[2]) + offset);
        const F32 reach =
            (abs(n0) * splat(s.half[0]) + abs(n1) * splat(s.half[1])) + abs(n2) * splat(s.half[2]);
        const float size = (abs_of(s.middle[0]) + abs_of(s.middle[1])) + abs_of(s.middle[2]);
        const F32 rounding = splat(0x1p-20f) * (splat(size) + abs(offset));
        may &= bits(less(height - reach - rounding, splat(-0.99f * s.rounding)));
        if (may == 0) return 0;
        // All of the bunch is outside of an edge.
        const std::int32_t half_x = s.extent.x_high / 2 - s.extent.x_low / 2 + 1,
                           half_y = s.extent.y_high / 2 - s.extent.y_low / 2 + 1;
        const I32 mx = splat(s.extent.x_low + half_x), my = splat(s.extent.y_low + half_y);
        const F32 hx = splat(static_cast<float>(half_x + 1)), hy = splat(static_cast<float>(half_y + 1));
        for (int k = 0; k < 3 && may != 0; ++k) {
            const int next = k == 2 ? 0 : k + 1;
            const I32 xk = load(x[k] + first), yk = load(y[k] + first);
            const F32 A = to_f32(yk - load(y[next] + first)), B = to_f32(load(x[next] + first) - xk);
            const F32 across = A * to_f32(mx - xk), down = B * to_f32(my - yk);
            const F32 slack = (abs(A) * hx + abs(B) * hy) + splat(0x1p-20f) * (abs(across) + abs(down));
            may &= bits(less_equal(splat(0.0f), (across + down) + slack));
        }
        return may;
    }
    static OBSCURA_INLINE float abs_of(float v) { return v < 0 ? -v : v; }
};

OBSCURA_INLINE Extent united(const Extent& a, const Extent& b) {
    return {least(a.x_low, b.x_low), most(a.x_high, b.x_high), least(a.y_low, b.y_low),
            most(a.y_high, b.y_high), most(a.z_high, b.z_high)};
}

/// Collects what is near the bunches; false when there is no room for all of it.
bool collect(const ExactLight& light, const ExactView& view, const Bunch* bunch, int n, Nearby& nearby,
             ExactCounts& counts) {
    Extent all = bunch[0].extent;
    for (int b = 1; b < n; ++b)
        all = united(all, bunch[b].extent);
    nearby.count = 0;
    bool fits = true;
    walk(view, all, counts.groups, [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
        fits = nearby.count < Nearby::room;
        if (fits) {
            const std::uint32_t index = first + static_cast<std::uint32_t>(k);
            nearby.add(view.triangles[index], light, boxes, index, k);
        }
        return fits;
    });
    nearby.close();
    return fits;
}

/// Triangles near one bunch beyond which its samples had better be taken in an order of their own.
constexpr int most_near = 48;

/// Darkens the open lanes of one bunch by what is near; false, and nothing done, when that is more than
/// `most`.
OBSCURA_INLINE bool darken_near(const ExactPoints& points, const ExactLight& light, const ExactView& view,
                                const Nearby& nearby, int most_triangles, Bunch& s, ExactCounts& counts) {
    std::uint32_t may[Nearby::room / 16];
    const std::uint32_t near = overlapping(nearby.around, s.extent);
    ++counts.groups;
    int sum = 0;
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
        const int g = __builtin_ctz(left);
        ++counts.groups;
        may[g] = nearby.may_darken(16 * g, s);
        sum += __builtin_popcount(may[g]);
    }
    if (sum > most_triangles) return false;
    for (std::uint32_t left = near; left != 0; left &= left - 1) {
        const int g = __builtin_ctz(left);
        for (; may[g] != 0; may[g] &= may[g] - 1) {
            const int k = __builtin_ctz(may[g]);
            ++counts.triangles;
            s.open &= ~darkened(view.triangles[nearby.triangle[16 * g + k]], nearby.boxes[g].z_low[k], points,
                                light, s);
            if (s.open == 0) return true;
        }
    }
    return true;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
