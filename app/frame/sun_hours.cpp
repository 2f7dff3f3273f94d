#include "app/frame/sun_hours.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "app/frame/exact_tile.h"
#include "app/frame/soft_light.h"
#include "app/frame/sun_hours_text.h"
#include "app/frame/tiles.h"
#include "core/error.h"
#include "core/sky/clear_sky.h"
#include "core/stopwatch.h"
#include "raster/exact/caster_pool.h"

namespace obscura {
namespace {

/// What is counted of a pixel, before it is divided.
struct HoursSums {
    Image<double> hours;           ///< of its samples together
    Image<std::uint8_t> surfaces;  ///< samples that show one
};

/// The tiles with nothing but the suns of one pass.
class SunPass {
  public:
    SunPass(const TileScene& tiles, const Light& sun, std::span<const SunStep> steps)
        : sun_(sun), steps_(steps), tiles_(tiles) {
        tiles_.lights.clear();
        tiles_.soft.clear();
        tiles_.pass = nullptr;
        tiles_.sky_model = nullptr;
    }

    /// Puts what casts shadows in order, for each sun. False when cancelled.
    bool make(const Exec& exec, const std::atomic<bool>* cancel, CasterPool& pool) {
        std::vector<Light> suns;
        for (const SunStep& step : steps_) {
            Light& light = suns.emplace_back(sun_);
            light.direction = -compass_direction(step.azimuth_deg, step.elevation_deg);
            light.below_horizon = false;
        }
        casters_ = pool.build(*tiles_.casters, suns, exec, cancel);
        if (casters_.size() != suns.size()) return false;
        for (std::size_t i = 0; i < suns.size(); ++i)
            tiles_.lights.emplace_back().exact = exact_light(suns[i], casters_[i], *tiles_.mesh, tiles_.rays);
        return true;
    }

    /// Memory for the next.
    void give_back(CasterPool& pool) { pool.give_back(std::exchange(casters_, {})); }

    const TileScene& tiles() const { return tiles_; }
    std::span<const SunStep> steps() const { return steps_; }

  private:
    const Light& sun_;
    std::span<const SunStep> steps_;
    std::vector<std::vector<Casters>> casters_;
    TileScene tiles_;
};

/// Adds the hours of a pass to the pixels of one tile that are the frame's. `first`: surfaces are counted,
/// too.
void add_tile_hours(const SunPass& pass, const TilePlace& place, bool first, Isa isa, ExactTile& exact,
                    ExactCounts& counts, HoursSums& sums) {
    TileWork work;  // not initialised
    work.exact_counts = {};
    const auto samples = static_cast<int>(pass.tiles().pattern.size());
    const int begin_row = place.y0 / block_rows * block_rows;
    for (int sample = 0; sample < samples; sample += exact_samples_together) {
        const int count = std::min(exact_samples_together, samples - sample);
        exact.run(pass.tiles(), place.column, place.row, sample, count, begin_row, place.y1, isa, work);
        const std::uint32_t* covered = exact.points().covered;
        const std::uint32_t of_pixel = (1u << count) - 1;
        for (int y = place.y0; y < place.y1; ++y) {
            for (int x = place.x0; x < place.x1; ++x) {
                // A pixel's samples are neighbours.
                const int at = exact_point_index(0, count, x, y), px = place.frame_x + x,
                          py = place.frame_y + y;
                const auto samples_in = [&](const std::uint32_t* mask) {
                    return std::popcount(mask[at / 16] >> (at % 16) & of_pixel);
                };
                if (first) sums.surfaces(px, py) += static_cast<std::uint8_t>(samples_in(covered));
                double& hours = sums.hours(px, py);
                for (std::size_t s = 0; s < pass.steps().size(); ++s)
                    hours += pass.steps()[s].hours * samples_in(exact.lit(s));
            }
        }
    }
    counts += work.exact_counts;
}

/// A mean of the samples on surfaces, in hours.
Image<float> mean_hours(const HoursSums& sums) {
    Image<float> mean(sums.hours.width, sums.hours.height);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        const int surfaces = sums.surfaces.pixels[i];
        mean.pixels[i] = surfaces > 0 ? static_cast<float>(sums.hours.pixels[i] / surfaces)
                                      : std::numeric_limits<float>::quiet_NaN();
    }
    return mean;
}

SunHoursStats begin_stats(const Light& sun, std::span<const SunStep> steps) {
    SunHoursStats stats;
    stats.light = sun.id;
    stats.path = *sun.path;
    stats.suns = static_cast<int>(steps.size());
    stats.sunlit = sunlit_spans(*sun.path);
    return stats;
}

}  // namespace

const Light* sun_with_path(const Scene& scene) {
    const auto sun = std::find_if(scene.lights.begin(), scene.lights.end(),
                                  [](const SceneLight& l) { return l.light.path.has_value(); });
    return sun != scene.lights.end() ? &sun->light : nullptr;
}

int suns_together(const MeshSize& mesh, int suns) {
    return std::clamp(suns, 1, soft_points_together(mesh, false));
}

std::int64_t sun_pass_bytes(const MeshSize& mesh, int suns) {
    return suns_together(mesh, suns) * casters_bytes(mesh.triangles);
}

int sun_passes(const MeshSize& mesh, int suns) {
    const int together = suns_together(mesh, suns);
    return std::max((suns + together - 1) / together, 1);
}

void add_sun_hours(const TileScene& tiles, const Light& sun, const FrameOptions& options, const Exec& exec,
                   Frame& frame) {
    CHECK(sun.path.has_value(), "no path of the sun");
    const Stopwatch watch;
    const std::vector<SunStep> steps = sun_steps(*sun.path);
    SunHoursStats& stats = frame.stats.sun_hours.emplace(begin_stats(sun, steps));
    if (steps.empty()) frame.stats.notices.push_back(no_sun_text(sun.id, *sun.path));
    const MeshSize mesh = size_of(*tiles.casters);
    const auto together = static_cast<std::size_t>(suns_together(mesh, stats.suns));
    stats.passes = sun_passes(mesh, stats.suns);

    HoursSums sums{Image<double>(frame.width, frame.height), Image<std::uint8_t>(frame.width, frame.height)};
    CasterPool caster_pool;
    for (int p = 0; p < stats.passes && frame.complete; ++p) {
        const std::size_t begin = static_cast<std::size_t>(p) * together;
        SunPass pass(tiles, sun, std::span(steps).subspan(begin, std::min(together, steps.size() - begin)));
        const Stopwatch ordering;
        frame.complete = pass.make(exec, options.cancel, caster_pool);
        stats.order_s += ordering.seconds();
        if (!frame.complete) break;
        FrameOptions of_pass = options;
        if (options.progress)
            of_pass.progress = [&](double share) { options.progress((p + share) / stats.passes); };
        ExactTilePool pool(pass.steps().size());
        std::vector<ExactCounts> counts(tile_count(tiles, frame));
        frame.complete = walk_tiles(tiles, of_pass, exec, frame, [&](std::size_t i, const TilePlace& place) {
            std::unique_ptr<ExactTile> exact = pool.take();
            add_tile_hours(pass, place, p == 0, exec.isa, *exact, counts[i], sums);
            pool.give_back(std::move(exact));
        });
        for (const ExactCounts& n : counts)
            stats.exact += n;
        pass.give_back(caster_pool);
    }
    frame.sun_hours = mean_hours(sums);
    stats.total_s = watch.seconds();
}

}  // namespace obscura
