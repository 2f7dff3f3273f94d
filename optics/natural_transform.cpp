#include "optics/natural_transform.h"

namespace obscura {
namespace {

void fill_steps(const UnitRoots& roots, int first, int last, std::vector<float>& re, std::vector<float>& im) {
    const std::int64_t wrap = static_cast<std::int64_t>(roots.re.size()) - 1;
    re.resize(16 * static_cast<std::size_t>(last - first + 1));
    im.resize(re.size());
    std::size_t to = 0;
    for (std::int64_t x = first; x <= last; ++x) {
        for (std::int64_t lane = 0; lane < 16; ++lane, ++to) {
            const auto at = static_cast<std::size_t>((x * lane) & wrap);
            re[to] = roots.re[at];
            im[to] = roots.im[at];
        }
    }
}

}  // namespace

NaturalTransform natural_transform(int width, int height, const NaturalGrid& grid) {
    NaturalTransform t;
    t.grid = grid;
    t.width = width;
    t.height = height;
    t.v_plan = fft_plan(grid.v.log2_period);
    t.u_plan = grid.u.log2_period == grid.v.log2_period ? t.v_plan : fft_plan(grid.u.log2_period);
    t.roots = unit_roots(grid.u.log2_period);
    t.u_roots = exact_roots(grid.u.log2_period);
    t.v_roots = exact_roots(grid.v.log2_period);
    fill_steps(t.roots, 0, width, t.step_re, t.step_im);
    fill_steps(t.roots, -(width / 2), width - width / 2, t.mirror_step_re, t.mirror_step_im);
    t.u_texel = texel_factors(grid.u, width);
    t.v_texel = texel_factors(grid.v, height);
    t.u_edge = edge_factors(grid.u, width);
    for (int group = 0; group < column_groups(grid.u); ++group) {
        t.texel_strips.push_back(complex_strips(grid.u, group, t.u_texel));
        t.edge_strips.push_back(complex_strips(grid.u, group, t.u_edge));
        t.mirror_strips.push_back(mirror_strips(grid.u, group));
        // The first group also holds the columns 0 and M / 2, which are no strips.
        if (group == 0 || !t.mirror_strips.back().strips.empty()) t.used_groups.push_back(group);
    }
    return t;
}

}  // namespace obscura
