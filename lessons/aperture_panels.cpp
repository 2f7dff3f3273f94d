#include "lessons/aperture_panels.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace obscura {
namespace {

QuadList picked(const QuadList& quads, const std::vector<std::size_t>& indices) {
    QuadList list;
    list.columns = quads.columns;
    list.rows = quads.rows;
    for (const std::size_t k : indices) {
        list.x.push_back(quads.x[k]);
        list.y.push_back(quads.y[k]);
        list.width.push_back(quads.width[k]);
        list.height.push_back(quads.height[k]);
        list.weight.push_back(quads.weight[k]);
    }
    return list;
}

}  // namespace

Image<float> binary_mask(ApertureKind kind, int size) {
    ApertureShape shape;
    shape.kind = kind;
    return reduce(make_aperture(shape, size, 0.01), 0, true).mask;
}

Image<float> behind_disc_at(Image<float> mask, Vec2d centre, double radius) {
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const Vec2d from{x + 0.5 - centre.x, y + 0.5 - centre.y};
            if (from.x * from.x + from.y * from.y <= radius * radius) mask(x, y) = 0;
        }
    }
    return mask;
}

int level_side(const QuadList& quads, std::size_t k) {
    return std::min(quads.width[k], quads.height[k]);
}

QuadList quads_where(const QuadList& quads, const std::function<bool(std::size_t k)>& keep) {
    std::vector<std::size_t> kept(quads.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    kept.erase(std::remove_if(kept.begin(), kept.end(), [&](std::size_t k) { return !keep(k); }), kept.end());
    return picked(quads, kept);
}

QuadList largest_first(const QuadList& quads) {
    std::vector<std::size_t> order(quads.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto area = [&](std::size_t k) { return std::int64_t{quads.width[k]} * quads.height[k]; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return area(a) > area(b); });
    return picked(quads, order);
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

void draw_outline(Figure& f, Vec2d origin, double texel, const Outline& outline, const Pen& pen) {
    for (std::vector<Vec2d> loop : outline.loops) {
        loop.push_back(loop.front());
        for (Vec2d& p : loop)
            p = origin + p * texel;
        f.polyline(loop, pen);
    }
}

void shade_row(Figure& f, const Plot& plot, ImageView<const float> mask, int row) {
    for (int x = 0; x < mask.width; ++x) {
        const Vec2d top = plot.at(static_cast<double>(x) / mask.width - 0.5, 1),
                    end = plot.at(static_cast<double>(x + 1) / mask.width - 0.5, 0);
        f.fill({top.x, top.y, end.x - top.x, end.y - top.y}, ink::grid, static_cast<double>(mask(x, row)));
    }
}

}  // namespace obscura
