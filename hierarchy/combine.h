#pragma once
// One step of the bottom-up construction: the mode of four (or eight) depth intervals.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Compressed Multiresolution Hierarchies for High-Quality Precomputed
// Shadows", Eurographics 2016, section 3.1 and algorithm 2. Fixed here, where the paper leaves it open:
//  - intervals are closed;
//  - candidate values are the children's minima, in child order: a most-stabbed value can always be moved up
//    to the minimum of one of the intervals it stabs. The first that strictly beats all before it wins;
//  - the parent's interval is the intersection of the children that contain that value.

#include "core/types.h"

namespace obscura {

/// Result of combining siblings: the parent's interval, and which children (bit i) it stands for.
struct Combined {
    DepthInterval interval;
    unsigned covered = 0;
    friend bool operator==(const Combined&, const Combined&) = default;
};

constexpr bool contains(DepthInterval i, float depth) {
    return i.entry <= depth && depth <= i.exit;
}

/// Mode of `count` intervals. When they have a common depth, all are covered and the result is their
/// intersection.
template <int count>
constexpr Combined combine(const DepthInterval (&child)[count]) {
    int best = 0, best_stabbed = 0;
    for (int c = 0; c < count; ++c) {
        int stabbed = 0;
        for (int i = 0; i < count; ++i)
            stabbed += contains(child[i], child[c].entry) ? 1 : 0;
        if (stabbed > best_stabbed) {
            best = c;
            best_stabbed = stabbed;
        }
    }
    Combined result;
    result.interval = child[best];
    for (int i = 0; i < count; ++i) {
        if (!contains(child[i], child[best].entry)) continue;
        result.covered |= 1u << i;
        if (child[i].entry > result.interval.entry) result.interval.entry = child[i].entry;
        if (child[i].exit < result.interval.exit) result.interval.exit = child[i].exit;
    }
    return result;
}

}  // namespace obscura
