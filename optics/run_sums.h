#pragma once
// The first of two one-dimensional transforms, in closed form: each run of a row adds the difference of its
// two ends, whatever its length. Sixteen frequencies at a time, looked up in a table of phases of all edges.
// POD.

#include <cstdint>

#include "optics/field/run_table.h"

namespace obscura {

/// Phases of the edges x = 0 to count - 1 for sixteen frequencies: base[x] * step[16 x + lane], complex.
struct PhaseSeeds {
    int count = 0;
    const float *base_re = nullptr, *base_im = nullptr;
    const float *step_re = nullptr, *step_im = nullptr;
};

/// edge_phases16: table re[16 x + lane], im likewise (im only, when re is null).
/// run_sums16: out[16 y + lane] = sum over the runs of row y of weight (table[begin] - table[end]), in order.
#define OBSCURA_RUN_SUMS                                                        \
    void edge_phases16(const PhaseSeeds& seeds, float* re, float* im) noexcept; \
    void run_sums16(const RunTable& runs, const float* table, float* out) noexcept;
namespace ref {
OBSCURA_RUN_SUMS
}
namespace sse2 {
OBSCURA_RUN_SUMS
}
namespace avx2 {
OBSCURA_RUN_SUMS
}
namespace avx512bw {
OBSCURA_RUN_SUMS
}
#undef OBSCURA_RUN_SUMS

}  // namespace obscura
