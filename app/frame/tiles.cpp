#include "app/frame/tiles.h"

#include <algorithm>
#include <mutex>

#include "app/frame/channels.h"
#include "app/frame/exact_tile.h"
#include "core/parallel.h"

namespace obscura {
namespace {

/// Tells `progress` about once per half percent, one call at a time.
class ProgressMeter {
  public:
    ProgressMeter(const std::function<void(double)>& progress, std::size_t tiles)
        : progress_(progress), tiles_(tiles), step_(std::max<std::size_t>(tiles / 200, 1)) {}
    void tile_done() {
        if (!progress_) return;
        const std::lock_guard lock(mutex_);
        ++done_;
        if (done_ % step_ == 0 || done_ == tiles_) {
            progress_(static_cast<double>(done_) / static_cast<double>(tiles_));
        }
    }

  private:
    const std::function<void(double)>& progress_;
    std::size_t tiles_, step_, done_ = 0;
    std::mutex mutex_;
};

/// The tiles that the frame's pixels lie in.
struct TileGrid {
    int column0, row0, columns, rows;
};

TileGrid grid_of(const TileScene& scene, const Frame& frame) {
    const int x0 = frame.x0 - scene.bins->region.x0, y0 = frame.y0 - scene.bins->region.y0;
    const int column0 = x0 / frame_tile_side, row0 = y0 / frame_tile_side;
    return {column0, row0, (x0 + frame.width - 1) / frame_tile_side - column0 + 1,
            (y0 + frame.height - 1) / frame_tile_side - row0 + 1};
}

}  // namespace

void size_frame(const Region& crop, const FrameOptions& options, Frame& frame) {
    frame.x0 = crop.x0;
    frame.y0 = crop.y0;
    frame.width = crop.width;
    frame.height = crop.height;
    frame.radiance.reset(crop.width, crop.height);
    // A channel is as large as the frame when it is wanted, else empty.
    for_each_channel([&]<class T>(const FrameChannel<T>& row) {
        if (!row.by_tiles) return;
        frame.*row.pixels = options.*row.wanted ? Image<T>(frame.width, frame.height) : Image<T>();
    });
}

std::size_t tile_count(const TileScene& scene, const Frame& frame) {
    const TileGrid grid = grid_of(scene, frame);
    return static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
}

bool walk_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, const Frame& frame,
                const std::function<void(std::size_t, const TilePlace&)>& visit) {
    const TileGrid grid = grid_of(scene, frame);
    const std::size_t tiles = tile_count(scene, frame);
    ProgressMeter meter(options.progress, tiles);
    std::atomic<bool> skipped = false;
    parallel_for(tiles, exec, [&](std::size_t i) {
        if (stopped(options.cancel)) {
            skipped = true;
            return;
        }
        TilePlace place;
        place.column = grid.column0 + static_cast<int>(i) % grid.columns;
        place.row = grid.row0 + static_cast<int>(i) / grid.columns;
        place.frame_x = scene.bins->region.x0 + place.column * frame_tile_side - frame.x0;
        place.frame_y = scene.bins->region.y0 + place.row * frame_tile_side - frame.y0;
        place.x0 = std::max(-place.frame_x, 0);
        place.y0 = std::max(-place.frame_y, 0);
        place.x1 = std::min(frame.width - place.frame_x, frame_tile_side);
        place.y1 = std::min(frame.height - place.frame_y, frame_tile_side);
        visit(i, place);
        meter.tile_done();
    });
    return !skipped;
}

void render_tiles(const TileScene& scene, const FrameOptions& options, const Exec& exec, Frame& frame) {
    const std::size_t tiles = tile_count(scene, frame);
    std::vector<std::int64_t> covered(tiles, 0);
    const std::size_t lights = scene.lights.size();
    std::vector<double> lookup_s(tiles * lights, 0.0);
    const bool has_exact = scene.has_exact();
    ExactTilePool pool(lights, scene.gathers());
    std::vector<ExactCounts> counts(tiles);
    frame.complete = walk_tiles(scene, options, exec, frame, [&](std::size_t i, const TilePlace& place) {
        TileWork work;  // not initialised: every stage writes what the next one reads
        work.lookup_s = std::span(lookup_s).subspan(i * lights, lights);
        const auto [column, row] = std::pair{place.column, place.row};
        std::unique_ptr<ExactTile> exact = has_exact ? pool.take() : nullptr;
        if (scene.pass != nullptr) {
            add_tile(scene, column, row, options.shadow, exec.isa, work, *exact, frame);
        } else {
            covered[i] = render_tile(scene, column, row, options, exec.isa, work, exact.get(), frame);
        }
        counts[i] = work.exact_counts;
        if (exact) pool.give_back(std::move(exact));
    });
    for (const std::int64_t n : covered)
        frame.stats.covered_samples += n;
    for (const ExactCounts& n : counts)
        frame.stats.exact += n;
    for (std::size_t l = 0; l < lights; ++l) {
        const bool of_sky = scene.pass != nullptr && scene.pass->light->is_sky;
        if (!scene.lights[l].casts_shadows() || of_sky) continue;
        double& sum = frame.stats.lights[scene.lights[l].shadow].lookup_s;
        for (std::size_t i = 0; i < tiles; ++i)
            sum += lookup_s[i * lights + l];
    }
    if (scene.pass != nullptr) return;
    frame.stats.samples = static_cast<std::int64_t>(tiles) * frame_tile_side * frame_tile_side *
                          static_cast<std::int64_t>(scene.pattern.size());
}

}  // namespace obscura
