// The far field by shapes: quads of one width and height share one transform.
//
// L. Scandolo: Compression and rendering with image-based representations (thesis, 2019), section 3.4.1,
// equation 3.14, the shift property. The paper prints W_m(q) = h(d q) W_k(q) for f_m(p) = f_k(p + d); the
// factor is h(-d q), with h(x) = e^(-2 pi i x). Stated without signs to mistake: a quad with its middle at c
// has h(c q) times the transform of the same quad at the origin, which is real.
//
// So for each shape the phases of its quads are summed, and the sum is multiplied by w sinc(u w) h sinc(v h).
// The phases are separable too, and are summed by the matrix product of optics/field/product.h.

#include "optics/thesis/far_field.h"

#include <map>

#include "core/buffer.h"
#include "core/parallel.h"
#include "optics/field/field_rows.h"
#include "optics/field/separable_field.h"

namespace obscura {
namespace {

using Shape = std::pair<std::int32_t, std::int32_t>;

/// The quads of every shape (width, height).
std::map<Shape, QuadList> by_shape(const QuadList& quads) {
    std::map<Shape, QuadList> shapes;
    for (std::size_t k = 0; k < quads.size(); ++k) {
        QuadList& list = shapes[{quads.width[k], quads.height[k]}];
        list.columns = quads.columns;
        list.rows = quads.rows;
        list.x.push_back(quads.x[k]);
        list.y.push_back(quads.y[k]);
        list.width.push_back(quads.width[k]);
        list.height.push_back(quads.height[k]);
        list.weight.push_back(quads.weight[k]);
    }
    return shapes;
}

/// Transform of an interval around the origin, at the samples of a ramp: real.
std::vector<float> centred_box(int size, const FrequencyRamp& ramp, const Exec& exec) {
    IntervalTerms interval;
    interval.add(-size * 0.5, size * 0.5, 1.0f);
    interval.close_term();
    std::vector<float> re(static_cast<std::size_t>((ramp.count + 15) / 16 * 16)), im(re.size());
    for (int at = 0; at < ramp.count; at += 16)
        OBSCURA_DISPATCH(exec.isa, box_panel, ramp, at, interval.view(), re.data() + at, im.data() + at);
    return re;
}

}  // namespace

void far_field_shift(const QuadList& quads, const FrequencyGrid& grid, const FieldTarget& target,
                     const Exec& exec) {
    CHECK(target.stride >= grid.width);
    const auto width = static_cast<std::size_t>(grid.width), height = static_cast<std::size_t>(grid.height);
    Field sum{Image<float>(grid.width, grid.height), Image<float>(grid.width, grid.height)};
    Buffer<float> phase_re(width * height), phase_im(width * height);
    SeparableParams params;
    params.points = true;
    for (const auto& [shape, list] : by_shape(quads)) {
        separable_field(separable_terms(list), grid, params,
                        {phase_re.data(), phase_im.data(), nullptr, grid.width}, exec);
        const std::vector<float> box_u =
                                     centred_box(shape.first, {grid.first_u, grid.step_u, grid.width}, exec),
                                 box_v = centred_box(shape.second, {grid.first_v, grid.step_v, grid.height},
                                                     exec);
        parallel_blocks(height, 16, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                float *re = sum.re.row(static_cast<int>(y)), *im = sum.im.row(static_cast<int>(y));
                for (std::size_t x = 0; x < width; ++x) {
                    const float box = box_u[x] * box_v[y];
                    re[x] += box * phase_re[y * width + x];
                    im[x] += box * phase_im[y * width + x];
                }
            }
        });
    }
    parallel_blocks(height, 16, exec, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            put_row(target, y, grid.width, sum.re.row(y), sum.im.row(y));
    });
}

}  // namespace obscura
