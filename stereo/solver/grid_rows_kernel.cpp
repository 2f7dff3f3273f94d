// The inner loops of the solvers, sixteen numbers at a time.

#include "core/simd.h"
#include "stereo/solver/grid_rows.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Sum of edge weight times neighbour.
template <bool uniform>
OBSCURA_INLINE F32 pull(const RowTriple& z, const RowEdges& e, const F32& weight, int i) {
    const F32 left = load(z.here + i - 1), right = load(z.here + i + 1);
    const F32 above = load(z.above + i), below = load(z.below + i);
    if constexpr (uniform) return weight * ((left + right) + (above + below));
    return (load(e.right + i - 1) * left + load(e.right + i) * right) +
           (load(e.up + i) * above + load(e.down + i) * below);
}

OBSCURA_INLINE F32 where_unknown(const F32& relax, const F32& value) {
    const F32 zero = splat(0.0f);
    return select(less(zero, relax), value, zero);
}

template <bool uniform, bool scaled>
OBSCURA_INLINE void residual_loop(const float* r, const RowTriple& z, const RowEdges& edges,
                                  const float* relax, const float* scale, float keep_, int count,
                                  float* out) {
    const F32 keep = splat(keep_), weight = splat(edges.uniform);
    for (int i = 0; i < count; i += lanes) {
        F32 left = keep * load(r + i) + pull<uniform>(z, edges, weight, i);
        if constexpr (scaled) left = load(scale + i) * left;
        store(out + i, where_unknown(load(relax + i), left));
    }
}

template <bool uniform>
OBSCURA_INLINE void smooth_loop(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax,
                                float keep_, int count, float* out, LaneSums& sums) {
    const F32 keep = splat(keep_), weight = splat(edges.uniform);
    F32 dot = splat(0.0f);
    for (int i = 0; i < count; i += lanes) {
        const F32 factor = load(relax + i), right_side = load(r + i);
        const F32 next = keep * load(z.here + i) + factor * (right_side + pull<uniform>(z, edges, weight, i));
        const F32 value = where_unknown(factor, next);
        store(out + i, value);
        dot = dot + right_side * value;
    }
    store(sums.dot, dot);
    store(sums.square, splat(0.0f));
    store(sums.largest, splat(0.0f));
}

template <bool uniform>
OBSCURA_INLINE void apply_loop(const RowTriple& p, const RowEdges& edges, const float* diagonal,
                               const float* relax, int count, float* q, LaneSums& sums) {
    const F32 weight = splat(edges.uniform);
    F32 dot = splat(0.0f), square = splat(0.0f), largest = splat(0.0f);
    for (int i = 0; i < count; i += lanes) {
        const F32 here = load(p.here + i);
        const F32 value =
            where_unknown(load(relax + i), load(diagonal + i) * here - pull<uniform>(p, edges, weight, i));
        store(q + i, value);
        dot = dot + here * value;
        square = square + here * here;
        largest = max(abs(here), largest);
    }
    store(sums.dot, dot);
    store(sums.square, square);
    store(sums.largest, largest);
}

}  // namespace

void update_row(const float* r, const float* q, float alpha_, const float* relax, int count, float* r_out,
                float* z) noexcept {
    const F32 alpha = splat(alpha_);
    for (int i = 0; i < count; i += lanes) {
        const F32 left = load(r + i) - alpha * load(q + i);
        store(r_out + i, left);
        store(z + i, load(relax + i) * left);
    }
}

void relax_row(const float* r, const float* relax, int count, float* z) noexcept {
    for (int i = 0; i < count; i += lanes)
        store(z + i, load(relax + i) * load(r + i));
}

void residual_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax,
                  const float* scale, float keep, int count, float* out) noexcept {
    const bool uniform = edges.uniform > 0, scaled = scale != nullptr;
    if (uniform && scaled) return residual_loop<true, true>(r, z, edges, relax, scale, keep, count, out);
    if (uniform) return residual_loop<true, false>(r, z, edges, relax, scale, keep, count, out);
    if (scaled) return residual_loop<false, true>(r, z, edges, relax, scale, keep, count, out);
    residual_loop<false, false>(r, z, edges, relax, scale, keep, count, out);
}

void restrict_row(const float* const (&fine_rows)[4], int fine, int coarse, float* scratch,
                  float* out) noexcept {
    const F32 most = splat(0.75f), rest = splat(0.25f);
    const int count = (fine + 31) / 32 * 32;
    for (int i = 0; i < count; i += lanes) {
        const F32 own = load(fine_rows[1] + i) + load(fine_rows[2] + i);
        const F32 sides = load(fine_rows[0] + i) + load(fine_rows[3] + i);
        store(scratch + i, most * own + rest * sides);
    }
    scratch[-1] = scratch[0];
    for (int i = fine; i < count + 16; ++i)
        scratch[i] = 0;
    if (fine % 2 == 0) scratch[fine] = scratch[fine - 1];
    for (int i = 0; i < coarse; i += lanes) {
        // Element 2 i - 1 stands before each even one, 2 i + 2 after each odd one.
        F32 even, odd, before, after, unused;
        load_deinterleaved(scratch + 2 * i, even, odd);
        load_deinterleaved(scratch + 2 * i - 1, before, unused);
        load_deinterleaved(scratch + 2 * i + 1, unused, after);
        store(out + i, most * (even + odd) + rest * (before + after));
    }
    for (int i = coarse; i < (coarse + 15) / 16 * 16; ++i)
        out[i] = 0;
}

void prolong_row(const float* own, const float* other, int fine, int coarse, float* scratch,
                 float* out) noexcept {
    const F32 most = splat(0.75f), rest = splat(0.25f);
    const int count = (coarse + 15) / 16 * 16;
    for (int i = 0; i < count; i += lanes)
        store(scratch + i, most * load(own + i) + rest * load(other + i));
    scratch[-1] = scratch[0];
    scratch[coarse] = scratch[coarse - 1];
    for (int i = 0; i < count; i += lanes) {
        const F32 here = most * load(scratch + i);
        store_interleaved(out + 2 * i, here + rest * load(scratch + i - 1),
                          here + rest * load(scratch + i + 1));
    }
    for (int i = fine; i < 2 * count; ++i)
        out[i] = 0;
}

void correct_row(const float* r, const float* p, const float* relax, const float* scale, int count,
                 float* out) noexcept {
    for (int i = 0; i < count; i += lanes) {
        const F32 factor = load(relax + i);
        F32 coarse = load(p + i);
        if (scale != nullptr) coarse = load(scale + i) * coarse;
        store(out + i, where_unknown(factor, factor * load(r + i) + coarse));
    }
}

void smooth_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax, float keep,
                int count, float* out, LaneSums& sums) noexcept {
    if (edges.uniform > 0) return smooth_loop<true>(r, z, edges, relax, keep, count, out, sums);
    smooth_loop<false>(r, z, edges, relax, keep, count, out, sums);
}

void direction_row(const float* z, const float* p_old, float beta_, float alpha_, int count, float* x,
                   float* p) noexcept {
    const F32 beta = splat(beta_), alpha = splat(alpha_);
    for (int i = 0; i < count; i += lanes) {
        const F32 old = load(p_old + i);
        if (x != nullptr) store(x + i, load(x + i) + alpha * old);
        store(p + i, load(z + i) + beta * old);
    }
}

void apply_row(const RowTriple& p, const RowEdges& edges, const float* diagonal, const float* relax,
               int count, float* q, LaneSums& sums) noexcept {
    if (edges.uniform > 0) return apply_loop<true>(p, edges, diagonal, relax, count, q, sums);
    apply_loop<false>(p, edges, diagonal, relax, count, q, sums);
}

}  // namespace obscura::OBSCURA_ISA
