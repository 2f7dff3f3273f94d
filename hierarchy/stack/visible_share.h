#pragma once
// The lookups of stack_query.h for many points: the public form.

#include <vector>

#include "core/isa.h"
#include "hierarchy/stack/stack.h"
#include "hierarchy/stack/stack_query.h"

namespace obscura {

/// A stack for points relative to `eye`. `stack` must outlive it.
StackLookup stack_lookup(const ShadowStack& stack, Vec3d eye);

/// The share of the light's samples that reaches each point, in [0, 1]. `samples` in [1, number of maps] asks
/// a subset (the paper's way), 0 all maps at less than one lookup each; points.pattern may be null then. The
/// same for any exec.
std::vector<float> visible_share(const StackLookup& stack, const StackPoints& points, int samples,
                                 const Exec& exec, StackWork* work = nullptr);

}  // namespace obscura
