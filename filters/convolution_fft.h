#pragma once
// Convolution of planes, tile by tile. Internal to convolution*.cpp.

#include <cstddef>
#include <span>

#include "core/isa.h"
#include "filters/convolution.h"

namespace obscura {

/// One channel of a picture: `step` floats from pixel to pixel, `stride` from row to row.
template <class T>
struct Channel {
    T* data = nullptr;
    int width = 0, height = 0;
    std::ptrdiff_t step = 1, stride = 0;
    T* row(int y) const { return data + stride * y; }
};

/// One channel's convolution. `out` has the size of the full convolution and is 0.
struct ChannelConvolution {
    Channel<const float> source, kernel;
    Channel<float> out;
};

/// Channels of the same sizes, one after the other in the same memory.
void convolve_tiles(std::span<const ChannelConvolution> channels, const ConvolutionPlan& plan,
                    const Exec& exec);

}  // namespace obscura
