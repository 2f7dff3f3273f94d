// The matrix product, sixteen columns and as many rows at a time as registers hold. See product_ref.cpp for
// the meaning of each step.

#include "optics/field/product.h"

#include "core/simd.h"
#include "optics/field/compensated_sum.h"

namespace obscura::OBSCURA_ISA {
namespace {

// Sums of sixteen columns that stay in registers.
#if defined(OBSCURA_ISA_avx512bw)
constexpr int sums_in_registers = 16;
#elif defined(OBSCURA_ISA_avx2)
constexpr int sums_in_registers = 4;
#else
constexpr int sums_in_registers = 2;
#endif

struct Sums {
    F32 rr, ri, ir, ii;
};

/// Lanes of row y, from column x on, that are to be written.
OBSCURA_INLINE std::uint32_t lanes_of(const ProductTarget& t, int x, int y) {
    if (y < 0 || y >= t.height) return 0;
    const int left = t.width - x;
    const std::uint32_t inside = left >= lanes ? 0xffffu : (1u << left) - 1u;
    if (t.active == nullptr) return inside;
    const std::uint8_t* block = t.active + t.active_stride * (y / 8) + x / 8;
    const std::uint32_t low = block[0] != 0 ? 0x00ffu : 0u;
    return inside & (left > 8 && block[1] != 0 ? low | 0xff00u : low);
}

OBSCURA_INLINE void store_lanes(float* to, const F32& v, std::uint32_t which) {
    if (which == 0xffffu) {
        store(to, v);
        return;
    }
    alignas(64) float all[lanes];
    store(all, v);
    for (int l = 0; l < lanes; ++l) {
        if ((which >> l & 1u) != 0) to[l] = all[l];
    }
}
OBSCURA_INLINE F32 load_lanes(const float* from, std::uint32_t which) {
    if (which == 0xffffu) return load(from);
    alignas(64) float all[lanes] = {};
    for (int l = 0; l < lanes; ++l) {
        if ((which >> l & 1u) != 0) all[l] = from[l];
    }
    return load(all);
}

OBSCURA_INLINE void put(const ProductTarget& t, int x, int y, F32 re, F32 im) {
    const std::uint32_t which = lanes_of(t, x, y);
    if (which == 0) return;
    const std::ptrdiff_t at = t.stride * y + x;
    if (t.add) {
        re = load_lanes(t.re + at, which) + re;
        im = load_lanes(t.im + at, which) + im;
    }
    if (t.re != nullptr) store_lanes(t.re + at, re, which);
    if (t.im != nullptr) store_lanes(t.im + at, im, which);
    if (t.power != nullptr) store_lanes(t.power + at, re * re + im * im, which);
}

/// A block of terms, added up in registers: sum p of row r is part[p * rows + r], in the order rr, ri, ir, ii
/// of those that there are.
template <bool odd_a, bool odd_b, int rows>
OBSCURA_INLINE void add_block(const float* a_re, const float* a_im, const float* b_re, const float* b_im,
                              int terms, F32* sums) {
    constexpr int products = (odd_a ? 2 : 1) * (odd_b ? 2 : 1);
    F32 part[products * rows];
#pragma GCC unroll 16
    for (int s = 0; s < products * rows; ++s)
        part[s] = splat(0.0f);
    for (int k = 0; k < terms; ++k) {
        const F32 re16 = load(b_re + lanes * k);
        const F32 im16 = odd_b ? load(b_im + lanes * k) : re16;
#pragma GCC unroll 16
        for (int r = 0; r < rows; ++r) {
            const F32 re = splat(a_re[lanes * k + r]);
            part[r] = part[r] + re * re16;
            if (odd_b) part[rows + r] = part[rows + r] + re * im16;
            if (!odd_a) continue;
            const F32 im = splat(a_im[lanes * k + r]);
            constexpr int ir = odd_b ? 2 : 1;
            part[ir * rows + r] = part[ir * rows + r] + im * re16;
            if (odd_b) part[3 * rows + r] = part[3 * rows + r] + im * im16;
        }
    }
#pragma GCC unroll 16
    for (int s = 0; s < products * rows; ++s)
        sums[s] = part[s];
}

/// Rows of one tile from a_at on, as many as fit. Without odd_a (odd_b) the imaginary parts of A (B) are 0.
template <bool odd_a, bool odd_b, int rows>
OBSCURA_INLINE void add_rows(const ProductPanels& p, std::ptrdiff_t a_at, std::ptrdiff_t b_at,
                             Sums (&sum)[product_tile]) {
    constexpr int products = (odd_a ? 2 : 1) * (odd_b ? 2 : 1);
    const F32 zero = splat(0.0f);
    F32 total[products * rows], lost[products * rows], part[products * rows];
    for (int s = 0; s < products * rows; ++s)
        total[s] = lost[s] = zero;
    for (int k = 0; k < p.terms; k += product_block) {
        const int left = p.terms - k, terms = left < product_block ? left : product_block;
        const std::ptrdiff_t a = a_at + lanes * k, b = b_at + lanes * k;
        add_block<odd_a, odd_b, rows>(p.a_re + a, odd_a ? p.a_im + a : nullptr, p.b_re + b,
                                      odd_b ? p.b_im + b : nullptr, terms, part);
        for (int s = 0; s < products * rows; ++s)
            add_compensated(part[s], total[s], lost[s]);
    }
    for (int r = 0; r < rows; ++r) {
        sum[r].rr = total[r];
        sum[r].ri = odd_b ? total[rows + r] : zero;
        sum[r].ir = odd_a ? total[(odd_b ? 2 : 1) * rows + r] : zero;
        sum[r].ii = odd_a && odd_b ? total[(products - 1) * rows + r] : zero;
    }
}

OBSCURA_INLINE bool any_wanted(const ProductTarget& t, int x, int m, int rows) {
    std::uint32_t which = 0;
    for (int r = m; r < m + rows; ++r) {
        which |= lanes_of(t, x, t.origin + r);
        if (t.mirrored && r > 0) which |= lanes_of(t, x, t.origin - r);
    }
    return which != 0;
}

template <bool odd_a, bool odd_b>
void tile(const ProductPanels& p, const ProductTarget& t, int row_panel, int column_panel) {
    constexpr int products = (odd_a ? 2 : 1) * (odd_b ? 2 : 1);
    constexpr int rows = sums_in_registers > products ? sums_in_registers / products : 1;
    const std::ptrdiff_t size = std::ptrdiff_t{lanes} * p.terms;
    const int x = lanes * column_panel;
    for (int first = 0; first < lanes; first += rows) {
        const int m = lanes * row_panel + first;
        if (!any_wanted(t, x, m, rows)) continue;
        Sums sum[product_tile];
        add_rows<odd_a, odd_b, rows>(p, size * row_panel + first, size * column_panel, sum);
        for (int r = 0; r < rows; ++r) {
            put(t, x, t.origin + m + r, sum[r].rr - sum[r].ii, sum[r].ri + sum[r].ir);
            if (t.mirrored && m + r > 0)
                put(t, x, t.origin - m - r, sum[r].rr + sum[r].ii, sum[r].ri - sum[r].ir);
        }
    }
}

}  // namespace

void product(const ProductPanels& panels, const ProductTarget& target, int row_panel,
             int column_panel) noexcept {
    if (panels.a_im != nullptr && panels.b_im != nullptr) {
        tile<true, true>(panels, target, row_panel, column_panel);
    } else if (panels.a_im != nullptr) {
        tile<true, false>(panels, target, row_panel, column_panel);
    } else if (panels.b_im != nullptr) {
        tile<false, true>(panels, target, row_panel, column_panel);
    } else {
        tile<false, false>(panels, target, row_panel, column_panel);
    }
}

}  // namespace obscura::OBSCURA_ISA
