#pragma once
// Percentage-closer filtering of shadow maps that are serialised trees: what filters/pcf.h defines, the
// stored depths found by descents. POD: kernels include this.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.3: the taps of a kernel go down together to their lowest common
// node, which the leading zeros of their XORed coordinates name; where the descent ends on the way, one value
// holds for all of them, and only the nearest and the deepest of the taps' own depths are compared. From
// there on, each tap begins where its way parts from another's.

#include <cstdint>

#include "filters/pcf.h"

namespace obscura {

/// Both give the same bits, those of pcf_block() on the dense map of the tree's values. All views of the
/// light must have trees.
/// tree_pcf_block: shared descents, also between neighbouring samples; what pcf_block() calls.
/// naive_tree_pcf_block: every tap of every sample walks from the root.
#define OBSCURA_TREE_PCF_BLOCK                                                                           \
    void tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept; \
    void naive_tree_pcf_block(const SurfaceBlock& surface, const PcfLight& light, float* visibility) noexcept;
namespace ref {
OBSCURA_TREE_PCF_BLOCK
}
namespace sse2 {
OBSCURA_TREE_PCF_BLOCK
}
namespace avx2 {
OBSCURA_TREE_PCF_BLOCK
}
namespace avx512bw {
OBSCURA_TREE_PCF_BLOCK
}
#undef OBSCURA_TREE_PCF_BLOCK

}  // namespace obscura
