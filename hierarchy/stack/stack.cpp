#include "hierarchy/stack/stack.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/build.h"
#include "hierarchy/stack/encode.h"

namespace obscura {
namespace {

void unite(float (&a)[2], const float (&b)[2]) {
    a[0] = std::min(a[0], b[0]);
    a[1] = std::max(a[1], b[1]);
}

SliceRange united(SliceRange a, const SliceRange& b) {
    if (b.tau[0] > b.tau[1]) return a;
    if (a.tau[0] > a.tau[1]) return b;
    unite(a.sigma_x, b.sigma_x);
    unite(a.sigma_y, b.sigma_y);
    unite(a.tau, b.tau);
    return a;
}

}  // namespace

std::vector<SliceRange> slice_ranges(const std::vector<SliceView>& slices, int slice_levels) {
    const std::size_t leaves = std::size_t{1} << slice_levels;
    CHECK(!slices.empty() && slices.size() <= leaves);
    std::vector<SliceRange> ranges(2 * leaves);
    for (std::size_t k = 0; k < slices.size(); ++k) {
        const SliceView& s = slices[k];
        ranges[leaves + k] = {{s.sigma_x, s.sigma_x}, {s.sigma_y, s.sigma_y}, {s.tau, s.tau}};
    }
    for (std::size_t i = leaves - 1; i > 0; --i)
        ranges[i] = united(ranges[2 * i], ranges[2 * i + 1]);
    return ranges;
}

ShadowStack build_stack(const Mesh& mesh, const FocusedViews& views, const StackBuildParams& params,
                        const Exec& exec, StackTreeStats* stats, const std::atomic<bool>* cancel) {
    BuildParams slice_params;
    slice_params.receivers = params.receivers;
    slice_params.only_casters = params.only_casters;
    // Detail that no anisotropy asks for is left out of every map.
    const int map_levels = std::countr_zero(static_cast<unsigned>(views.resolution));
    CHECK(!params.tree.anisotropies.empty());
    const int least = *std::min_element(params.tree.anisotropies.begin(), params.tree.anisotropies.end());
    slice_params.detail_height = std::clamp(least, 0, map_levels);
    const Exec alone{exec.isa, 1};
    const StackTree tree = build_stack_tree(
        static_cast<int>(views.slices.size()), map_levels,
        [&](int k) { return build_certain_tree(mesh, views.view(k), slice_params, alone, nullptr, cancel); },
        params.tree, exec, stats, cancel);
    if (stopped(cancel)) return {};
    ShadowStack stack;
    stack.frame = views.frame;
    stack.slices = std::make_shared<const std::vector<SliceView>>(views.slices);
    stack.ranges =
        std::make_shared<const std::vector<SliceRange>>(slice_ranges(views.slices, tree.shape.slice_levels));
    encode_stack(tree, {}, stack);
    return stack;
}

}  // namespace obscura
