// Near field of quads as equation 3.19 states it: at every pixel, over every quad, the product of two
// differences of Fresnel integrals. All sums in double: the reference, and the cheapest for a few pixels.

#include "optics/thesis/near_field.h"

#include <algorithm>
#include <vector>

#include "core/parallel.h"

namespace obscura {
namespace {

/// Both edges of every quad along one axis, ascending, without repetition.
std::vector<std::int32_t> edges_of(const std::vector<std::int32_t>& start,
                                   const std::vector<std::int32_t>& size) {
    std::vector<std::int32_t> edges = start;
    for (std::size_t k = 0; k < start.size(); ++k)
        edges.push_back(start[k] + size[k]);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

void write_row(const std::vector<double>& re, const std::vector<double>& im, const FieldTarget& target,
               std::ptrdiff_t row) {
    for (std::size_t x = 0; x < re.size(); ++x) {
        const std::ptrdiff_t at = row * target.stride + static_cast<std::ptrdiff_t>(x);
        if (target.re) target.re[at] = static_cast<float>(re[x]);
        if (target.im) target.im[at] = static_cast<float>(im[x]);
        if (target.power) target.power[at] = static_cast<float>(re[x] * re[x] + im[x] * im[x]);
    }
}

}  // namespace

void near_field_direct(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                       const Exec& exec) {
    const EdgeTable across(c.horizontal(), c.turns, edges_of(quads.x, quads.width), exec);
    const EdgeTable down(c.vertical(), c.turns, edges_of(quads.y, quads.height), exec);
    parallel_for(static_cast<std::size_t>(c.grid.height), exec, [&](std::size_t y) {
        std::vector<double> re(static_cast<std::size_t>(c.grid.width), 0.0), im = re;
        for (std::size_t k = 0; k < quads.size(); ++k) {
            const int top = quads.y[k], bottom = top + quads.height[k];
            const int left = quads.x[k], right = left + quads.width[k];
            // The factor along y with the weight and 1 / (2 i): c + i s becomes (s - i c) / 2.
            const double weight = 0.5 * static_cast<double>(quads.weight[k]);
            const double g_re = weight * (down.im(bottom)[y] - down.im(top)[y]);
            const double g_im = -weight * (down.re(bottom)[y] - down.re(top)[y]);
            const double *re0 = across.re(left), *re1 = across.re(right);
            const double *im0 = across.im(left), *im1 = across.im(right);
            for (std::size_t x = 0; x < re.size(); ++x) {
                const double a = re1[x] - re0[x], b = im1[x] - im0[x];
                re[x] += a * g_re - b * g_im;
                im[x] += a * g_im + b * g_re;
            }
        }
        write_row(re, im, target, static_cast<std::ptrdiff_t>(y));
    });
}

}  // namespace obscura
