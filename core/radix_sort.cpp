#include "core/radix_sort.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace obscura {

void sort_bits(std::vector<std::uint64_t>& values, int low, int high) {
    constexpr int digit_bits = 12;
    constexpr std::size_t digits = std::size_t{1} << digit_bits, few = 4 * digits;
    if (values.size() < few) {
        std::stable_sort(values.begin(), values.end(),
                         [&](std::uint64_t a, std::uint64_t b) { return a >> low < b >> low; });
        return;
    }
    std::vector<std::uint64_t> from = std::move(values), to(from.size());
    std::vector<std::size_t> place(digits);
    for (int shift = low; shift < high; shift += digit_bits) {
        const auto digit = [&](std::uint64_t value) { return value >> shift & (digits - 1); };
        std::fill(place.begin(), place.end(), 0);
        for (const std::uint64_t value : from)
            ++place[digit(value)];
        // All in one place: nothing to do for this digit.
        if (place[digit(from[0])] == from.size()) continue;
        std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t{0});
        for (const std::uint64_t value : from)
            to[place[digit(value)]++] = value;
        std::swap(from, to);
    }
    values = std::move(from);
}

}  // namespace obscura
