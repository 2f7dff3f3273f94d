#pragma once
// What is near many bunches of samples. Kernel files only; the meaning of each step is in exact_ref.cpp.

#include "raster/exact/exact_triangle.h"

namespace obscura::OBSCURA_ISA {
namespace {

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
        to.z_high[i] = from.z_high[k];
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

/// Collects what is near the bunches; false, and nothing collected, when there is no room for all of it.
OBSCURA_INLINE bool collect(const ExactLight& light, const ExactView& view, const Bunch* bunch, int n,
                            Nearby& nearby, ExactCounts& counts) {
    Extent all = bunch[0].extent;
    for (int b = 1; b < n; ++b)
        all = united(all, bunch[b].extent);
    // Indices alone at first: where leaves are, most walks end without room.
    int found = 0;
    walk(view, all, counts.groups, [&](const CasterBoxes&, std::uint32_t first, int k) {
        if (found < Nearby::room) nearby.triangle[found] = first + static_cast<std::uint32_t>(k);
        return ++found <= Nearby::room;
    });
    nearby.count = 0;
    if (found > Nearby::room) return false;
    while (nearby.count < found) {
        const std::uint32_t index = nearby.triangle[nearby.count];
        nearby.add(view.triangles[index], light, view.boxes[0][index / 16], index,
                   static_cast<int>(index % 16));
    }
    nearby.close();
    return true;
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
