#include "app/frame/exact_tile.h"

#include <algorithm>

#include "app/frame/surface_light.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "core/vec_arrays.h"
#include "raster/depth_tile.h"

namespace obscura {

ExactTile::ExactTile(std::size_t lights, bool sent)
    : depth_(room),
      gx_(room),
      gy_(room),
      gz_(room),
      px_(room),
      py_(room),
      pz_(room),
      triangle_(room),
      of_point_(room),
      face_(room),
      covered_(room / 16),
      thin_(room / 16),
      lit_(lights * room / 16),
      before_(sent ? lights * tile_samples : 0),
      before_m_(sent ? lights * tile_samples : 0),
      work_(room) {}

void ExactTile::keep_block(const TileScene& scene, int k, int count, int first_row,
                           const SurfaceBlock& block) {
    double px[block_samples], py[block_samples], pz[block_samples];
    std::uint32_t face[block_samples];
    exact_positions(block, *scene.mesh, {scene.rays.eye[0], scene.rays.eye[1], scene.rays.eye[2]}, px, py, pz,
                    face);
    for (int i = 0; i < block_samples; ++i) {
        const std::uint32_t bit = block.covered[i / 16] >> (i % 16) & 1u;
        if (bit == 0) continue;
        const auto to = static_cast<std::size_t>(
            exact_point_index(k, count, i % frame_tile_side, first_row + i / frame_tile_side));
        px_[to] = px[i];
        py_[to] = py[i];
        pz_[to] = pz[i];
        gx_[to] = block.gx[i];
        gy_[to] = block.gy[i];
        gz_[to] = block.gz[i];
        face_[to] = face[i];
        of_point_[to] = block.triangle[i];
        covered_[to / 16] |= 1u << (to % 16);
        thin_[to / 16] |= (block.thin[i / 16] >> (i % 16) & 1u) << (to % 16);
    }
}

void ExactTile::begin(int count) {
    count_ = count;
    std::fill_n(covered_.data(), points_of(count) / 16, 0u);
    std::fill_n(thin_.data(), points_of(count) / 16, 0u);
}

void ExactTile::run(const TileScene& scene, int column, int row, int first, int count, int first_row,
                    int end_row, Isa isa, TileWork& work) {
    begin(count);
    for (int k = 0; k < count; ++k) {
        const auto sample = static_cast<std::size_t>(first) + static_cast<std::size_t>(k);
        const TileRect tile = tile_visibility(scene, column, row, scene.pattern[sample], isa, work);
        std::copy_n(work.depth, tile_samples, depth_.data() + points_of(k));
        std::copy_n(work.triangle, tile_samples, triangle_.data() + points_of(k));
        for (int block = first_row; block < end_row; block += block_rows) {
            block_geometry(scene, tile, block, isa, work);
            keep_block(scene, k, count, block, work.surface);
        }
    }
    const ExactPoints all = points();
    if (scene.pass != nullptr && scene.pass->soft != nullptr) {
        const Stopwatch watch;
        work_.shadows(all, *scene.pass->soft, isa, lit_.data(), room / 16, work.exact_counts);
        if (!work.lookup_s.empty()) work.lookup_s[0] += watch.seconds();
        return;
    }
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        if (!scene.lights[l].exact) continue;
        const Stopwatch watch;
        const ExactLight& light = *scene.lights[l].exact;
        std::uint32_t* lit = lit_.data() + l * (room / 16);
        if (scene.gathers()) {
            CHECK(count == 1, "samples of a pass are taken one by one");
            std::uint32_t* before = before_.data() + l * tile_samples;
            std::fill_n(before, tile_samples, no_triangle);
            work_.nearest(all, light, isa, lit, {before, before_m_.data() + l * tile_samples},
                          work.exact_counts);
        } else {
            work_.shadows(all, light, isa, lit, work.exact_counts);
        }
        if (!work.lookup_s.empty()) work.lookup_s[l] += watch.seconds();
    }
}

ExactPoints ExactTile::points() const {
    return {static_cast<std::int32_t>(points_of(count_)),
            px_.data(),
            py_.data(),
            pz_.data(),
            gx_.data(),
            gy_.data(),
            gz_.data(),
            face_.data(),
            of_point_.data(),
            covered_.data(),
            thin_.data()};
}

float ExactTile::widest_penumbra(const ExactLight& light, const ExactSpread& spread, float stop_px, Isa isa) {
    ExactCounts counts;
    return work_.widest_penumbra(points(), light, spread, stop_px, isa, counts);
}

void ExactTile::restore(int k, TileWork& work) const {
    std::copy_n(depth_.data() + points_of(k), tile_samples, work.depth);
    std::copy_n(triangle_.data() + points_of(k), tile_samples, work.triangle);
}

void ExactTile::darken(std::size_t light, int k, int first_row, float* visibility) const {
    const std::uint32_t* reached = lit(light);
    for (int i = 0; i < block_samples; ++i) {
        const int at = exact_point_index(k, count_, i % frame_tile_side, first_row + i / frame_tile_side);
        const bool is_lit = (reached[at / 16] >> (at % 16) & 1u) != 0;
        visibility[i] = is_lit ? visibility[i] : 0.0f;
    }
}

void ExactTile::gather(const TileScene& scene, std::size_t light, int first_row, ShadeSent& sent) const {
    const TileLight& part = scene.lights[light];
    const Vec3d to_light = to_double(vec(part.exact->to_light));
    // A direction stands for a part of the sky; with strata it is asked for more than its own.
    const auto solid_angle = static_cast<float>(part.solid_angle_sr),
               cone = solid_angle / static_cast<float>(scene.pass->stride);
    for (int i = 0; i < block_samples; ++i) {
        const auto at = static_cast<std::size_t>(
            exact_point_index(0, 1, i % frame_tile_side, first_row + i / frame_tile_side));
        const std::uint32_t triangle = before_[light * tile_samples + at];
        Vec3f arriving{0, 0, 0};
        if (triangle != no_triangle) {
            arriving = sent_radiance(*scene.casters, *scene.sent, triangle, {px_[at], py_[at], pz_[at]},
                                     to_light, before_m_[light * tile_samples + at], cone) *
                       solid_angle;
        }
        sent.r[i] = arriving.x;
        sent.g[i] = arriving.y;
        sent.b[i] = arriving.z;
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
    return std::make_unique<ExactTile>(lights_, sent_);
}

void ExactTilePool::give_back(std::unique_ptr<ExactTile> tile) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(tile));
}

std::int64_t exact_tile_bytes(std::size_t lights, bool sent) {
    constexpr std::int64_t samples = std::int64_t{frame_tile_side} * frame_tile_side * exact_samples_together;
    // Depth, normal, triangle (twice), face and position of a sample, two masks and one for each light, a
    // word for sixteen of them; 37 bytes to look it up.
    return samples * (7 * 4 + 3 * 8 + 37) + samples / 4 * static_cast<std::int64_t>(2 + lights) +
           (sent ? samples / exact_samples_together * 8 * static_cast<std::int64_t>(lights) : 0);
}

}  // namespace obscura
