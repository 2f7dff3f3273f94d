#pragma once
// Which squares of a light's map the kernels of a block of samples read. POD: kernels include this.
//
// What pcf_block (filters/pcf.h) would ask, without asking: for who builds only what a picture looks up.

#include <cstdint>

#include "filters/pcf.h"

namespace obscura {

/// One kernel of every sample, on a level of the sample's own. Bit i of a mask word is sample 16 * group + i.
struct alignas(64) BoxesOnLevel {
    std::uint32_t reading[block_groups];  ///< samples whose kernel meets the map; the others' entries are
                                          ///< unspecified
    std::int32_t level[block_samples];    ///< squares of 2^level texels
    std::int32_t x0[block_samples], y0[block_samples];  ///< first square, on the map
    std::int32_t x1[block_samples], y1[block_samples];  ///< last square, on the map
};

/// PcfFilter::pcf reads one kernel, of texels. Hierarchical: the finer and, where two levels are blended, the
/// coarser.
struct alignas(64) KernelBoxes {
    std::int32_t view[block_samples];
    BoxesOnLevel kernel[2];
};

/// The light needs no stored depths. Taps of points and spots are clamped into their map, those of parallel
/// light outside of it are left out.
#define OBSCURA_KERNEL_BOXES \
    void kernel_boxes(const SurfaceBlock& surface, const PcfLight& light, KernelBoxes& boxes) noexcept;
namespace ref {
OBSCURA_KERNEL_BOXES
}
namespace sse2 {
OBSCURA_KERNEL_BOXES
}
namespace avx2 {
OBSCURA_KERNEL_BOXES
}
namespace avx512bw {
OBSCURA_KERNEL_BOXES
}
#undef OBSCURA_KERNEL_BOXES

}  // namespace obscura
