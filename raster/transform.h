#pragma once
// Vertices into map space, sixteen at a time: the first hot loop (ref, sse2, avx2, avx512bw).

#include <cstddef>
#include <cstdint>

namespace obscura {

struct MapVertex;

/// What the loop needs of a View. Plain, so that kernels can read it.
struct VertexMap {
    double m[4][4];                       ///< View::to_map
    double near_w;                        ///< clip when w < near_w
    double low_x, high_x, low_y, high_y;  ///< guard band, texels
    float min_depth, max_depth;
    bool perspective;
};

#define OBSCURA_TRANSFORM_VERTICES                                                                      \
    void transform_vertices(const float* xyz, std::size_t begin, std::size_t end, const VertexMap& map, \
                            MapVertex* out) noexcept;
namespace ref {
OBSCURA_TRANSFORM_VERTICES
}
namespace sse2 {
OBSCURA_TRANSFORM_VERTICES
}
namespace avx2 {
OBSCURA_TRANSFORM_VERTICES
}
namespace avx512bw {
OBSCURA_TRANSFORM_VERTICES
}
#undef OBSCURA_TRANSFORM_VERTICES

}  // namespace obscura
