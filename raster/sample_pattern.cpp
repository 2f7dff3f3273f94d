#include "raster/sample_pattern.h"

#include <array>

#include "core/error.h"

namespace obscura {
namespace {

constexpr std::array<SamplePosition, 1> centre = {{{128, 128}}};
constexpr std::array<SamplePosition, 4> rotated_grid = {{{96, 32}, {224, 96}, {32, 160}, {160, 224}}};

/// Row of the queen in each column, found by a search for the greatest least distance.
constexpr std::array<int, 16> queen_rows = {0, 8, 4, 13, 7, 10, 1, 5, 12, 15, 9, 2, 6, 14, 3, 11};

constexpr std::array<SamplePosition, 16> queens = [] {
    std::array<SamplePosition, 16> positions{};
    for (std::size_t i = 0; i < 16; ++i) {
        positions[i] = {static_cast<std::int32_t>(16 * i) + 8, 16 * queen_rows[i] + 8};
    }
    return positions;
}();

}  // namespace

std::span<const SamplePosition> sample_pattern(int samples) {
    CHECK(samples == 1 || samples == 4 || samples == 16);
    if (samples == 1) return centre;
    if (samples == 4) return rotated_grid;
    return queens;
}

}  // namespace obscura
