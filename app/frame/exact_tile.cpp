#include "app/frame/exact_tile.h"

#include <algorithm>

#include "core/stopwatch.h"

namespace obscura {

ExactTile::ExactTile(std::size_t lights)
    : depth_(room),
      gx_(room),
      gy_(room),
      gz_(room),
      px_(room),
      py_(room),
      pz_(room),
      triangle_(room),
      face_(room),
      covered_(room / 16),
      thin_(room / 16),
      lit_(lights * room / 16),
      work_(room) {}

void ExactTile::keep_block(const TileScene& scene, int k, int first_row, const SurfaceBlock& block) {
    const std::size_t to = place(k, first_row);
    std::copy_n(block.triangle, block_samples, triangle_.data() + to);
    std::copy_n(block.gx, block_samples, gx_.data() + to);
    std::copy_n(block.gy, block_samples, gy_.data() + to);
    std::copy_n(block.gz, block_samples, gz_.data() + to);
    std::copy_n(block.covered, block_groups, covered_.data() + to / 16);
    std::copy_n(block.thin, block_groups, thin_.data() + to / 16);
    exact_positions(block, *scene.mesh, {scene.rays.eye[0], scene.rays.eye[1], scene.rays.eye[2]},
                    px_.data() + to, py_.data() + to, pz_.data() + to, face_.data() + to);
}

void ExactTile::run(const TileScene& scene, int column, int row, int first, int count, int first_row,
                    int end_row, Isa isa, TileWork& work) {
    for (int k = 0; k < count; ++k) {
        const TileRect tile = tile_visibility(scene, column, row,
                                              scene.pattern[static_cast<std::size_t>(first + k)], isa, work);
        std::copy_n(work.depth, tile_samples, depth_.data() + place(k, 0));
        std::copy_n(work.triangle, tile_samples, triangle_.data() + place(k, 0));
        std::fill_n(covered_.data() + place(k, 0) / 16, tile_samples / 16, 0u);
        for (int block = first_row; block < end_row; block += block_rows) {
            block_geometry(scene, tile, block, isa, work);
            keep_block(scene, k, block, work.surface);
        }
    }
    const ExactPoints all = points(count);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        if (!scene.lights[l].exact) continue;
        const Stopwatch watch;
        work_.shadows(all, *scene.lights[l].exact, isa, lit_.data() + l * (room / 16), work.exact_counts);
        if (!work.lookup_s.empty()) work.lookup_s[l] += watch.seconds();
    }
}

ExactPoints ExactTile::points(int count) const {
    ExactPoints points{};
    points.count = static_cast<std::int32_t>(place(count, 0));
    points.px = px_.data();
    points.py = py_.data();
    points.pz = pz_.data();
    points.gx = gx_.data();
    points.gy = gy_.data();
    points.gz = gz_.data();
    points.face = face_.data();
    points.triangle = triangle_.data();
    points.covered = covered_.data();
    points.thin = thin_.data();
    return points;
}

void ExactTile::restore(int k, TileWork& work) const {
    std::copy_n(depth_.data() + place(k, 0), tile_samples, work.depth);
    std::copy_n(triangle_.data() + place(k, 0), tile_samples, work.triangle);
}

void ExactTile::darken(std::size_t light, int k, int first_row, float* visibility) const {
    const std::uint32_t* lit = lit_.data() + light * (room / 16) + place(k, first_row) / 16;
    for (int i = 0; i < block_samples; ++i) {
        const bool is_lit = (lit[i / 16] >> (i % 16) & 1u) != 0;
        visibility[i] = is_lit ? visibility[i] : 0.0f;
    }
}

std::unique_ptr<ExactTile> ExactTilePool::take() {
    {
        const std::scoped_lock lock(mutex_);
        if (!free_.empty()) {
            auto tile = std::move(free_.back());
            free_.pop_back();
            return tile;
        }
    }
    return std::make_unique<ExactTile>(lights_);
}

void ExactTilePool::give_back(std::unique_ptr<ExactTile> tile) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(tile));
}

std::int64_t exact_tile_bytes(std::size_t lights) {
    constexpr std::int64_t samples = std::int64_t{frame_tile_side} * frame_tile_side * exact_samples_together;
    // Depth, normal, triangle, face and position of a sample, two masks, a bit for each light; 37 bytes to
    // look it up.
    return samples * (6 * 4 + 3 * 8 + 37) + samples / 8 * static_cast<std::int64_t>(4 + 2 * lights);
}

}  // namespace obscura
