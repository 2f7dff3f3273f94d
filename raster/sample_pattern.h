#pragma once
// Where in a pixel its samples lie: fixed patterns on the 256 x 256 lattice of sub-texel positions.

#include <cstdint>
#include <span>

namespace obscura {

/// Position of a sample from its pixel's upper left corner, in 1/256 pixel.
struct SamplePosition {
    std::int32_t x = 128, y = 128;
};

/// The pattern of 1, 4 or 16 samples per pixel:
///  - 1: the centre;
///  - 4: a rotated grid, the 4 rooks that near-horizontal and near-vertical edges want;
///  - 16: 16 queens (one sample in each of 16 columns, rows and diagonals) whose least distance, with the
///    neighbour pixels' samples counted, is sqrt(10)/16 pixel.
/// The mean of each pattern is the centre of the pixel.
std::span<const SamplePosition> sample_pattern(int samples);

}  // namespace obscura
