// What kernels read, sixteen receivers of a row at a time. See kernel_box_ref.cpp for the meaning of each
// step.

#include "filters/kernel_box.h"

#include "filters/pcf_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Run16 {
    I32 first, last;
};

/// X in squares.
OBSCURA_INLINE Run16 run_of(const F64& X, int side, const I32& last_square, bool directional) {
    const I32 first = shift_right<8>(round_to_i32(X * splat(256.0))) - splat(std::int32_t{side / 2});
    const I32 last = first + splat(std::int32_t{side - 1}), zero = splat(std::int32_t{0});
    if (!directional) return {min(max(first, zero), last_square), min(max(last, zero), last_square)};
    return {max(first, zero), min(last, last_square)};
}

/// Keeps what other views have written.
OBSCURA_INLINE void store_lanes(const Mask& active, const I32& values, std::int32_t* to) {
    store(to, select(active, values, load(to)));
}

OBSCURA_INLINE void set_boxes(const PcfView& view, const PcfLight& light, const Receivers16& r,
                              const I32& level, const Mask& active, int at, BoxesOnLevel& boxes) {
    // 2^-level by its exponent.
    const F64 scale = to_f64(bitcast_f32(shift_left<23>(splat(std::int32_t{127}) - level)));
    const I32 last = shift_right_logical(splat(view.size), level) - splat(std::int32_t{1});
    const Run16 x = run_of(r.X * scale, light.side, last, light.directional),
                y = run_of(r.Y * scale, light.side, last, light.directional);
    boxes.reading[at / 16] |= bits(active & less_equal(x.first, x.last) & less_equal(y.first, y.last));
    store_lanes(active, level, boxes.level + at);
    store_lanes(active, x.first, boxes.x0 + at);
    store_lanes(active, x.last, boxes.x1 + at);
    store_lanes(active, y.first, boxes.y0 + at);
    store_lanes(active, y.last, boxes.y1 + at);
}

}  // namespace

void kernel_boxes(const SurfaceBlock& surface, const PcfLight& light, KernelBoxes& boxes) noexcept {
    for (int at = 0; at < block_samples; at += lanes) {
        boxes.kernel[0].reading[at / 16] = boxes.kernel[1].reading[at / 16] = 0;
        visit_receivers(surface, light, at, [&](std::int32_t v, const Receivers16& r, const Mask& active) {
            const PcfView& view = light.view[v];
            const Mask on_map = active & ~r.before_near;
            if (none(on_map)) return;
            store_lanes(on_map, splat(v), boxes.view + at);
            if (light.filter == PcfFilter::pcf) {
                set_boxes(view, light, r, splat(std::int32_t{0}), on_map, at, boxes.kernel[0]);
                return;
            }
            const Levels16 levels = levels_of(r);
            set_boxes(view, light, r, levels.fine, on_map, at, boxes.kernel[0]);
            const Mask blended = on_map & less(splat(0.0f), levels.blend);
            if (none(blended)) return;
            set_boxes(view, light, r, levels.fine + splat(std::int32_t{1}), blended, at, boxes.kernel[1]);
        });
    }
}

}  // namespace obscura::OBSCURA_ISA
