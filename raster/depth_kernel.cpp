// Nearest depth of every sample of a tile, sixteen samples at a time. See depth_ref.cpp for what it computes.

#include "core/simd.h"
#include "raster/depth_tile.h"
#include "raster/tile_walk.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Greatest depth of each block of 16 x 16 samples, now and then brought up to date: what lies behind it
/// everywhere is hidden. Depths only fall, so an old bound is still a bound.
///
/// N. Greene, M. Kass, G. Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993, one level of it.
struct BlockBounds {
    static constexpr std::int32_t side = 16, most_blocks = depth_tile_side / side;
    /// Bringing it up to date costs as much as some ten small triangles.
    static constexpr std::size_t interval = 64;
    float farthest[most_blocks * most_blocks];

    explicit BlockBounds(float start) {
        for (float& f : farthest)
            f = start;
    }
    void update(const float* depth, const TileRect& tile) {
        for (std::int32_t r0 = 0; r0 < tile.height; r0 += side) {
            for (std::int32_t c0 = 0; c0 < tile.width; c0 += side) {
                F32 far = load(depth + r0 * tile.width + c0);
                for (std::int32_t r = r0 + 1; r < least(r0 + side, tile.height); ++r) {
                    far = max(far, load(depth + r * tile.width + c0));
                }
                alignas(64) float all[lanes];
                store(all, far);
                float& bound = farthest[r0 / side * most_blocks + c0 / side];
                bound = all[0];
                for (const float f : all)
                    bound = f > bound ? f : bound;
            }
        }
    }
    OBSCURA_INLINE bool hide(const TriangleRecord& t, const SampleBox& box) const {
        for (std::int32_t r = box.r0 / side; r <= box.r1 / side; ++r) {
            for (std::int32_t c = box.c0 / side; c <= box.c1 / side; ++c) {
                if (t.zmin < farthest[r * most_blocks + c]) return false;
            }
        }
        return true;
    }
};

struct NearestDepth {
    float* depth;
    BlockBounds bounds;
    OBSCURA_INLINE bool hidden(const TriangleRecord& t, const SampleBox& box) const {
        return bounds.hide(t, box);
    }
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
    BlockBounds bounds;
    OBSCURA_INLINE bool hidden(const TriangleRecord& t, const SampleBox& box) const {
        return bounds.hide(t, box);
    }
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

/// Walks the list; bounds are brought up to date on the way where the list is long enough to gain from it.
template <class Nearest, class Before>
OBSCURA_INLINE void walk_list(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                              const TileRect& tile, Nearest& nearest, Before&& before) {
    std::size_t until_update = BlockBounds::interval;
    for_each_listed(records, list, count, [&](const TriangleRecord& t) {
        if (until_update-- == 0) {
            nearest.bounds.update(nearest.depth, tile);
            until_update = BlockBounds::interval;
        }
        before(t);
        walk_triangle(t, tile, nearest);
    });
}

constexpr float beyond_all = 3.4e38f;

}  // namespace

void depth_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                const TileRect& tile, float* depth) noexcept {
    NearestDepth nearest{depth, BlockBounds(beyond_all)};
    walk_list(records, list, count, tile, nearest, [](const TriangleRecord&) {});
}

void visibility_tile(const TriangleRecord* records, const std::uint32_t* list, std::size_t count,
                     const TileRect& tile, float* depth, std::uint32_t* triangle) noexcept {
    NearestTriangle nearest{depth, reinterpret_cast<std::int32_t*>(triangle), splat(std::int32_t{0}),
                            BlockBounds(beyond_all)};
    walk_list(records, list, count, tile, nearest,
              [&](const TriangleRecord& t) { nearest.id = splat(static_cast<std::int32_t>(t.triangle)); });
}

}  // namespace obscura::OBSCURA_ISA
