// The inner loops of the solvers, one number at a time: the lesson, and what the kernels must equal.

#include <cmath>
#include <cstring>

#include "core/scalar_lanes.h"
#include "stereo/solver/grid_rows.h"

namespace obscura::ref {
namespace {

/// Sum of edge weight times neighbour, in the order of the kernels.
float pull(const RowTriple& z, const RowEdges& e, int i) {
    if (e.uniform > 0) {
        return e.uniform * ((z.here[i - 1] + z.here[i + 1]) + (z.above[i] + z.below[i]));
    }
    return (e.right[i - 1] * z.here[i - 1] + e.right[i] * z.here[i + 1]) +
           (e.up[i] * z.above[i] + e.down[i] * z.below[i]);
}

}  // namespace

void update_row(const float* r, const float* q, float alpha, const float* relax, int count, float* r_out,
                float* z) noexcept {
    for (int i = 0; i < count; ++i) {
        r_out[i] = r[i] - alpha * q[i];
        z[i] = relax[i] * r_out[i];
    }
}

void relax_row(const float* r, const float* relax, int count, float* z) noexcept {
    for (int i = 0; i < count; ++i)
        z[i] = relax[i] * r[i];
}

void residual_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax,
                  const float* scale, float keep, int count, float* out) noexcept {
    for (int i = 0; i < count; ++i) {
        float left = keep * r[i] + pull(z, edges, i);
        if (scale != nullptr) left = scale[i] * left;
        out[i] = relax[i] > 0 ? left : 0.0f;
    }
}

void restrict_row(const float* const (&fine_rows)[4], int fine, int coarse, float* scratch,
                  float* out) noexcept {
    // Downwards first: a fine row gives 3/4 to its own coarse row, 1/4 to the nearer neighbour.
    const int count = (fine + 31) / 32 * 32;
    for (int i = 0; i < count; ++i) {
        scratch[i] =
            0.75f * (fine_rows[1][i] + fine_rows[2][i]) + 0.25f * (fine_rows[0][i] + fine_rows[3][i]);
    }
    // Borders have no neighbour to give to: they keep all.
    scratch[-1] = scratch[0];
    for (int i = fine; i < count + 16; ++i)
        scratch[i] = 0;
    if (fine % 2 == 0) scratch[fine] = scratch[fine - 1];
    for (int i = 0; i < (coarse + 15) / 16 * 16; ++i) {
        const float own = scratch[2 * i] + scratch[2 * i + 1];
        const float sides = scratch[2 * i - 1] + scratch[2 * i + 2];
        out[i] = i < coarse ? 0.75f * own + 0.25f * sides : 0.0f;
    }
}

void prolong_row(const float* own, const float* other, int fine, int coarse, float* scratch,
                 float* out) noexcept {
    const int count = (coarse + 15) / 16 * 16;
    for (int i = 0; i < count; ++i)
        scratch[i] = 0.75f * own[i] + 0.25f * other[i];
    scratch[-1] = scratch[0];
    scratch[coarse] = scratch[coarse - 1];
    for (int i = 0; i < count; ++i) {
        out[2 * i] = 0.75f * scratch[i] + 0.25f * scratch[i - 1];
        out[2 * i + 1] = 0.75f * scratch[i] + 0.25f * scratch[i + 1];
    }
    for (int i = fine; i < 2 * count; ++i)
        out[i] = 0;
}

void correct_row(const float* r, const float* p, const float* relax, const float* scale, int count,
                 float* out) noexcept {
    for (int i = 0; i < count; ++i) {
        const float coarse = scale != nullptr ? scale[i] * p[i] : p[i];
        out[i] = relax[i] > 0 ? relax[i] * r[i] + coarse : 0.0f;
    }
}

void smooth_row(const float* r, const RowTriple& z, const RowEdges& edges, const float* relax, float keep,
                int count, float* out, LaneSums& sums) noexcept {
    std::memset(&sums, 0, sizeof sums);
    for (int i = 0; i < count; ++i) {
        const float next = keep * z.here[i] + relax[i] * (r[i] + pull(z, edges, i));
        out[i] = relax[i] > 0 ? next : 0.0f;
        sums.dot[i % 16] += r[i] * out[i];
    }
}

void direction_row(const float* z, const float* p_old, float beta, float alpha, int count, float* x,
                   float* p) noexcept {
    for (int i = 0; i < count; ++i) {
        if (x != nullptr) x[i] = x[i] + alpha * p_old[i];
        p[i] = z[i] + beta * p_old[i];
    }
}

void apply_row(const RowTriple& p, const RowEdges& edges, const float* diagonal, const float* relax,
               int count, float* q, LaneSums& sums) noexcept {
    std::memset(&sums, 0, sizeof sums);
    for (int i = 0; i < count; ++i) {
        const float here = p.here[i], value = diagonal[i] * here - pull(p, edges, i);
        q[i] = relax[i] > 0 ? value : 0.0f;
        sums.dot[i % 16] += here * q[i];
        sums.square[i % 16] += here * here;
        sums.largest[i % 16] = lane_max(std::abs(here), sums.largest[i % 16]);
    }
}

}  // namespace obscura::ref
