// Transform and snap, one vertex at a time.

#include <cmath>

#include "raster/map_vertex.h"
#include "raster/record.h"
#include "raster/transform.h"

namespace obscura::ref {

void transform_vertices(const float* xyz, std::size_t begin, std::size_t end, const VertexMap& map,
                        MapVertex* out) noexcept {
    for (std::size_t i = begin; i < end; ++i) {
        const double x = static_cast<double>(xyz[3 * i]), y = static_cast<double>(xyz[3 * i + 1]),
                     z = static_cast<double>(xyz[3 * i + 2]);
        const auto row = [&](const double(&m)[4]) { return (m[0] * x + m[1] * y) + (m[2] * z + m[3]); };
        const double w = row(map.m[3]);
        const double inv = map.perspective ? 1.0 / w : 1.0;
        const double X = row(map.m[0]) * inv, Y = row(map.m[1]) * inv, Z = row(map.m[2]) * inv;

        // Before the near plane nothing else can be said of a vertex; the clipper works on homogeneous ones.
        MapVertex v;
        const bool before_near = map.perspective ? !(w >= map.near_w) : !(Z >= 0.0);
        const bool off_map = !(X >= map.low_x && X <= map.high_x && Y >= map.low_y && Y <= map.high_y);
        v.clip = (before_near ? clip_near : 0) | (off_map ? clip_guard : 0);
        if (v.clip == 0) {
            // Nearest fixed-point position, ties to even, as the conversion instruction rounds.
            v.x = static_cast<std::int32_t>(std::nearbyint(X * subtexel_one));
            v.y = static_cast<std::int32_t>(std::nearbyint(Y * subtexel_one));
        }
        const float depth = static_cast<float>(Z);
        const float low = depth < map.max_depth ? depth : map.max_depth;
        v.z = low > map.min_depth ? low : map.min_depth;
        out[i] = v;
    }
}

}  // namespace obscura::ref
