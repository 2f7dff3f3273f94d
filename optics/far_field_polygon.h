#pragma once
// The polygon transform's inner loop. POD: kernels include this.

#include <cstdint>

#include "optics/field/phasor.h"

namespace obscura {

/// Closed loops; vertices relative to their own loop's centre. The tables hold phasors e^(-2 pi i u x) of
/// vertices and centres at sixteen frequencies u, element (i, l) at 16 i + l, and e^(-2 pi i v y) at one
/// frequency v, element i at 16 i.
struct PolygonLoops {
    const std::int32_t* begin = nullptr;  ///< loop k has vertices [begin[k], begin[k + 1])
    const double* x = nullptr;
    const double* y = nullptr;
    int loops = 0;
    const float *vertex_u_re = nullptr, *vertex_u_im = nullptr;
    const float *vertex_v_re = nullptr, *vertex_v_im = nullptr;
    const float *centre_u_re = nullptr, *centre_u_im = nullptr;
    const float *centre_v_re = nullptr, *centre_v_im = nullptr;
};

/// Frequencies this near to 0 count as 0.
inline constexpr double polygon_lowest = 1e-20;

/// The transform at u = ramp's samples offset to offset + 15 and at v: sixteen values.
#define OBSCURA_POLYGON                                                                            \
    void polygon_row(const PolygonLoops& polygon, const FrequencyRamp& ramp, int offset, double v, \
                     float* re, float* im) noexcept;
namespace ref {
OBSCURA_POLYGON
}
namespace sse2 {
OBSCURA_POLYGON
}
namespace avx2 {
OBSCURA_POLYGON
}
namespace avx512bw {
OBSCURA_POLYGON
}
#undef OBSCURA_POLYGON

}  // namespace obscura
