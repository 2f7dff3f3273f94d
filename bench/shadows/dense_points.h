#pragma once
// Bare lookups in a dense map, for comparison with those in trees (hierarchy/codes/query.h). POD: kernels
// include this.

#include <cstdint>

#include "hierarchy/codes/query.h"

namespace obscura {

/// dense_visibility: as visibility() of a tree, but from a size x size map (a power of two) in the blocks of
/// StoredDepths, with one gather for sixteen points; size up to 16384.
#define OBSCURA_DENSE_POINTS                                                               \
    void dense_visibility(const float* stored, std::int32_t size, const MapPoints& points, \
                          std::uint16_t* lit) noexcept;
namespace sse2 {
OBSCURA_DENSE_POINTS
}
namespace avx2 {
OBSCURA_DENSE_POINTS
}
namespace avx512bw {
OBSCURA_DENSE_POINTS
}
namespace ref {
OBSCURA_DENSE_POINTS
}
#undef OBSCURA_DENSE_POINTS

}  // namespace obscura
