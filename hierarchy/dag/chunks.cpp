#include "hierarchy/dag/chunks.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "core/error.h"

namespace obscura {
namespace {

using Ranges = std::span<const NumberRange>;

bool holds(NumberRange range, std::uint32_t v) {
    return range.least <= v && v <= range.greatest;
}

/// Factors for which base + step * factor lies in the range, up to `most`; none: nothing.
std::optional<NumberRange> factors_in(NumberRange range, std::uint32_t base, std::uint32_t step,
                                      std::uint32_t most) {
    if (range.greatest < base) return std::nullopt;
    const std::uint32_t from = range.least <= base ? 0 : (range.least - base - 1) / step + 1;
    const std::uint32_t to = std::min((range.greatest - base) / step, most);
    if (from > to) return std::nullopt;
    return NumberRange{from, to};
}

std::uint32_t most_of_bytes(std::uint32_t bytes) {
    return 0xffffffffu >> (32 - 8 * bytes);
}

struct Steps {
    std::uint32_t base = 0, step = 1, bytes = 4;
};

bool fit(Ranges ranges, const Steps& steps) {
    return std::all_of(ranges.begin(), ranges.end(), [&](NumberRange range) {
        return factors_in(range, steps.base, steps.step, most_of_bytes(steps.bytes)).has_value();
    });
}

/// The greatest power of two of which every range holds a multiple: coarser ones lose a range, finer ones
/// have more to count.
Steps power_of_two_steps(Ranges ranges) {
    for (int s = 31;; --s) {
        const std::uint64_t unit = std::uint64_t{1} << s;
        std::uint64_t least_last = ~std::uint64_t{0}, greatest_first = 0;
        bool all = true;
        for (const NumberRange& range : ranges) {
            const std::uint64_t first = (range.least + unit - 1) >> s, last = range.greatest >> s;
            all = all && first <= last;
            least_last = std::min(least_last, last);
            greatest_first = std::max(greatest_first, first);
        }
        if (!all) continue;
        const std::uint64_t most = greatest_first > least_last ? greatest_first - least_last : 0;
        const auto bits = static_cast<std::uint32_t>(std::bit_width(most));
        return {static_cast<std::uint32_t>(least_last << s), static_cast<std::uint32_t>(unit),
                std::max((bits + 7) / 8, 1u)};
    }
}

/// Steps for ranges that no number is common to. Powers of two first; then, with fewer bytes, the paper's:
/// equal steps from the lowest range to the highest.
Steps steps_for(Ranges ranges) {
    const Steps powers = power_of_two_steps(ranges);
    std::uint32_t from = ~0u, to = 0;
    for (const NumberRange& range : ranges) {
        from = std::min(from, range.greatest);
        to = std::max(to, range.least);
    }
    for (std::uint32_t bytes = 1; bytes < powers.bytes && from < to; ++bytes) {
        const Steps equal{from, (to - from - 1) / most_of_bytes(bytes) + 1, bytes};
        if (fit(ranges, equal)) return equal;
    }
    return powers.bytes == 4 ? Steps{} : powers;
}

}  // namespace

NumberRange most_held(Ranges ranges) {
    struct End {
        std::uint32_t at;
        bool last;  ///< of its range: behind the first ones at the same number, as
                    ///< ranges are closed
    };
    std::array<End, 2u << max_chunk_log2> ends;
    std::size_t count = 0;
    for (const NumberRange& range : ranges) {
        ends[count++] = {range.least, false};
        ends[count++] = {range.greatest, true};
    }
    std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(count),
              [](const End& a, const End& b) { return a.at != b.at ? a.at < b.at : a.last < b.last; });
    NumberRange best;
    int open = 0, most = 0;
    for (std::size_t i = 0; i < count; ++i) {
        open += ends[i].last ? -1 : 1;
        // Behind a first end always stands another.
        if (open > most) {
            most = open;
            best = {ends[i].at, ends[i + 1].at};
        }
    }
    return best;
}

ValueChunk chunk_of(Ranges ranges, TreeLayout layout) {
    CHECK(!ranges.empty() && ranges.size() <= 1u << max_chunk_log2);
    ValueChunk chunk;
    chunk.representative = stored_number(most_held(ranges), layout);
    std::vector<NumberRange> others;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if (holds(ranges[i], chunk.representative)) continue;
        chunk.has_factor[i / 32] |= 1u << i % 32;
        others.push_back(ranges[i]);
    }
    if (others.empty()) return chunk;

    const Steps steps = steps_for(others);
    chunk.base = steps.base;
    chunk.step = steps.step;
    chunk.factor_bytes = steps.bytes;
    for (const NumberRange& range : others) {
        const std::optional<NumberRange> in =
            factors_in(range, steps.base, steps.step, most_of_bytes(steps.bytes));
        CHECK(in.has_value());
        const std::uint32_t wanted = stored_number(range, layout);
        const std::uint32_t nearest = wanted <= steps.base ? 0 : (wanted - steps.base) / steps.step;
        chunk.factors.push_back(std::clamp(nearest, in->least, in->greatest));
    }
    return chunk;
}

}  // namespace obscura
