#include "bench/shadows/soft_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "bench/harness/run_times.h"
#include "core/parallel.h"
#include "raster/exact/caster_pool.h"
#include "raster/exact/exact_shadow.h"
#include "raster/exact/soft_casters.h"
#include "raster/light_samples.h"

namespace obscura {
namespace {

constexpr std::size_t points_together = 16;

class SoftState {
  public:
    SoftState(const Scene& scene, const FrameSamples& samples, int points, const Exec& exec)
        : scene_(scene),
          samples_(samples),
          exec_(exec),
          light_(scene.lights.at(0).light),
          points_(light_samples(light_, points)),
          words_(samples.per_tile() / 16),
          lit_(points_.size(), std::vector<std::uint32_t>(samples.tiles * words_)) {
        order();
    }

    void order() {
        if (!is_parallel(light_.kind)) return;
        casters_ = build_casters(scene_.mesh, light_, exec_, scratch_);
        middle_ = exact_light(light_, casters_, scene_.mesh, samples_.rays);
        parts_.clear();
        for (std::size_t at = 0; at < points_.size(); at += points_together)
            parts_.push_back(soft_parts(scene_.mesh, some(at), exec_));
    }

    void look_up() {
        for (std::size_t at = 0, group = 0; at < points_.size(); at += points_together, ++group)
            is_parallel(light_.kind) ? look_up_disc(at, group) : look_up_points(at);
    }

    const LitOfPoints& lit() const { return lit_; }

  private:
    std::span<const Light> some(std::size_t at) const {
        return std::span(points_).subspan(at, std::min(points_together, points_.size() - at));
    }

    /// All tiles, each with a work of its own.
    template <class Fn>
    void of_tiles(Fn&& fn) {
        parallel_for(samples_.tiles, exec_, [&](std::size_t t) {
            std::unique_ptr<ExactWork> work = take();
            fn(t, *work);
            const std::scoped_lock lock(mutex_);
            free_.push_back(std::move(work));
        });
    }
    std::unique_ptr<ExactWork> take() {
        const std::scoped_lock lock(mutex_);
        if (free_.empty()) return std::make_unique<ExactWork>(samples_.per_tile());
        auto work = std::move(free_.back());
        free_.pop_back();
        return work;
    }

    void look_up_disc(std::size_t at, std::size_t group) {
        const ExactSoft soft = exact_soft_light(light_, *middle_, parts_[group], scene_.mesh);
        of_tiles([&](std::size_t t, ExactWork& work) {
            std::vector<std::uint32_t> lit(points_together * words_);
            ExactCounts counts;
            work.shadows(samples_.points(t), soft, exec_.isa, lit.data(), words_, counts);
            for (std::size_t p = 0; p < some(at).size(); ++p)
                std::copy_n(lit.data() + p * words_, words_, lit_[at + p].data() + t * words_);
        });
    }

    void look_up_points(std::size_t at) {
        auto casters = pool_.build(scene_.mesh, some(at), exec_);
        std::vector<ExactLight> lights;
        for (std::size_t p = 0; p < casters.size(); ++p)
            lights.push_back(exact_light(points_[at + p], casters[p], scene_.mesh, samples_.rays));
        of_tiles([&](std::size_t t, ExactWork& work) {
            ExactCounts counts;
            for (std::size_t p = 0; p < lights.size(); ++p)
                work.shadows(samples_.points(t), lights[p], exec_.isa, lit_[at + p].data() + t * words_,
                             counts);
        });
        pool_.give_back(std::move(casters));
    }

    const Scene& scene_;
    const FrameSamples& samples_;
    Exec exec_;
    const Light& light_;
    std::vector<Light> points_;
    std::size_t words_;
    LitOfPoints lit_;
    CasterScratch scratch_;
    std::vector<Casters> casters_;
    std::optional<ExactLight> middle_;
    std::vector<SoftParts> parts_;
    CasterPool pool_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<ExactWork>> free_;
};

}  // namespace

Session open_soft(const Scene& scene, const FrameSamples& samples, int points, const Exec& exec) {
    const auto state = std::make_shared<SoftState>(scene, samples, points, exec);
    Session session;
    session.version = fmt::format("this build ({})", isa_name(exec.isa));
    session.jobs = {{Workload::shadow_map, "order", true, [s = state.get()] { s->order(); }, {}},
                    {Workload::lookup, "lookups", true, [s = state.get()] { s->look_up(); }, {}}};
    session.state = state;
    return session;
}

LitOfPoints soft_shadows(const Scene& scene, const FrameSamples& samples, int points, const Exec& exec,
                         SoftTimes* times) {
    std::optional<SoftState> state;
    SoftTimes took;
    took.order_ms = milliseconds_of([&] { state.emplace(scene, samples, points, exec); });
    took.lookup_ms = milliseconds_of([&] { state->look_up(); });
    if (times != nullptr) *times = took;
    return state->lit();
}

Scene with_points(const Scene& scene, int points) {
    Scene many = scene;
    many.lights.clear();
    for (const Light& light : light_samples(scene.lights.at(0).light, points)) {
        SceneLight& one = many.lights.emplace_back(scene.lights[0]);
        one.light = light;
    }
    return many;
}

}  // namespace obscura
