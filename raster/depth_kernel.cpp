// Nearest depth of every sample of a tile, sixteen samples at a time. See depth_ref.cpp for what it computes.

#include "core/simd.h"
#include "raster/depth_tile.h"
#include "raster/tile_walk.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct NearestDepth {
    float* depth;
    OBSCURA_INLINE void covered(std::int32_t at, const F32& z) {
        store(depth + at, min(z, load(depth + at)));
    }
    OBSCURA_INLINE void partial(std::int32_t at, const Mask& inside, const F32& z) {
        const F32 old = load(depth + at);
        store(depth + at, select(inside, min(z, old), old));
    }
};

struct NearestTriangle {
    float* depth;
    std::int32_t* triangle;
    I32 id;
    OBSCURA_INLINE void take(std::int32_t at, const Mask& nearer, const F32& z, const F32& old) {
        if (none(nearer)) return;
        store(depth + at, select(nearer, z, old));
        store(triangle + at, select(nearer, id, load(triangle + at)));
    }
    OBSCURA_INLINE void covered(std::int32_t at, const F32& z) {
        const F32 old = load(depth + at);
        take(at, less(z, old), z, old);
    }
    OBSCURA_INLINE void partial(std::int32_t at, const Mask& inside, const F32& z) {
        const F32 old = load(depth + at);
        take(at, inside & less(z, old), z, old);
    }
};

}  // namespace

void depth_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, float* depth) noexcept {
    NearestDepth nearest{depth};
    for (std::size_t i = 0; i < count; ++i)
        walk_triangle(records[list[i]], tile, nearest);
}

void visibility_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                     const TileRect& tile, float* depth, std::uint32_t* triangle) noexcept {
    NearestTriangle nearest{depth, reinterpret_cast<std::int32_t*>(triangle), splat(std::int32_t{0})};
    for_each_listed(records, list, count, [&](const TriangleRecord& t) {
        nearest.id = splat(static_cast<std::int32_t>(t.triangle));
        walk_triangle(t, tile, nearest);
    });
}

}  // namespace obscura::OBSCURA_ISA
