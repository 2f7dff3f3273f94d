#pragma once
// Exact shadows of one tile: the samples of all its pixels are found first, and then looked for by each light
// in the order in which they lie before it.

#include <memory>
#include <mutex>
#include <vector>

#include "app/frame/tile.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {

/// Samples of a pixel that are taken together: more of them lie closer before the light, and take more
/// memory.
constexpr int exact_samples_together = 4;

/// Up to exact_samples_together samples of every pixel of a tile, as points in the order of
/// exact_point_index().
class ExactTile {
  public:
    /// `sent`: of lights that are parts of a sky, what hides them is wanted, too; of one sample at a time.
    explicit ExactTile(std::size_t lights, bool sent = false);

    /// Stages 1 and 2 of the tile for samples [first, first + count) of the pattern, rows [first_row,
    /// end_row) (whole blocks), then the shadows of the lights that have exact ones.
    void run(const TileScene& scene, int column, int row, int first, int count, int first_row, int end_row,
             Isa isa, TileWork& work);

    /// What run() found of stage 1 for its k-th sample, into work.depth and work.triangle.
    void restore(int k, TileWork& work) const;

    // Parts of run(): forgets what there was and expects `count` samples of every pixel; keeps a block's
    // surfaces as points of the k-th of them, from first_row on; and the points.
    void begin(int count);
    void keep_block(const TileScene& scene, int k, int count, int first_row, const SurfaceBlock& block);
    ExactPoints points() const;

    /// Width of the widest penumbra among the points, up to stop_px.
    float widest_penumbra(const ExactLight& light, const ExactSpread& spread, float stop_px, Isa isa);

    /// Bits, as ExactPoints' masks, of the points that run() found the light to reach.
    const std::uint32_t* lit(std::size_t light) const { return lit_.data() + light * (room / 16); }

    /// Puts 0 for those of a block's samples that the light does not reach: of the k-th sample, from
    /// first_row on.
    void darken(std::size_t light, int k, int first_row, float* visibility) const;

    /// What surfaces send to those samples from where they hide a part of the sky, 0 to others: irradiance on
    /// a surface that faces it.
    void gather(const TileScene& scene, std::size_t light, int first_row, ShadeSent& sent) const;

  private:
    static constexpr std::size_t tile_samples = std::size_t{frame_tile_side} * frame_tile_side;
    static constexpr std::size_t room = tile_samples * exact_samples_together;
    static std::size_t points_of(int samples) { return static_cast<std::size_t>(samples) * tile_samples; }

    Buffer<float> depth_, gx_, gy_, gz_;
    Buffer<double> px_, py_, pz_;
    int count_ = 0;
    Buffer<std::uint32_t> triangle_, of_point_, face_, covered_, thin_, lit_;
    Buffer<std::uint32_t> before_;  ///< of each light: the nearest triangle before the points,
    Buffer<float> before_m_;        ///< and how far off
    ExactWork work_;
};

/// Memory of tiles, used again by whichever is rendered next.
class ExactTilePool {
  public:
    explicit ExactTilePool(std::size_t lights, bool sent = false) : lights_(lights), sent_(sent) {}
    std::unique_ptr<ExactTile> take();
    void give_back(std::unique_ptr<ExactTile> tile);

  private:
    std::size_t lights_;
    bool sent_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<ExactTile>> free_;
};

/// Bytes of one tile's.
std::int64_t exact_tile_bytes(std::size_t lights, bool sent = false);

}  // namespace obscura
