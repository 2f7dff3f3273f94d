// Percentage-closer filtering of dense maps, sixteen receivers of a row at a time. See pcf_ref.cpp for the
// meaning of each step.

#include "filters/pcf_lanes.h"
#include "filters/tree_pcf.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Mean over the kernel.
template <int side, bool inside_map>
OBSCURA_INLINE F32 filtered(const PcfView& view, bool clamp, const Receivers16& r, const I32& ix,
                            const I32& iy, const F32& fx, const F32& fy) {
    constexpr std::int32_t reach = side / 2;
    [[maybe_unused]] const std::int32_t last = view.size - 1;
    // Place of a texel in its blocks of 4 x 4: a part for its column, a part for its row.
    I32 column[side], row_start[side];
    Mask column_inside[side], row_inside[side];
    for (std::int32_t k = 0; k < side; ++k) {
        I32 x = ix + splat(k - reach), y = iy + splat(k - reach);
        if constexpr (!inside_map) {
            column_inside[k] = between(x, 0, last);
            row_inside[k] = between(y, 0, last);
            x = clamped(x, 0, last);
            y = clamped(y, 0, last);
        }
        column[k] = shift_left<4>(shift_right<2>(x)) + (x & splat(std::int32_t{3}));
        row_start[k] = shift_right<2>(y) * splat(view.size * 4) + shift_left<2>(y & splat(std::int32_t{3}));
    }
    // The receiver's plane at the texels' centres.
    const F32 to_centre_x = to_f32((to_f64(ix) + splat(0.5)) - r.X);
    const F32 to_centre_y = to_f32((to_f64(iy) + splat(0.5)) - r.Y);
    F32 rise_x[side];
    for (std::int32_t k = 0; k < side; ++k)
        rise_x[k] = r.slope_x * (to_centre_x + splat(static_cast<float>(k - reach)));
    F32 sum = splat(0.0f);
    for (std::int32_t j = 0; j < side; ++j) {
        const F32 rise_y = r.slope_y * (to_centre_y + splat(static_cast<float>(j - reach)));
        F32 row = splat(0.0f);
        for (std::int32_t i = 0; i < side; ++i) {
            const F32 depth = tap_depth(r.depth, rise_x[i] + rise_y);
            Mask lit = less_equal(depth, gather(view.stored, column[i] + row_start[j]));
            if constexpr (!inside_map) {
                if (!clamp) lit = lit | ~(column_inside[i] & row_inside[j]);
            }
            row = row + select(lit, tap_weight(i, side, fx), splat(0.0f));
        }
        sum = sum + row * tap_weight(j, side, fy);
    }
    return sum * splat(side == 1 ? 1.0f : (side == 3 ? 0.25f : 0.0625f));
}

template <int side>
OBSCURA_INLINE F32 filtered_side(const PcfView& view, bool clamp, const Receivers16& r, const Mask& active) {
    const I32 x256 = round_to_i32(r.X * splat(256.0)), y256 = round_to_i32(r.Y * splat(256.0));
    I32 ix = shift_right<8>(x256), iy = shift_right<8>(y256);
    const F32 fx = to_f32(x256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    const F32 fy = to_f32(y256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    const std::int32_t low = side / 2, high = view.size - 1 - side / 2;
    const Mask interior = between(ix, low, high) & between(iy, low, high);
    if (high >= low && all(interior | ~active)) {
        // Lanes that nobody asked about must not read beyond the map.
        ix = clamped(ix, low, high);
        iy = clamped(iy, low, high);
        return filtered<side, true>(view, clamp, r, ix, iy, fx, fy);
    }
    return filtered<side, false>(view, clamp, r, ix, iy, fx, fy);
}

F32 lookup(const PcfLight& light, const PcfView& view, const Receivers16& r, const Mask& active) {
    const bool clamp = !light.directional;
    if (light.side == 1) return filtered_side<1>(view, clamp, r, active);
    if (light.side == 3) return filtered_side<3>(view, clamp, r, active);
    return filtered_side<5>(view, clamp, r, active);
}

}  // namespace

void pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    if (light.view[0].tree != nullptr) {
        tree_pcf_block(surface, light, visibility);
        return;
    }
    for (int at = 0; at < block_samples; at += lanes) {
        store(visibility + at,
              group_visibility(surface, light, at,
                               [&](std::int32_t view, const Receivers16& r, const Mask& active) {
                                   return lookup(light, light.view[view], r, active);
                               }));
    }
}

}  // namespace obscura::OBSCURA_ISA
