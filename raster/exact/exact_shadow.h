#pragma once
// Exact shadows of many points, and of one with all that makes it.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/morton.h"
#include "raster/exact/exact.h"
#include "raster/exact/exact_nearest.h"
#include "raster/exact/exact_soft.h"
#include "raster/gbuffer.h"

namespace obscura {

/// Working memory of exact shadows: 37 bytes a point.
class ExactWork {
  public:
    explicit ExactWork(std::size_t most_points);

    /// Bit i % 16 of lit[i / 16]: whether light reaches point i; not of points that face away. At most
    /// `most_points` points. Kernels take points as they come where these stand together before the light;
    /// the others, and all of them with `ref`, are samples that are taken along a Morton curve on the light's
    /// grid. The same bits for any isa; counts are the same for all but `ref`, which asks sample by sample.
    void shadows(const ExactPoints& points, const ExactLight& light, Isa isa, std::uint32_t* lit,
                 ExactCounts& counts);

    /// The same for each part of a light with a size: part p's bits are lit[p * stride + i / 16].
    void shadows(const ExactPoints& points, const ExactSoft& light, Isa isa, std::uint32_t* lit,
                 std::size_t stride, ExactCounts& counts);

    /// shadows() of parallel light, and for each point that something darkens the nearest that does. Others
    /// keep what hits has for them.
    void nearest(const ExactPoints& points, const ExactLight& light, Isa isa, std::uint32_t* lit,
                 const ExactHits& hits, ExactCounts& counts);

    /// Width of the widest penumbra among the points, pixels, when it is less than stop_px; else that or
    /// more. `light`: the middle of a light that has any position.
    float widest_penumbra(const ExactPoints& points, const ExactLight& light, const ExactSpread& spread,
                          float stop_px, Isa isa, ExactCounts& counts);

    /// Of the last call: these samples, and in which order; sixteen neighbours of it were taken together.
    const ExactSamples& samples() const { return samples_; }
    std::span<const std::uint32_t> order() const {
        return {order_.data(), static_cast<std::size_t>(samples_.count)};
    }

  private:
    void sort_samples(int views);
    void sort_digit(int low);

    ExactSamples samples_;
    Buffer<std::int32_t> x_, y_;
    Buffer<float> z_, rounding_;
    Buffer<std::uint32_t> point_, order_, other_order_, key_, other_key_;
    Buffer<std::uint8_t> view_;
};

/// Where sample k of `count` of pixel (x, y) of a tile stands among the tile's points: along a Morton curve
/// of the pixels (x, y < 256), a pixel's samples together, so that neighbours in the list are neighbours in
/// the picture.
constexpr int exact_point_index(int k, int count, int x, int y) {
    return static_cast<int>(morton_code<8>(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))) *
               count +
           k;
}

/// Positions of a block's samples in doubles, each on the plane of its face, and these faces: block_samples
/// of each. Positions in the block are floats, relative to the eye.
void exact_positions(const SurfaceBlock& block, const Mesh& mesh, Vec3d eye, double* px, double* py,
                     double* pz, std::uint32_t* face);

namespace ref {

/// What a point's shadow is, found by asking every triangle.
struct ExactShadow {
    bool asks = false;  ///< false: nothing is there, or it faces away from the light
    bool lit = false;
    int view = 0;
    bool on_map = false;        ///< false: lit without looking, before the near plane or beyond what casts
    std::int32_t x = 0, y = 0;  ///< on the light's grid
    float rounding_m = 0;       ///< metres that are uncertain of the point's place
    // In shadow only:
    std::int64_t triangles = 0;  ///< how many darken it
    std::uint32_t triangle = 0;  ///< of these, the one that stands nearest to the point
    double distance_m = 0;       ///< to it, along the light
    double behind_m = 0;         ///< how far the point lies behind its plane, at right angles to that
};
ExactShadow exact_shadow(const ExactPoints& points, const ExactLight& light, int at);

/// Whether triangle i of the point's view darkens it.
bool exact_darkens(const ExactPoints& points, const ExactLight& light, int at, std::size_t i);

}  // namespace ref
}  // namespace obscura
