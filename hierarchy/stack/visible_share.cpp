#include "hierarchy/stack/visible_share.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// The row for points relative to the eye.
void shift(double (&row)[4], Vec3d eye) {
    row[3] += row[0] * eye.x + row[1] * eye.y + row[2] * eye.z;
}

/// n . e where e is the step in the world that changes this coordinate alone by one: rows are orthogonal.
void set_dual(const double (&row)[4], float (&to)[3]) {
    const double square = row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
    for (int i = 0; i < 3; ++i)
        to[i] = static_cast<float>(row[i] / square);
}

StackPoints part_of(const StackPoints& p, std::size_t begin, std::size_t end) {
    StackPoints part = p;
    for (const float** array : {&part.px, &part.py, &part.pz, &part.nx, &part.ny, &part.nz})
        *array += begin;
    if (part.pattern != nullptr) part.pattern += begin;
    part.count = end - begin;
    return part;
}

}  // namespace

StackLookup stack_lookup(const ShadowStack& stack, Vec3d eye) {
    StackLookup lookup;
    lookup.code = stack.code;
    lookup.frame = stack.frame;
    shift(lookup.frame.a, eye);
    shift(lookup.frame.b, eye);
    shift(lookup.frame.h, eye);
    set_dual(stack.frame.a, lookup.normal_a);
    set_dual(stack.frame.b, lookup.normal_b);
    set_dual(stack.frame.h, lookup.normal_h);
    lookup.ranges = stack.ranges->data();
    lookup.slices = static_cast<std::int32_t>(stack.slices->size());
    return lookup;
}

std::vector<float> visible_share(const StackLookup& stack, const StackPoints& points, int samples,
                                 const Exec& exec, StackWork* work) {
    CHECK(samples >= 0 && samples <= stack.slices && (samples == 0 || points.pattern != nullptr));
    constexpr std::size_t block = 4096;
    std::vector<float> share(points.count);
    std::vector<StackWork> done((points.count + block - 1) / block);
    parallel_blocks(points.count, block, exec, [&](std::size_t begin, std::size_t end) {
        std::uint16_t lit[block];
        const StackPoints part = part_of(points, begin, end);
        StackWork& counted = done[begin / block];
        if (samples == 0) {
            OBSCURA_DISPATCH(exec.isa, lit_samples, stack, part, lit, counted);
        } else {
            OBSCURA_DISPATCH(exec.isa, lit_of_subset, stack, part, samples, lit, counted);
        }
        const auto all = static_cast<float>(samples == 0 ? stack.slices : samples);
        for (std::size_t i = begin; i < end; ++i)
            share[i] = static_cast<float>(lit[i - begin]) / all;
    });
    if (work != nullptr) {
        for (const StackWork& w : done) {
            work->nodes += w.nodes;
            work->lookups += w.lookups;
        }
    }
    return share;
}

}  // namespace obscura
