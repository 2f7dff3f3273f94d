#include "bench/shadows/exact_session.h"

#include <fmt/format.h>

#include <bit>
#include <memory>
#include <mutex>
#include <vector>

#include "app/frame/shadows.h"
#include "core/parallel.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

struct ExactState {
    const Scene& scene;
    const FrameSamples& samples;
    Exec exec;
    CasterScratch scratch;
    std::vector<std::vector<Casters>> casters;  ///< per light with shadows
    std::vector<std::vector<std::uint32_t>> lit;
    std::vector<ExactCounts> counts;  ///< per tile
    std::mutex mutex;
    std::vector<std::unique_ptr<ExactWork>> free;

    ExactState(const Scene& scene_, const FrameSamples& samples_, const Exec& exec_)
        : scene(scene_), samples(samples_), exec(exec_), counts(samples_.tiles) {
        order();
        lit.assign(casters.size(), std::vector<std::uint32_t>(samples.tiles * samples.per_tile() / 16));
    }

    void order() {
        casters.clear();
        for (const SceneLight& light : scene.lights) {
            if (casts_shadows(light))
                casters.push_back(build_casters(scene.mesh, light.light, exec, scratch));
        }
    }

    std::vector<ExactLight> lights() const {
        std::vector<ExactLight> all;
        for (const SceneLight& light : scene.lights) {
            if (casts_shadows(light))
                all.push_back(exact_light(light.light, casters[all.size()], scene.mesh, samples.rays));
        }
        return all;
    }

    std::unique_ptr<ExactWork> take() {
        const std::scoped_lock lock(mutex);
        if (free.empty()) return std::make_unique<ExactWork>(samples.per_tile());
        auto work = std::move(free.back());
        free.pop_back();
        return work;
    }
    void give_back(std::unique_ptr<ExactWork> work) {
        const std::scoped_lock lock(mutex);
        free.push_back(std::move(work));
    }

    void look_up() {
        const std::vector<ExactLight> all = lights();
        parallel_for(samples.tiles, exec, [&](std::size_t t) {
            auto work = take();
            counts[t] = {};
            for (std::size_t l = 0; l < all.size(); ++l) {
                work->shadows(samples.points(t), all[l], exec.isa,
                              lit[l].data() + t * samples.per_tile() / 16, counts[t]);
            }
            give_back(std::move(work));
        });
    }

    ExactFindings findings() const {
        ExactCounts sum;
        for (const ExactCounts& n : counts)
            sum += n;
        // What nothing can darken was lit without a look.
        std::int64_t shown = 0, unasked = 0;
        std::vector<ExactLight> all = lights();
        for (const auto& words : lit) {
            for (const std::uint32_t word : words)
                shown += std::popcount(word);
        }
        const auto asking = asked_samples(samples, all, exec);
        for (std::size_t l = 0; l < all.size(); ++l) {
            for (std::size_t i = 0; i < lit[l].size(); ++i)
                unasked += std::popcount(lit[l][i] & ~asking[l][i]);
        }
        return {sum.samples, shown - unasked, sum.groups, sum.triangles};
    }
};

}  // namespace

std::vector<std::vector<std::uint32_t>> asked_samples(const FrameSamples& samples,
                                                      std::span<const ExactLight> lights, const Exec& exec) {
    const std::size_t words = samples.per_tile() / 16;
    std::vector<std::vector<std::uint32_t>> asking(lights.size(),
                                                   std::vector<std::uint32_t>(samples.tiles * words, 0));
    parallel_for(samples.tiles, exec, [&](std::size_t t) {
        const std::size_t n = samples.per_tile();
        Buffer<std::int32_t> x(n), y(n);
        Buffer<float> z(n), rounding(n);
        Buffer<std::uint32_t> point(n), lit(words);
        Buffer<std::uint8_t> view(n);
        ExactCounts none;
        ExactSamples found{0, x.data(), y.data(), z.data(), rounding.data(), point.data(), view.data()};
        for (std::size_t l = 0; l < lights.size(); ++l) {
            ref::exact_locate(samples.points(t), lights[l], found, lit.data(), none);
            for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i)
                asking[l][t * words + point[i] / 16] |= 1u << point[i] % 16;
        }
    });
    return asking;
}

void write_findings(const ExactFindings& findings, float* to) {
    for (const std::int64_t n : {findings.asked, findings.lit, findings.groups, findings.triangles}) {
        *to++ = static_cast<float>(n & 0xffffff);
        *to++ = static_cast<float>(n >> 24);
    }
}

ExactFindings read_findings(const float* from) {
    const auto next = [&] {
        const auto low = static_cast<std::int64_t>(*from++);
        return low + (static_cast<std::int64_t>(*from++) << 24);
    };
    ExactFindings findings;
    findings.asked = next();
    findings.lit = next();
    findings.groups = next();
    findings.triangles = next();
    return findings;
}

Session open_exact(const Scene& scene, const FrameSamples& samples, const Exec& exec) {
    const auto state = std::make_shared<ExactState>(scene, samples, exec);
    Session session;
    session.version = fmt::format("this build ({})", isa_name(exec.isa));
    session.jobs = {{Workload::shadow_map, "order", true, [s = state.get()] { s->order(); }, {}},
                    {Workload::lookup, "lookups", true, [s = state.get()] { s->look_up(); },
                     [s = state.get()](float* to) { write_findings(s->findings(), to); }}};
    session.state = state;
    return session;
}

}  // namespace obscura
