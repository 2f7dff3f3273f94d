#pragma once
// The matrix product behind the separable strategies, a tile of 16 x 16 frequencies at a time. POD: kernels
// include this.
//
// F(u, v) = sum over k of A_k(v) B_k(u). Masks are real, so A_k(-v) is the conjugate of A_k(v), and the four
// real products
//     P = sum Re A Re B,   Q = sum Re A Im B,   R = sum Im A Re B,   S = sum Im A Im B
// serve both rows at once: F(u, v) = (P - S) + i (Q + R), F(u, -v) = (P + S) + i (Q - R). Factors that are
// even are real, and leave two products or one.
//
// K. Goto, R. A. van de Geijn: Anatomy of high-performance matrix multiplication, ACM TOMS 34(3), 2008, for
// the panels and the tile in registers. Terms are added in order, 32 at a time, and the partial sums with
// compensation: one order for every instruction set, and an error that does not grow with their number.

#include <cstddef>
#include <cstdint>

namespace obscura {

inline constexpr int product_tile = 16;

/// Factors in panels of sixteen frequencies: element (k, l) of panel p is [(p * terms + k) * 16 + l]. a_im,
/// b_im are null where all their elements are 0.
struct ProductPanels {
    const float* a_re = nullptr;
    const float* a_im = nullptr;
    const float* b_re = nullptr;
    const float* b_im = nullptr;
    int terms = 0;
};

/// Row m of the product is row `origin` + m of the target and, when mirrored, row origin - m too (conjugate
/// A). Rows outside the target are dropped.
struct ProductTarget {
    float* re = nullptr;  ///< any of the three may be null
    float* im = nullptr;
    float* power = nullptr;
    std::ptrdiff_t stride = 0;
    int width = 0, height = 0;
    int origin = 0;
    bool mirrored = false;
    bool add = false;                      ///< to re and im, which must be there; power is that of the sum
    const std::uint8_t* active = nullptr;  ///< per 8 x 8 pixels; others are left alone. Null: all
    std::ptrdiff_t active_stride = 0;
};

/// The tile of panel row_panel of A and column_panel of B.
#define OBSCURA_PRODUCT                                                                   \
    void product(const ProductPanels& panels, const ProductTarget& target, int row_panel, \
                 int column_panel) noexcept;
namespace ref {
OBSCURA_PRODUCT
}
namespace sse2 {
OBSCURA_PRODUCT
}
namespace avx2 {
OBSCURA_PRODUCT
}
namespace avx512bw {
OBSCURA_PRODUCT
}
#undef OBSCURA_PRODUCT

/// Terms added before a partial sum joins the total.
inline constexpr int product_block = 32;

}  // namespace obscura
