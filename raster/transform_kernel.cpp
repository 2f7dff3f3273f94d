// Transform and snap, sixteen vertices at a time. See transform_ref.cpp for the meaning of each step.

#include "core/simd.h"
#include "raster/map_vertex.h"
#include "raster/record.h"
#include "raster/transform.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Rows {
    F64 x, y, z;
    OBSCURA_INLINE F64 operator()(const double (&m)[4]) const {
        return (splat(m[0]) * x + splat(m[1]) * y) + (splat(m[2]) * z + splat(m[3]));
    }
};

/// Lanes i of the result: xyz[3 * (first + i) + axis].
OBSCURA_INLINE F64 axis_of(const float* xyz, const I32& index) {
    return to_f64(gather(xyz, index));
}

OBSCURA_INLINE Mask at_least(const F64& a, double bound) {
    return greater_equal(a, splat(bound));
}
OBSCURA_INLINE Mask at_most(const F64& a, double bound) {
    return greater_equal(splat(bound), a);
}

void sixteen(const float* xyz, const I32& index, const VertexMap& map, I32 (&out)[4]) {
    const Rows row{axis_of(xyz, index), axis_of(xyz + 1, index), axis_of(xyz + 2, index)};
    const F64 w = row(map.m[3]);
    F64 X = row(map.m[0]), Y = row(map.m[1]), Z = row(map.m[2]);
    if (map.perspective) {
        const F64 inv = splat(1.0) / w;
        X = X * inv;
        Y = Y * inv;
        Z = Z * inv;
    }
    const Mask ahead = map.perspective ? at_least(w, map.near_w) : at_least(Z, 0.0);
    const Mask on_map =
        (at_least(X, map.low_x) & at_most(X, map.high_x)) & (at_least(Y, map.low_y) & at_most(Y, map.high_y));
    const Mask usable = ahead & on_map;

    const I32 zero = splat(std::int32_t{0});
    const F64 one = splat(static_cast<double>(subtexel_one));
    out[0] = select(usable, round_to_i32(X * one), zero);
    out[1] = select(usable, round_to_i32(Y * one), zero);
    out[2] = bitcast_i32(max(min(to_f32(Z), splat(map.max_depth)), splat(map.min_depth)));
    out[3] = select(ahead, zero, splat(clip_near)) | select(on_map, zero, splat(clip_guard));
}

}  // namespace

void transform_vertices(const float* xyz, std::size_t begin, std::size_t end, const VertexMap& map,
                        MapVertex* out) noexcept {
    for (std::size_t i = begin; i < end; i += lanes) {
        // The last group repeats its last vertex, so that no lane reads past the end.
        const std::size_t left = end - i;
        const I32 last = splat(static_cast<std::int32_t>(left < lanes ? left - 1 : lanes - 1));
        const I32 index = min(lane_index(), last) * splat(std::int32_t{3});
        I32 result[4];
        sixteen(xyz + 3 * i, index, map, result);

        alignas(64) std::int32_t rows[4][lanes];
        for (int k = 0; k < 4; ++k)
            store(rows[k], result[k]);
        for (std::size_t k = 0; k < lanes && k < left; ++k) {
            MapVertex& v = out[i + k];
            v.x = rows[0][k];
            v.y = rows[1][k];
            __builtin_memcpy(&v.z, &rows[2][k], sizeof v.z);
            v.clip = rows[3][k];
        }
    }
}

}  // namespace obscura::OBSCURA_ISA
