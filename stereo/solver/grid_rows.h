#pragma once
// The inner loops of the solvers: one row of a grid at a time. A sweep over a grid is rows of these, so that
// several steps of an algorithm share one pass over memory (v_cycle.cpp, conjugate_gradients.cpp).
//
// Rows are `count` floats, a multiple of 16, aligned to 64 bytes, with at least 16 floats of padding before
// and after them; what lies outside of the grid is 0, and so are pixels that are not unknowns (their `relax`
// is 0). With that, the five-point stencil needs no case at borders or masks.

namespace obscura {

/// A row and its neighbours above and below.
struct RowTriple {
    const float *above, *here, *below;
};

/// Weights of a row's edges. Uniform: every edge weighs `uniform`, right[i] is not read. Else right[i] is the
/// edge from i to i + 1 (right[-1] is readable), up and down those to the rows above and below.
struct RowEdges {
    float uniform = 0;  ///< > 0: uniform
    const float *right = nullptr, *up = nullptr, *down = nullptr;
};

/// Sums over a row, kept per lane until the end: sum[l] of the elements i with i % 16 == l.
struct alignas(64) LaneSums {
    float dot[16];      ///< of two rows
    float square[16];   ///< of one
    float largest[16];  ///< absolute value
};

/// update_row: r_out = r - alpha q; z = relax r_out.
///
/// relax_row: z = relax r.
///
/// residual_row: what is left of r after z = relax r: out = scale (keep r + sum of edge * z_neighbour) where
/// relax > 0, else 0, with keep = 1 - omega since diagonal * z = omega r. scale may be null: 1.
///
/// restrict_row: the transpose of prolong_row's interpolation, out of four fine rows: the coarse row's two
/// and one on either side. `fine` are the unknowns of a fine row, `coarse` = (fine + 1) / 2 those of a coarse
/// one; scratch has room for the fine row with padding. Fine rows end with zeros.
///
/// prolong_row: bilinear interpolation at cell centres: 3/4 of the row's own coarse row, 1/4 of the other,
/// likewise in x; borders repeat. scratch: a coarse row with padding; out: rounded up to 32.
///
/// correct_row: out = relax r + scale p where relax > 0, else 0. scale may be null: 1.
///
/// smooth_row: one damped Jacobi sweep: out = keep z + relax (r + sum of edge * z_neighbour) where relax > 0,
/// else 0, with keep = 1 - omega. sums.dot is r . out.
///
/// direction_row: x += alpha p_old (x may be null); p = z + beta p_old.
///
/// apply_row: q = diagonal p - sum of edge * p_neighbour where relax > 0, else 0. sums: dot p . q, square and
/// largest of p.
#define OBSCURA_GRID_ROWS                                                                                \
    void update_row(const float* r, const float* q, float alpha, const float* relax, int count,          \
                    float* r_out, float* z) noexcept;                                                    \
    void relax_row(const float* r, const float* relax, int count, float* z) noexcept;                    \
    void residual_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax,     \
                      const float* scale, float keep, int count, float* out) noexcept;                   \
    void restrict_row(const float* const(&fine_rows)[4], int fine, int coarse, float* scratch,           \
                      float* out) noexcept;                                                              \
    void prolong_row(const float* own, const float* other, int fine, int coarse, float* scratch,         \
                     float* out) noexcept;                                                               \
    void correct_row(const float* r, const float* p, const float* relax, const float* scale, int count,  \
                     float* out) noexcept;                                                               \
    void smooth_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax,       \
                    float keep, int count, float* out, LaneSums& sums) noexcept;                         \
    void direction_row(const float* z, const float* p_old, float beta, float alpha, int count, float* x, \
                       float* p) noexcept;                                                               \
    void apply_row(const RowTriple& p, const RowEdges& edges, const float* diagonal, const float* relax, \
                   int count, float* q, LaneSums& sums) noexcept;
namespace ref {
OBSCURA_GRID_ROWS
}
namespace sse2 {
OBSCURA_GRID_ROWS
}
namespace avx2 {
OBSCURA_GRID_ROWS
}
namespace avx512bw {
OBSCURA_GRID_ROWS
}
#undef OBSCURA_GRID_ROWS

}  // namespace obscura
