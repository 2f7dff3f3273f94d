// The matrix product, one frequency at a time.

#include "optics/field/product.h"

#include "optics/field/compensated_sum.h"

namespace obscura::ref {
namespace {

/// Sum over k of a[16 k] b[16 k]; 0 where a factor is missing.
float product_sum(const float* a, const float* b, int terms) {
    if (a == nullptr || b == nullptr) return 0.0f;
    float total = 0, lost = 0;
    for (int k0 = 0; k0 < terms; k0 += product_block) {
        float part = 0;
        for (int k = k0; k < terms && k < k0 + product_block; ++k)
            part = part + a[product_tile * k] * b[product_tile * k];
        add_compensated(part, total, lost);
    }
    return total;
}

void put(const ProductTarget& t, int x, int y, float re, float im) {
    if (y < 0 || y >= t.height || x >= t.width) return;
    if (t.active != nullptr && t.active[t.active_stride * (y / 8) + x / 8] == 0) return;
    const std::ptrdiff_t at = t.stride * y + x;
    if (t.add) {
        re = t.re[at] + re;
        im = t.im[at] + im;
    }
    if (t.re != nullptr) t.re[at] = re;
    if (t.im != nullptr) t.im[at] = im;
    if (t.power != nullptr) t.power[at] = re * re + im * im;
}

const float* lane(const float* panels, std::ptrdiff_t at) {
    return panels == nullptr ? nullptr : panels + at;
}

}  // namespace

void product(const ProductPanels& panels, const ProductTarget& target, int row_panel,
             int column_panel) noexcept {
    const std::ptrdiff_t size = std::ptrdiff_t{product_tile} * panels.terms;
    for (int r = 0; r < product_tile; ++r) {
        const float* a_re = lane(panels.a_re, size * row_panel + r);
        const float* a_im = lane(panels.a_im, size * row_panel + r);
        for (int l = 0; l < product_tile; ++l) {
            const float* b_re = lane(panels.b_re, size * column_panel + l);
            const float* b_im = lane(panels.b_im, size * column_panel + l);
            const float rr = product_sum(a_re, b_re, panels.terms);
            const float ri = product_sum(a_re, b_im, panels.terms);
            const float ir = product_sum(a_im, b_re, panels.terms);
            const float ii = product_sum(a_im, b_im, panels.terms);
            const int m = product_tile * row_panel + r, x = product_tile * column_panel + l;
            put(target, x, target.origin + m, rr - ii, ri + ir);
            if (target.mirrored && m > 0) put(target, x, target.origin - m, rr + ii, ri - ir);
        }
    }
}

}  // namespace obscura::ref
