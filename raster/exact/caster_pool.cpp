#include "raster/exact/caster_pool.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/parallel.h"

namespace obscura {

std::vector<std::vector<Casters>> CasterPool::build(const Mesh& mesh, std::span<const Light> lights,
                                                    const Exec& exec, const std::atomic<bool>* cancel) {
    std::vector<std::vector<Casters>> all(lights.size());
    // Few lights have all threads one by one; of many each has one, which saves what threads wait for each
    // other.
    const auto threads = static_cast<std::size_t>(exec.threads > 0 ? exec.threads : hardware_threads());
    const bool few = lights.size() < threads;
    const Exec own = few ? exec : Exec{exec.isa, 1};
    parallel_for(lights.size(), few ? Exec{exec.isa, 1} : exec, [&](std::size_t i) {
        std::unique_ptr<CasterScratch> scratch = take(lights[i]);
        all[i] = build_casters(mesh, lights[i], own, *scratch, cancel);
        put(std::move(scratch));
    });
    if (std::any_of(all.begin(), all.end(), [](const auto& casters) { return casters.empty(); })) return {};
    return all;
}

void CasterPool::give_back(std::vector<std::vector<Casters>> casters) {
    const std::scoped_lock lock(mutex_);
    for (std::vector<Casters>& views : casters)
        std::move(views.begin(), views.end(), std::back_inserter(spare_));
}

std::unique_ptr<CasterScratch> CasterPool::take(const Light& light) {
    const auto views = static_cast<std::size_t>(shadow_view_count(light.kind));
    const std::scoped_lock lock(mutex_);
    std::unique_ptr<CasterScratch> scratch;
    if (free_.empty()) {
        scratch = std::make_unique<CasterScratch>();
    } else {
        scratch = std::move(free_.back());
        free_.pop_back();
    }
    while (scratch->spare.size() < views && !spare_.empty()) {
        scratch->spare.push_back(std::move(spare_.back()));
        spare_.pop_back();
    }
    return scratch;
}

void CasterPool::put(std::unique_ptr<CasterScratch> scratch) {
    const std::scoped_lock lock(mutex_);
    std::move(scratch->spare.begin(), scratch->spare.end(), std::back_inserter(spare_));
    scratch->spare.clear();
    free_.push_back(std::move(scratch));
}

}  // namespace obscura
