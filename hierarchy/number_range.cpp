#include "hierarchy/number_range.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "hierarchy/fixed_depth.h"

namespace obscura {
namespace {

constexpr double two_to_32 = 4294967296.0;
constexpr double last_fraction = two_to_32 - 1;

/// Fractions that round to one float: no more than this on either side of it.
constexpr std::uint32_t widest_rounding = 256;

/// Least v in [from, to] for which `holds`, which is monotone and holds for `to`.
template <class Holds>
std::uint32_t least_where(std::uint32_t from, std::uint32_t to, const Holds& holds) {
    while (from < to) {
        const std::uint32_t middle = from + (to - from) / 2;
        (holds(middle) ? to : from) = holds(middle) ? middle : middle + 1;
    }
    return to;
}

NumberRange fractions_of(DepthInterval interval) {
    // Scaling by a power of two is exact in double.
    const auto above = static_cast<std::uint32_t>(
        std::min(std::ceil(static_cast<double>(interval.entry) * two_to_32), last_fraction));
    const auto below = static_cast<std::uint32_t>(
        std::min(std::floor(static_cast<double>(interval.exit) * two_to_32), last_fraction));
    NumberRange range;
    // The ends' neighbours may still round to them.
    range.least = least_where(above - std::min(above, widest_rounding), above,
                              [&](std::uint32_t v) { return depth_of_fraction(v) >= interval.entry; });
    const std::uint32_t beyond = below + std::min(~below, widest_rounding);
    if (depth_of_fraction(beyond) <= interval.exit) {
        range.greatest = beyond;
    } else {
        const std::uint32_t first_outside =
            least_where(below, beyond, [&](std::uint32_t v) { return depth_of_fraction(v) > interval.exit; });
        range.greatest = first_outside - 1;
    }
    return range;
}

}  // namespace

NumberRange range_of(DepthInterval interval, TreeLayout layout) {
    if (layout != TreeLayout::float_bits) return fractions_of(interval);
    // Zeros of either sign are one depth.
    return {std::bit_cast<std::uint32_t>(interval.entry + 0.0f),
            std::bit_cast<std::uint32_t>(interval.exit + 0.0f)};
}

TreeLayout numbers_that_hold(const MultiresTree& tree, TreeLayout wanted) {
    const auto none = [](DepthInterval interval) { return fractions_of(interval).empty(); };
    const bool fractions = wanted == TreeLayout::fractions && !none(tree.root_interval) &&
                           std::none_of(tree.intervals.begin(), tree.intervals.end(), none);
    return fractions ? TreeLayout::fractions : TreeLayout::float_bits;
}

std::uint32_t stored_number(NumberRange range, TreeLayout layout) {
    if (layout != TreeLayout::float_bits) {
        constexpr auto deepest = static_cast<std::uint32_t>(static_cast<double>(deepest_stored) * two_to_32);
        return range.least + std::min((range.greatest - range.least) / 2, deepest);
    }
    return std::bit_cast<std::uint32_t>(
        stored_depth({std::bit_cast<float>(range.least), std::bit_cast<float>(range.greatest)}) + 0.0f);
}

}  // namespace obscura
