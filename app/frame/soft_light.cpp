#include "app/frame/soft_light.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "app/frame/exact_tile.h"
#include "app/frame/light_shadow.h"
#include "app/frame/tiles.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "raster/depth_tile.h"
#include "raster/exact/caster_pool.h"
#include "raster/exact/soft_casters.h"
#include "raster/light_samples.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

constexpr std::int64_t together_bytes = std::int64_t{192} << 20;

/// Points that are asked as one, and what they hold.
int points_as_one(bool disc) {
    return disc ? 16 : 1;
}
std::int64_t as_one_bytes(const MeshSize& mesh, bool disc) {
    return disc ? soft_parts_bytes(mesh.vertices) : casters_bytes(mesh.triangles * 5 / 4);
}

/// Samples of a pixel that ask other points than their neighbours do. Points that are asked as one cost no
/// more than one of them.
int strata(const SoftLight& soft, const TileScene& tiles) {
    const auto points = static_cast<int>(soft.points.size()), as_one = points_as_one(soft.middle.has_value());
    int m = std::clamp(points / as_one, 1, static_cast<int>(tiles.pattern.size()));
    while (points % m != 0)
        m /= 4;
    return m;
}

int passes_of_stratum(const SoftLight& soft, const TileScene& tiles) {
    const auto points = static_cast<int>(soft.points.size()) / strata(soft, tiles);
    const int together = soft_points_together(size_of(*tiles.casters), soft.middle.has_value());
    return (points + together - 1) / together;
}

/// The tiles with nothing that shines but what a pass adds.
TileScene dark(const TileScene& tiles) {
    TileScene t = tiles;
    t.lights.clear();
    t.soft.clear();
    t.sky_model = nullptr;
    t.sky.ambient = t.sky.background = 0;
    for (ShadeMaterial& m : t.materials)
        std::fill_n(m.emission, 3, 0.0f);
    return t;
}

/// One pass: of the points stratum, stratum + m ... of the light, `count` from the begin-th on.
class Pass {
  public:
    Pass(const TileScene& tiles, const SoftLight& soft, int stratum, int begin, int count)
        : light_(soft), tiles_(dark(tiles)) {
        const int m = strata(soft, tiles), of_sample = static_cast<int>(soft.points.size()) / m;
        const auto at = [&](int i) {
            const int point = stratum + i * m;
            return static_cast<std::size_t>(point);
        };
        const auto point = [&](int i) -> const Light& { return soft.points[at(i)]; };
        for (int i = begin; i < begin + count; ++i) {
            points_.push_back(point(i));
            if (soft.is_sky) solid_angle_sr_.push_back(soft.solid_angle_sr[at(i)]);
        }
        pass_.light = &soft;
        pass_.first = stratum;
        pass_.stride = m;
        pass_.shadow_lights = static_cast<float>(tiles.shadow_lights() * of_sample);
        tiles_.pass = &pass_;
        if (!soft.is_sky) return;
        // What is mirrored is shared out among all parts that a sample asks.
        tiles_.sky = tiles.sky;
        tiles_.sky.background = 0;
        for (int i = 0; i < of_sample; ++i) {
            ShadeSkyPart& part = pass_.sky.emplace_back();
            const ShadeLight light = shade_light_of(point(i), {});
            std::copy_n(light.to_light, 3, part.to_light);
        }
    }

    /// The tiles of the pass; null when cancelled. Adds to the seconds that making it takes.
    const TileScene* make(const Exec& exec, const std::atomic<bool>* cancel, CasterPool& pool,
                          double& seconds) {
        const Stopwatch watch;
        const bool done = light_.middle ? see_vertices(exec) : order_casters(exec, cancel, pool);
        seconds += watch.seconds();
        return done ? &tiles_ : nullptr;
    }

    /// Memory for the next.
    void give_back(CasterPool& pool) { pool.give_back(std::exchange(casters_, {})); }

  private:
    /// Parallel light: what the middle's casters do not tell.
    bool see_vertices(const Exec& exec) {
        parts_ = soft_parts(*tiles_.casters, points_, exec);
        soft_ = exact_soft_light(light_.whole, *light_.middle, parts_, *tiles_.casters);
        pass_.soft = &soft_;
        for (const Light& point : points_)
            add(point, *light_.middle);
        return true;
    }

    /// Else each point has casters of its own. False when cancelled.
    bool order_casters(const Exec& exec, const std::atomic<bool>* cancel, CasterPool& pool) {
        casters_ = pool.build(*tiles_.casters, points_, exec, cancel);
        if (casters_.empty()) return false;
        for (std::size_t i = 0; i < points_.size(); ++i)
            add(points_[i], exact_light(points_[i], casters_[i], *tiles_.mesh, tiles_.rays));
        return true;
    }

    void add(const Light& point, const ExactLight& exact) {
        TileLight& to = tiles_.lights.emplace_back();
        to.scene_light = light_.scene_light;
        to.shadow = light_.shadow;
        to.exact = exact;
        to.shade = shade_light_of(point, {tiles_.rays.eye[0], tiles_.rays.eye[1], tiles_.rays.eye[2]});
        // Of a pixel's samples only one in `stride` asks this point.
        for (float& c : to.shade.color)
            c *= static_cast<float>(pass_.stride);
        if (light_.is_sky)
            to.solid_angle_sr = solid_angle_sr_[tiles_.lights.size() - 1] * static_cast<double>(pass_.stride);
    }

    const SoftLight& light_;
    std::vector<Light> points_;
    std::vector<double> solid_angle_sr_;
    std::vector<std::vector<Casters>> casters_;
    SoftParts parts_;
    ExactSoft soft_;
    TileScene tiles_;
    SoftPass pass_;
};

}  // namespace

bool is_soft(const SceneLight& light) {
    return light.shadow.method == ShadowMethod::exact && light.shadow.samples != 1 && has_size(light.light);
}

int points_for_penumbra(const SceneLight& light, float widest_px) {
    if (!is_soft(light)) return 1;
    if (light.shadow.samples != auto_samples) return light.shadow.samples;
    // Surfaces shine from more than their middle even where no penumbra shows, and of what stands between
    // their ends the middle knows nothing.
    const bool surface = light.light.kind == LightKind::surface;
    // Penumbrae narrower than a pixel are what its samples make of a hard edge.
    if (!surface && widest_px < 1) return 1;
    int points = surface ? 64 : 16;
    while (points < most_auto_samples && static_cast<float>(points) < widest_px)
        points *= 4;
    return points;
}

float widest_penumbra(std::span<const TileScene> pictures, const LightShadow& shadow, const Exec& exec) {
    float widest = 0;
    for (const TileScene& tiles : pictures) {
        const ExactLight light = exact_light(shadow.light.light, shadow.exact, *tiles.mesh, tiles.rays);
        const ExactSpread spread = exact_spread(shadow.light.light, light);
        const auto count =
            static_cast<std::size_t>(tiles.bins->columns) * static_cast<std::size_t>(tiles.bins->rows);
        std::vector<float> of_tile(count, 0.0f);
        ExactTilePool pool(1);
        parallel_for(count, exec, [&](std::size_t i) {
            TileWork work;
            std::unique_ptr<ExactTile> tile = pool.take();
            tile->begin(1);
            walk_blocks(tiles, i, {128, 128}, exec.isa, work, [&](const TileRect&, int first_row) {
                tile->keep_block(tiles, 0, 1, first_row, work.surface);
            });
            of_tile[i] =
                tile->widest_penumbra(light, spread, static_cast<float>(most_auto_samples), exec.isa);
            pool.give_back(std::move(tile));
        });
        for (const float px : of_tile)
            widest = std::max(widest, px);
    }
    return widest;
}

int soft_points_together(const MeshSize& mesh, bool disc) {
    const std::int64_t bytes = std::max<std::int64_t>(as_one_bytes(mesh, disc), 1);
    const int as_one = points_as_one(disc);
    return as_one *
           static_cast<int>(std::clamp<std::int64_t>(together_bytes / bytes, 1, most_soft_together / as_one));
}

std::int64_t soft_pass_bytes(const MeshSize& mesh, bool disc) {
    return soft_points_together(mesh, disc) / points_as_one(disc) * as_one_bytes(mesh, disc);
}

int soft_passes(const TileScene& tiles) {
    int passes = 0;
    for (const SoftLight& soft : tiles.soft)
        passes += strata(soft, tiles) * passes_of_stratum(soft, tiles);
    return passes;
}

bool walk_soft_passes(const TileScene& tiles, const Exec& exec, const std::atomic<bool>* cancel,
                      std::span<LightShadowStats> stats,
                      const std::function<bool(const TileScene& pass)>& visit) {
    for (const SoftLight& soft : tiles.soft) {
        CasterPool pool;  // each light's own: what is spare of one is not kept beside the next
        const int m = strata(soft, tiles), points = static_cast<int>(soft.points.size()) / m;
        const int together = soft_points_together(size_of(*tiles.casters), soft.middle.has_value());
        double of_sky = 0;
        double& seconds = soft.is_sky ? of_sky : stats[soft.shadow].build.build_s;
        for (int stratum = 0; stratum < m; ++stratum) {
            for (int begin = 0; begin < points; begin += together) {
                Pass pass(tiles, soft, stratum, begin, std::min(together, points - begin));
                const TileScene* made = pass.make(exec, cancel, pool, seconds);
                if (made == nullptr || !visit(*made)) return false;
                pass.give_back(pool);
            }
        }
    }
    return true;
}

void add_soft_lights(const TileScene& tiles, const FrameOptions& options, const Exec& exec, Frame& frame) {
    const int passes = soft_passes(tiles);
    int done = 0;
    FrameOptions of_pass = options;
    if (options.progress) of_pass.progress = [&](double share) { options.progress((done + share) / passes); };
    const bool all =
        walk_soft_passes(tiles, exec, options.cancel, frame.stats.lights, [&](const TileScene& pass) {
            render_tiles(pass, of_pass, exec, frame);
            ++done;
            return frame.complete;
        });
    frame.complete = frame.complete && all;
    // What is mirrored of a hidden sky was taken away part by part, in floats.
    for (Vec3f& p : frame.radiance.pixels)
        p = {std::max(p.x, 0.0f), std::max(p.y, 0.0f), std::max(p.z, 0.0f)};
}

}  // namespace obscura
