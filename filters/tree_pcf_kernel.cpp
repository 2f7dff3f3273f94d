// Percentage-closer filtering of trees, sixteen receivers of a row at a time. See tree_taps.h for the
// meaning; what is shared goes further here. All kernels of the group go down together to their lowest common
// node. From there the squares at the four corners of each lane's kernel do, until they are so small that the
// kernel just fits into the two by two of them; then each level splits them into those that it touches, so
// that no square is visited by two taps.

#include "filters/tree_pcf.h"

#include "filters/pcf_lanes.h"
#include "hierarchy/codes/tree_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

constexpr int max_side = max_tree_pcf_side;

/// Kernels on the map of squares of 2^level texels: see ref::Kernel.
struct Kernel16 {
    int side, level;
    I32 x0, y0;
    F32 fx, fy, depth, bias;
    F32 rise_x[max_side], rise_y[max_side];
};

template <int fixed>
OBSCURA_INLINE void set_kernel(const Receivers16& r, int side, int level, Kernel16& k) {
    k.side = side;
    k.level = level;
    k.depth = r.depth;
    const F64 scale = splat(1.0 / static_cast<double>(1 << level));
    const auto square = static_cast<float>(1 << level);
    const F64 X = r.X * scale, Y = r.Y * scale;
    const I32 x256 = round_to_i32(X * splat(256.0)), y256 = round_to_i32(Y * splat(256.0));
    const I32 ix = shift_right<8>(x256), iy = shift_right<8>(y256);
    const std::int32_t reach = side / 2;
    k.x0 = ix - splat(reach);
    k.y0 = iy - splat(reach);
    k.fx = to_f32(x256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    k.fy = to_f32(y256 & splat(std::int32_t{255})) * splat(1.0f / 256.0f);
    const F32 slope_x = r.slope_x * splat(square), slope_y = r.slope_y * splat(square);
    const F32 to_centre_x = to_f32((to_f64(ix) + splat(0.5)) - X);
    const F32 to_centre_y = to_f32((to_f64(iy) + splat(0.5)) - Y);
    k.bias = (abs(slope_x) + abs(slope_y)) * splat(0.5f - 0.5f / square);
    for (int i = 0; i < (fixed != 0 ? fixed : side); ++i) {
        const F32 from = splat(static_cast<float>(i - reach));
        k.rise_x[i] = slope_x * (to_centre_x + from);
        k.rise_y[i] = slope_y * (to_centre_y + from);
    }
}

OBSCURA_INLINE F32 depth_over(const Kernel16& k, const F32& rise) {
    return tap_depth(k.depth, rise - k.bias);
}

/// Weighted mean of lit(i, j, depth of the receiver's plane) over the taps.
template <int fixed, class Lit>
OBSCURA_INLINE F32 mean(const Kernel16& k, Lit&& lit) {
    const int side = fixed != 0 ? fixed : k.side;
    F32 sum = splat(0.0f);
    for (int j = 0; j < side; ++j) {
        F32 row = splat(0.0f);
        for (int i = 0; i < side; ++i) {
            const F32 depth = depth_over(k, k.rise_x[i] + k.rise_y[j]);
            row = row + select(lit(i, j, depth), tap_weight(i, side, k.fx), splat(0.0f));
        }
        sum = sum + row * tap_weight(j, side, k.fy);
    }
    return side == 1 ? sum : sum / splat(static_cast<float>((side - 1) * (side - 1)));
}

// --- naive -------------------------------------------------------------------------------------------------

/// Every tap of every lane from the root; also for kernels that reach over the map's border.
template <class Code>
F32 naive_mean(const TreeCode& tree, bool clamp, const Kernel16& k, const Mask& active) {
    const std::uint8_t* base = biased_units<Code>(tree);
    const std::int32_t last = (1 << (tree.levels - k.level)) - 1;
    return mean<0>(k, [&](int i, int j, const F32& depth) {
        const I32 x = k.x0 + splat(i), y = k.y0 + splat(j);
        const Mask inside = between(x, 0, last) & between(y, 0, last);
        const Mask asked = clamp ? active : active & inside;
        Descents16<Code> d = descents_from<Code>(Code::root(tree), asked);
        const I32 at_x = shift_left(clamped(x, 0, last), k.level),
                  at_y = shift_left(clamped(y, 0, last), k.level);
        descend_to<Code>(tree, base, tree.levels, k.level, at_x, at_y, d);
        const Mask lit = less_equal(depth, values_of<Code>(tree, base, d, at_x, at_y, k.level));
        return clamp ? lit : lit | ~inside;
    });
}

// --- shared ------------------------------------------------------------------------------------------------

OBSCURA_INLINE Mask odd(const I32& a) {
    return any_bit(a, splat(std::int32_t{1}));
}

/// Smallest s for which kernels of that side touch no more than two squares of 2^s a row.
constexpr int fitting_height(int side) {
    int s = 0;
    while (1 << s < side - 1)
        ++s;
    return s;
}
/// Squares of 2^height a row that a kernel may touch, below the fitting height.
constexpr int touched(int side, int height) {
    return ((side - 1 + (1 << height) - 1) >> height) + 1;
}

/// Full light and none where the least and the greatest stored depth decide for all taps; nothing if some
/// active lane stays open.
template <int fixed>
OBSCURA_INLINE bool decided(const Kernel16& k, const F32& least_stored, const F32& greatest_stored,
                            const Mask& active, F32& visibility) {
    // Rises are monotone, so the taps' extreme depths are at corners.
    const int end = (fixed != 0 ? fixed : k.side) - 1;
    const F32 highest = max(k.rise_x[0], k.rise_x[end]) + max(k.rise_y[0], k.rise_y[end]);
    const F32 lowest = min(k.rise_x[0], k.rise_x[end]) + min(k.rise_y[0], k.rise_y[end]);
    const Mask all_lit = less_equal(depth_over(k, highest), least_stored);
    const Mask none_lit = less(greatest_stored, depth_over(k, lowest));
    visibility = select(all_lit, splat(1.0f), splat(0.0f));
    return all(all_lit | none_lit | ~active);
}

/// The squares at the corners of all lanes' kernels, from one node of height `height` down to where kernels
/// just fit. False when every lane's descents ended before.
template <class Code>
OBSCURA_INLINE bool descend_corners(const TreeCode& tree, const std::uint8_t* base, const Kernel16& k,
                                    int side, int height, int stop, Descents16<Code> (&corner)[2][2]) {
    const I32 x[2] = {k.x0, k.x0 + splat(side - 1)}, y[2] = {k.y0, k.y0 + splat(side - 1)};
    // Above these heights the corners of every lane are in one column, in one row.
    const int split_x = common_height(united_bits(x[0] ^ x[1]));
    const int split_y = common_height(united_bits(y[0] ^ y[1]));
    int columns = 1, rows = 1;
    bool going_on = true;
    for (; going_on && height > stop; --height) {
        if (columns == 1 && height - 1 - k.level < split_x) {
            columns = 2;
            for (int j = 0; j < rows; ++j)
                corner[j][1] = corner[j][0];
        }
        if (rows == 1 && height - 1 - k.level < split_y) {
            rows = 2;
            for (int i = 0; i < columns; ++i)
                corner[1][i] = corner[0][i];
        }
        going_on = false;
        for (int j = 0; j < rows; ++j) {
            for (int i = 0; i < columns; ++i) {
                if (none(corner[j][i].inner)) continue;
                descend(Code{}, tree, base, height, child_bit(height - k.level, x[i], y[j]), corner[j][i]);
                going_on = going_on || any(corner[j][i].inner);
            }
        }
    }
    if (columns == 1) {
        for (int j = 0; j < rows; ++j)
            corner[j][1] = corner[j][0];
    }
    if (rows == 1) {
        corner[1][0] = corner[0][0];
        corner[1][1] = corner[0][1];
    }
    return going_on;
}

/// One level: from `from`, squares of 2^(height + 1) counted from the kernels' first, to those of 2^height.
/// Child c stands in parent c / 2, or in the next where the first child is the second of its parent.
template <class Code, int n>
OBSCURA_INLINE void split_squares(const TreeCode& tree, const std::uint8_t* base, const Kernel16& k,
                                  int height, int count, const Descents16<Code> (&from)[n][n],
                                  Descents16<Code> (&to)[n][n]) {
    const I32 x = shift_right(k.x0, height), y = shift_right(k.y0, height);
    const Mask odd_x = odd(x), odd_y = odd(y);
    for (int j = 0; j < count; ++j) {
        Descents16<Code> row[n];
        for (int i = 0; i < (count + 2) / 2; ++i) {
            row[i] = j % 2 == 0 ? from[j / 2][i] : select(odd_y, from[j / 2 + 1][i], from[j / 2][i]);
        }
        const I32 bit_y = shift_left<2>((y + splat(j)) & splat(std::int32_t{1}));
        for (int i = 0; i < count; ++i) {
            Descents16<Code> d = i % 2 == 0 ? row[i / 2] : select(odd_x, row[i / 2 + 1], row[i / 2]);
            if (any(d.inner)) {
                const I32 bit_x = shift_left<1>((x + splat(i)) & splat(std::int32_t{1}));
                descend(Code{}, tree, base, k.level + height + 1, bit_x | bit_y, d);
            }
            to[j][i] = d;
        }
    }
}

/// What tap (i, j) of each lane finds where its descent stands.
template <class Code>
OBSCURA_INLINE F32 value_of_tap(const TreeCode& tree, const std::uint8_t* base, const Kernel16& k,
                                const Descents16<Code>& d, int i, int j) {
    return values_of<Code>(tree, base, d, shift_left(k.x0 + splat(i), k.level),
                           shift_left(k.y0 + splat(j), k.level), k.level);
}

/// Taps of kernels whose four corner squares are all that is to be known.
template <class Code, int fixed>
OBSCURA_INLINE F32 mean_of_corners(const TreeCode& tree, const std::uint8_t* base, const Kernel16& k, int fit,
                                   const Descents16<Code> (&corner)[2][2], const Mask& active) {
    const I32 first_x = shift_right(k.x0, fit), first_y = shift_right(k.y0, fit);
    const auto left = [&](int i) { return equal(shift_right(k.x0 + splat(i), fit), first_x); };
    const auto upper = [&](int j) { return equal(shift_right(k.y0 + splat(j), fit), first_y); };
    if constexpr (Code::varies) {
        return mean<fixed>(k, [&](int i, int j, const F32& depth) {
            const Mask l = left(i);
            const Descents16<Code> d = select(upper(j), select(l, corner[0][0], corner[0][1]),
                                              select(l, corner[1][0], corner[1][1]));
            return less_equal(depth, value_of_tap<Code>(tree, base, k, d, i, j));
        });
    } else {
        F32 value[2][2];
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i)
                value[j][i] = values(Code{}, tree, base, corner[j][i]);
        }
        const F32 least = min(min(value[0][0], value[0][1]), min(value[1][0], value[1][1]));
        const F32 greatest = max(max(value[0][0], value[0][1]), max(value[1][0], value[1][1]));
        F32 visibility;
        if (decided<fixed>(k, least, greatest, active, visibility)) return visibility;
        return mean<fixed>(k, [&](int i, int j, const F32& depth) {
            const Mask l = left(i);
            return less_equal(depth, select(upper(j), select(l, value[0][0], value[0][1]),
                                            select(l, value[1][0], value[1][1])));
        });
    }
}

/// Taps of kernels whose descents all end in one place.
template <class Code, int fixed>
OBSCURA_INLINE F32 mean_of_place(const TreeCode& tree, const Kernel16& k, const TreePlace& place,
                                 const Mask& active) {
    if constexpr (Code::varies) {
        const std::uint8_t* base = biased_units<Code>(tree);
        const Descents16<Code> d = descents_from<Code>(place, active);
        return mean<fixed>(k, [&](int i, int j, const F32& depth) {
            return less_equal(depth, value_of_tap<Code>(tree, base, k, d, i, j));
        });
    } else {
        const F32 stored = splat(Code::depth(tree, place));
        F32 visibility;
        if (decided<fixed>(k, stored, stored, active, visibility)) return visibility;
        return mean<fixed>(k, [&](int, int, const F32& depth) { return less_equal(depth, stored); });
    }
}

/// fixed: the kernel's side, or 0: k.side.
template <class Code, int fixed>
F32 shared_mean(const TreeCode& tree, bool clamp, Kernel16& k, const Mask& active, TreePath& path) {
    const int side = fixed != 0 ? fixed : k.side;
    const std::int32_t high = (1 << (tree.levels - k.level)) - side;
    const Mask interior = between(k.x0, 0, high) & between(k.y0, 0, high);
    if (!all(interior | ~active)) return naive_mean<Code>(tree, clamp, k, active);

    // Lanes that nobody asked about stand where the first of the others does.
    alignas(64) std::int32_t x[16], y[16];
    store(x, k.x0);
    store(y, k.y0);
    const int first = __builtin_ctz(bits(active));
    const std::int32_t x0 = x[first], y0 = y[first];
    k.x0 = select(active, k.x0, splat(x0));
    k.y0 = select(active, k.y0, splat(y0));

    const I32 to_end = splat(side - 1);
    const I32 apart = ((k.x0 ^ splat(x0)) | ((k.x0 + to_end) ^ splat(x0))) |
                      ((k.y0 ^ splat(y0)) | ((k.y0 + to_end) ^ splat(y0)));
    const int height = k.level + common_height(united_bits(apart));
    const TreePlace place = extend_path<Code>(tree, x0 << k.level, y0 << k.level, height, path);
    if (place.node == no_tree_node || height == k.level) {
        return mean_of_place<Code, fixed>(tree, k, place, active);
    }

    const std::uint8_t* base = biased_units<Code>(tree);
    const int fit = fitting_height(side);
    Descents16<Code> corner[2][2];
    corner[0][0] = descents_from<Code>(place, active);
    if (!descend_corners<Code>(tree, base, k, side, height, k.level + fit, corner) || fit == 0) {
        return mean_of_corners<Code, fixed>(tree, base, k, fit, corner, active);
    }
    constexpr int most = fixed != 0 ? (fixed < 2 ? 2 : fixed) : max_side;
    Descents16<Code> square[2][most][most];
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i)
            square[0][j][i] = corner[j][i];
    }
    int now = 0;
    for (int h = fit - 1; h >= 0; --h) {
        split_squares<Code>(tree, base, k, h, touched(side, h), square[now], square[1 - now]);
        now = 1 - now;
    }
    return mean<fixed>(k, [&](int i, int j, const F32& depth) {
        return less_equal(depth, value_of_tap<Code>(tree, base, k, square[now][j][i], i, j));
    });
}

// --- levels and views --------------------------------------------------------------------------------------

template <class Code>
F32 mean_at_level(const TreeCode& tree, const PcfLight& light, const Receivers16& r, int level,
                  const Mask& active, TreePath* path) {
    const bool clamp = !light.directional;
    Kernel16 k;
    if (path == nullptr) {
        set_kernel<0>(r, light.side, level, k);
        return naive_mean<Code>(tree, clamp, k, active);
    }
    switch (light.side) {
        case 1:
            set_kernel<1>(r, 1, level, k);
            return shared_mean<Code, 1>(tree, clamp, k, active, *path);
        case 3:
            set_kernel<3>(r, 3, level, k);
            return shared_mean<Code, 3>(tree, clamp, k, active, *path);
        case 5:
            set_kernel<5>(r, 5, level, k);
            return shared_mean<Code, 5>(tree, clamp, k, active, *path);
        default:
            set_kernel<0>(r, light.side, level, k);
            return shared_mean<Code, 0>(tree, clamp, k, active, *path);
    }
}

/// Each lane between its two levels; lanes of one finer level go together.
template <class Code>
F32 mean_between_levels(const TreeCode& tree, const PcfLight& light, const Receivers16& r, const Mask& active,
                        TreePath* path) {
    const auto [fine, blend] = levels_of(r);
    alignas(64) std::int32_t fine_of[16];
    store(fine_of, fine);
    F32 visibility = splat(0.0f);
    for (std::uint32_t left = bits(active); left != 0;) {
        const std::int32_t level = fine_of[__builtin_ctz(left)];
        const Mask lanes_here = mask_of(left) & equal(fine, splat(level));
        const Mask blended = lanes_here & less(splat(0.0f), blend);
        F32 seen = mean_at_level<Code>(tree, light, r, level, lanes_here, path);
        if (any(blended)) {
            const F32 coarse = mean_at_level<Code>(tree, light, r, level + 1, blended, path);
            seen = select(blended, seen + (coarse - seen) * blend, seen);
        }
        visibility = select(lanes_here, seen, visibility);
        left &= ~bits(lanes_here);
    }
    return visibility;
}

/// path: where shared descents are kept; null: naive.
F32 lookup(const TreeCode& tree, const PcfLight& light, const Receivers16& r, const Mask& active,
           TreePath* path) {
    return with_code(tree, [&]<class Code>(Code) {
        return light.filter == PcfFilter::pcf ? mean_at_level<Code>(tree, light, r, 0, active, path)
                                              : mean_between_levels<Code>(tree, light, r, active, path);
    });
}

}  // namespace

void tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    TreePath path[6];
    for (int view = 0; view < light.views; ++view) {
        const TreeCode& tree = *light.view[view].tree;
        with_code(tree, [&]<class Code>(Code) { start_path<Code>(tree, path[view]); });
    }
    for (int at = 0; at < block_samples; at += lanes) {
        store(visibility + at,
              group_visibility(surface, light, at,
                               [&](std::int32_t view, const Receivers16& r, const Mask& active) {
                                   return lookup(*light.view[view].tree, light, r, active, &path[view]);
                               }));
    }
}

void naive_tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept {
    for (int at = 0; at < block_samples; at += lanes) {
        store(visibility + at,
              group_visibility(surface, light, at,
                               [&](std::int32_t view, const Receivers16& r, const Mask& active) {
                                   return lookup(*light.view[view].tree, light, r, active, nullptr);
                               }));
    }
}

}  // namespace obscura::OBSCURA_ISA
