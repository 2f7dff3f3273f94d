#pragma once
// How the maps of a stack are divided when all are asked at once, for lessons and pictures.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hierarchy/stack/stack_query.h"

namespace obscura {

/// Maps [first, first + maps), whose samples all reach a point or all do not, found by one question.
struct AnsweredRun {
    std::int32_t first = 0, maps = 0;
    bool lit = false;
    friend bool operator==(const AnsweredRun&, const AnsweredRun&) = default;
};

namespace ref {

/// The questions of lit_samples() that were answered for point i, in the order of the maps: together all
/// maps, and the maps of those that are lit are its count. Adds the same to `work`.
std::vector<AnsweredRun> answered_runs(const StackLookup& stack, const StackPoints& points, std::size_t i,
                                       StackWork& work);

}  // namespace ref
}  // namespace obscura
