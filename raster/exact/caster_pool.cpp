#include "raster/exact/caster_pool.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"

namespace obscura {

std::vector<std::vector<Casters>> CasterPool::build(const Mesh& mesh, std::span<const Light> lights,
                                                    const Exec& exec, const std::atomic<bool>* cancel) {
    std::vector<std::vector<Casters>> all(lights.size());
    // A single light has all threads; of many each has one, which saves what threads wait for each other.
    const Exec own = lights.size() == 1 ? exec : Exec{exec.isa, 1};
    parallel_for(lights.size(), exec, [&](std::size_t i) {
        std::unique_ptr<CasterScratch> scratch = take();
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

std::unique_ptr<CasterScratch> CasterPool::take() {
    constexpr std::size_t most_views = 6;
    const std::scoped_lock lock(mutex_);
    std::unique_ptr<CasterScratch> scratch;
    if (free_.empty()) {
        scratch = std::make_unique<CasterScratch>();
    } else {
        scratch = std::move(free_.back());
        free_.pop_back();
    }
    while (scratch->spare.size() < most_views && !spare_.empty()) {
        scratch->spare.push_back(std::move(spare_.back()));
        spare_.pop_back();
    }
    return scratch;
}

void CasterPool::put(std::unique_ptr<CasterScratch> scratch) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(scratch));
}

}  // namespace obscura
