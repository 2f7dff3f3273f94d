#include "lessons/aperture_panels.h"

#include <algorithm>

namespace obscura {

Image<float> binary_mask(ApertureKind kind, int size) {
    ApertureShape shape;
    shape.kind = kind;
    return reduce(make_aperture(shape, size, 0.01), 0, true).mask;
}

int level_side(const QuadList& quads, std::size_t k) {
    return std::min(quads.width[k], quads.height[k]);
}

QuadList quads_where(const QuadList& quads, const std::function<bool(std::size_t k)>& keep) {
    QuadList kept;
    kept.columns = quads.columns;
    kept.rows = quads.rows;
    for (std::size_t k = 0; k < quads.size(); ++k) {
        if (!keep(k)) continue;
        kept.x.push_back(quads.x[k]);
        kept.y.push_back(quads.y[k]);
        kept.width.push_back(quads.width[k]);
        kept.height.push_back(quads.height[k]);
        kept.weight.push_back(quads.weight[k]);
    }
    return kept;
}

std::size_t count_negative(const QuadList& quads) {
    return static_cast<std::size_t>(
        std::count_if(quads.weight.begin(), quads.weight.end(), [](float w) { return w < 0; }));
}

void draw_quads(Figure& f, Vec2d origin, double texel, const QuadList& quads) {
    for (std::size_t k = 0; k < quads.size(); ++k) {
        const Box box{origin.x + quads.x[k] * texel, origin.y + quads.y[k] * texel, quads.width[k] * texel,
                      quads.height[k] * texel};
        f.fill(box, quads.weight[k] > 0 ? positive_quad : negative_quad);
        if (std::min(box.w, box.h) >= 4) f.frame(box, {ink::paper, 1});
    }
}

}  // namespace obscura
