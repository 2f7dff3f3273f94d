// Lookups in a stack, sixteen points at a time.

#include "hierarchy/stack/stack_query.h"

#include "hierarchy/stack/stack_lanes.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// A run of maps that some lanes ask for, and where their descents stand.
struct Task {
    std::int32_t run, exponent;
    Mask asks;
    Places16 at;
};

OBSCURA_INLINE std::uint64_t count_of(const Mask& m) {
    return static_cast<std::uint64_t>(__builtin_popcount(bits(m)));
}

/// Halves wait on top of each other: one more for each time all maps can be halved.
constexpr int most_tasks = 20;

/// Where lit samples are counted: all together,
struct OneTally {
    I32 lit = splat(std::int32_t{0});
    OBSCURA_INLINE void add(const Mask& which, std::int32_t, std::int32_t maps) {
        lit = lit + select(which, splat(maps), splat(std::int32_t{0}));
    }
};

/// or those of each run of 2^exponent maps.
struct PartTally {
    std::int32_t exponent;
    I32 lit[most_stack_parts];
    OBSCURA_INLINE PartTally(std::int32_t part_exponent, std::int32_t parts) : exponent(part_exponent) {
        for (std::int32_t part = 0; part < parts; ++part)
            lit[part] = splat(std::int32_t{0});
    }
    OBSCURA_INLINE void add(const Mask& which, std::int32_t first, std::int32_t maps) {
        while (maps > 0) {
            const std::int32_t part = first >> exponent, end = (part + 1) << exponent,
                               here = first + maps < end ? maps : end - first;
            lit[part] = lit[part] + select(which, splat(here), splat(std::int32_t{0}));
            first += here;
            maps -= here;
        }
    }
};

/// Which of all maps' samples reach each of sixteen points.
template <bool wide, class Tally>
OBSCURA_INLINE void lit_of_all(const StackLookup& stack, const std::uint8_t* base, const Receivers16& p,
                               Tally& lit, StackWork& work) {
    const std::int32_t size = std::int32_t{1} << stack.code.shape.map_levels,
                       leaves = std::int32_t{1} << stack.code.shape.slice_levels;
    lit.add(p.before_near, 0, stack.slices);
    Task tasks[most_tasks];
    int open = 1;
    tasks[0] = {1, stack.code.shape.slice_levels, p.valid & ~p.before_near, at_root<wide>(stack.code)};
    while (open > 0) {
        const Task task = tasks[--open];
        const std::int32_t first = (task.run << task.exponent) - leaves,
                           length = std::int32_t{1} << task.exponent;
        std::int32_t maps = stack.slices - first;
        if (maps <= 0 || none(task.asks)) continue;
        if (maps > length) maps = length;
        work.lookups += count_of(task.asks);

        const Range16 range = range_of(stack.ranges[task.run]);
        const Seen16 s = see(p, range, size);
        lit.add(task.asks & s.outside, first, maps);
        Mask asks = task.asks & ~s.outside & ~(s.inside & s.away);
        if (none(asks)) continue;
        Places16 at = task.at;
        const I32 k[2] = {splat(first), splat(first + length - 1)};
        work.nodes += descend<wide>(stack.code, base, asks & s.inside, s, k, at);
        const Mask answered = asks & s.inside & at.ended & s.facing;
        if (any(answered)) {
            const F32 value = values(base, at);
            if (task.exponent == 0) {
                const Mask is_lit = answered & less_equal(compared_depth(p, range, s), value);
                lit.add(is_lit, first, maps);
                continue;
            }
            const Mask is_lit = answered & less_equal(s.deepest, value), is_dark = less(value, s.nearest);
            lit.add(is_lit, first, maps);
            asks = asks & ~(answered & (is_lit | is_dark));
        }
        if (none(asks)) continue;
        tasks[open++] = {2 * task.run + 1, task.exponent - 1, asks, at};
        tasks[open++] = {2 * task.run, task.exponent - 1, asks, at};
    }
}

OBSCURA_INLINE F32 gather_range(const StackLookup& stack, const I32& run, int number) {
    constexpr int floats = sizeof(SliceRange) / sizeof(float);
    return gather(stack.ranges->sigma_x + number, run * splat(std::int32_t{floats}));
}

/// The same of a subset.
template <bool wide>
OBSCURA_INLINE I32 lit_of_some(const StackLookup& stack, const std::uint8_t* base, const Receivers16& p,
                               const std::uint32_t (&pattern)[16], int samples, StackWork& work) {
    const std::int32_t size = std::int32_t{1} << stack.code.shape.map_levels,
                       leaves = std::int32_t{1} << stack.code.shape.slice_levels;
    const I32 nothing = splat(std::int32_t{0}), one = splat(std::int32_t{1});
    I32 lit = select(p.before_near, splat(samples), nothing);
    const Mask asks = p.valid & ~p.before_near;
    if (none(asks)) return lit;
    for (std::int32_t j = 0; j < samples; ++j) {
        alignas(64) std::int32_t which[16];
        for (int i = 0; i < 16; ++i)
            which[i] = subset_slice(stack.slices, samples, j, pattern[i]);
        const I32 map = load(which), run = map + splat(leaves);
        work.lookups += count_of(asks);
        const F32 sigma_x = gather_range(stack, run, 0), sigma_y = gather_range(stack, run, 2),
                  tau = gather_range(stack, run, 4);
        const Range16 range{{sigma_x, sigma_x}, {sigma_y, sigma_y}, {tau, tau}};
        const Seen16 s = see(p, range, size);
        lit = lit + select(asks & ~s.inside, one, nothing);
        const Mask looks = asks & s.inside & s.facing;
        if (none(looks)) continue;
        Places16 at = at_root<wide>(stack.code);
        const I32 k[2] = {map, map};
        work.nodes += descend<wide>(stack.code, base, looks, s, k, at);
        lit = lit + select(looks & less_equal(compared_depth(p, range, s), values(base, at)), one, nothing);
    }
    return lit;
}

OBSCURA_INLINE void store_counts(const I32& lit, std::size_t first, std::size_t count, std::uint16_t* to) {
    alignas(64) std::int32_t counts[16];
    store(counts, lit);
    for (std::size_t i = first; i < count && i < first + 16; ++i)
        to[i] = static_cast<std::uint16_t>(counts[i - first]);
}

template <bool wide>
void all_points(const StackLookup& stack, const StackPoints& points, std::uint16_t* lit, StackWork& work) {
    const std::uint8_t* base = biased_words(stack.code);
    for (std::size_t first = 0; first < points.count; first += 16) {
        const Receivers16 p = receivers_at(stack, points, first);
        OneTally all;
        lit_of_all<wide>(stack, base, p, all, work);
        store_counts(all.lit, first, points.count, lit);
    }
}

template <bool wide>
void all_points_by_parts(const StackLookup& stack, const StackPoints& points, std::int32_t parts,
                         std::uint16_t* lit, StackWork& work) {
    const std::uint8_t* base = biased_words(stack.code);
    std::int32_t exponent = stack.code.shape.slice_levels;
    for (std::int32_t of = parts; of > 1; of /= 2)
        --exponent;
    for (std::size_t first = 0; first < points.count; first += 16) {
        const Receivers16 p = receivers_at(stack, points, first);
        PartTally tally(exponent, parts);
        lit_of_all<wide>(stack, base, p, tally, work);
        for (std::int32_t part = 0; part < parts; ++part) {
            store_counts(tally.lit[part], first, points.count,
                         lit + static_cast<std::size_t>(part) * points.count);
        }
    }
}

template <bool wide>
void some_points(const StackLookup& stack, const StackPoints& points, int samples, std::uint16_t* lit,
                 StackWork& work) {
    const std::uint8_t* base = biased_words(stack.code);
    for (std::size_t first = 0; first < points.count; first += 16) {
        const Receivers16 p = receivers_at(stack, points, first);
        std::uint32_t pattern[16] = {};
        for (std::size_t i = first; i < points.count && i < first + 16; ++i)
            pattern[i - first] = points.pattern[i];
        store_counts(lit_of_some<wide>(stack, base, p, pattern, samples, work), first, points.count, lit);
    }
}

}  // namespace

void lit_samples(const StackLookup& stack, const StackPoints& points, std::uint16_t* lit,
                 StackWork& work) noexcept {
    if (stack.code.layout == StackLayout::wide) {
        all_points<true>(stack, points, lit, work);
    } else {
        all_points<false>(stack, points, lit, work);
    }
}

void lit_of_parts(const StackLookup& stack, const StackPoints& points, std::int32_t parts, std::uint16_t* lit,
                  StackWork& work) noexcept {
    if (stack.code.layout == StackLayout::wide) {
        all_points_by_parts<true>(stack, points, parts, lit, work);
    } else {
        all_points_by_parts<false>(stack, points, parts, lit, work);
    }
}

void lit_of_subset(const StackLookup& stack, const StackPoints& points, int samples, std::uint16_t* lit,
                   StackWork& work) noexcept {
    if (stack.code.layout == StackLayout::wide) {
        some_points<true>(stack, points, samples, lit, work);
    } else {
        some_points<false>(stack, points, samples, lit, work);
    }
}

}  // namespace obscura::OBSCURA_ISA
