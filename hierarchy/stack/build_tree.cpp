// The counter: a run of 2^j maps waits for the next of its length, so that O(log slices) runs are alive.

#include "hierarchy/stack/build_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/stack/slab.h"
#include "hierarchy/stack/stack_check.h"
#include "hierarchy/tree_code.h"

namespace obscura {
namespace {

/// Maps that are made side by side: a fixed number, so that nothing depends on the threads.
constexpr int batch_maps = 8;

/// Maps, or null: placeholders.
using Maps = std::span<const std::shared_ptr<const CertainTree>>;

/// One anisotropy's octree on its way.
class Attempt {
  public:
    Attempt(const StackShape& shape, std::uint64_t max_nodes)
        : shape_(shape), max_nodes_(max_nodes), waiting_(static_cast<std::size_t>(shape.slice_levels) + 1) {}

    const StackShape& shape() const { return shape_; }
    bool given_up() const { return given_up_; }

    /// The next maps, a power of two of them, always as many.
    void push(Maps maps) {
        if (!given_up_) carry(run(maps));
    }

    /// Fills the stack up with placeholders. Nothing when it got too large.
    std::optional<MultiresTree> finish() {
        for (int j = 0; j < shape_.slice_levels && !given_up_; ++j) {
            if (waiting_[static_cast<std::size_t>(j)]) carry(placeholder_slab(shape_, j));
        }
        if (given_up_) return {};
        return octree_of(std::move(*waiting_.back()), shape_);
    }

  private:
    std::optional<Slab> merged(std::optional<Slab> first, std::optional<Slab> second) const {
        if (!first || !second) return {};
        return merge_slabs(std::move(*first), *second, shape_, max_nodes_);
    }

    std::optional<Slab> run(Maps maps) const {
        if (maps.size() == 1) return maps[0] ? slab_of(maps[0], shape_) : placeholder_slab(shape_, 0);
        const std::size_t half = maps.size() / 2;
        return merged(run(maps.first(half)), run(maps.subspan(half)));
    }

    void carry(std::optional<Slab> slab) {
        while (slab) {
            std::optional<Slab>& place = waiting_[static_cast<std::size_t>(slab->slices_exponent)];
            if (!place) {
                place = std::move(slab);
                return;
            }
            slab = merged(std::exchange(place, std::nullopt), std::move(slab));
        }
        given_up_ = true;
        waiting_.clear();
    }

    StackShape shape_;
    std::uint64_t max_nodes_;
    bool given_up_ = false;
    std::vector<std::optional<Slab>> waiting_;  ///< by exponent of their length
};

std::vector<Attempt> attempts_of(int slices, int map_levels, const StackTreeParams& params) {
    const int slice_levels = static_cast<int>(std::bit_width(static_cast<unsigned>(slices - 1)));
    if (slice_levels > max_slice_levels) {
        throw LimitError(fmt::format("a stack of {} shadow maps has more than the {} that lookups count",
                                     slices, 1 << max_slice_levels));
    }
    std::vector<Attempt> attempts;
    for (const int wanted : params.anisotropies) {
        const StackShape shape{map_levels, slice_levels, std::clamp(wanted, -slice_levels, map_levels)};
        const auto same = [&](const Attempt& a) { return a.shape() == shape; };
        const bool known = std::any_of(attempts.begin(), attempts.end(), same);
        if (!known && shape.levels() <= max_tree_levels) attempts.emplace_back(shape, params.max_nodes);
    }
    if (attempts.empty()) {
        throw LimitError(fmt::format("a stack of {} shadow maps of {} texels a side has more than {} levels",
                                     slices, 1 << map_levels, max_tree_levels));
    }
    return attempts;
}

MultiresCounts operator+(const MultiresCounts& a, const MultiresCounts& b) {
    return {a.full + b.full, a.empty + b.empty, a.leaf + b.leaf};
}

}  // namespace

StackTree build_stack_tree(int slices, int map_levels, const std::function<CertainTree(int)>& slice,
                           const StackTreeParams& params, const Exec& exec, StackTreeStats* stats,
                           const std::atomic<bool>* cancel) {
    CHECK(slices >= 1 && map_levels >= 0 && !params.anisotropies.empty());
    std::vector<Attempt> attempts = attempts_of(slices, map_levels, params);
    StackTreeStats counted;
    const int batch = std::min(batch_maps, 1 << attempts[0].shape().slice_levels);
    std::vector<std::shared_ptr<const CertainTree>> maps(static_cast<std::size_t>(batch));
    std::vector<MultiresCounts> quadtrees(maps.size());
    for (int first = 0; first < slices; first += batch) {
        const int count = std::min(batch, slices - first);
        parallel_for(maps.size(), exec, [&](std::size_t i) {
            maps[i].reset();
            quadtrees[i] = {};
            if (static_cast<int>(i) >= count || stopped(cancel)) return;
            maps[i] = std::make_shared<const CertainTree>(slice(first + static_cast<int>(i)));
            if (params.count_quadtrees) quadtrees[i] = count_nodes(multires_of(*maps[i]));
        });
        // Merging takes longer than making: maps without a meaning are not worth it.
        if (stopped(cancel)) return {attempts[0].shape(), {}};
        for (std::size_t i = 0; i < maps.size(); ++i) {
            counted.certain_groups += maps[i] ? maps[i]->groups.size() : 0;
            counted.quadtrees = counted.quadtrees + quadtrees[i];
        }
        parallel_for(attempts.size(), exec, [&](std::size_t i) {
            if (!stopped(cancel)) attempts[i].push(maps);
        });
    }
    maps.clear();

    // Of the trees, one is alive beside the best so far.
    std::optional<StackTree> best;
    std::uint64_t best_bytes = std::numeric_limits<std::uint64_t>::max();
    for (Attempt& attempt : attempts) {
        if (stopped(cancel)) return {attempts[0].shape(), {}};
        std::optional<MultiresTree> tree = attempt.finish();
        const std::uint64_t bytes = tree ? word_bytes(count_nodes(*tree)) : 0;
        counted.trials.push_back({attempt.shape().anisotropy, !tree, bytes});
        if (!tree || bytes >= best_bytes) continue;
        best_bytes = bytes;
        best = StackTree{attempt.shape(), std::move(*tree)};
    }
    if (!best) throw LimitError(fmt::format("a stack of shadow maps passes {} nodes", params.max_nodes));
    if (stats != nullptr) *stats = counted;
    return std::move(*best);
}

}  // namespace obscura
