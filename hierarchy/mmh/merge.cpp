// Merging, lossless.
//
// A node of a shared subtree stands for one node in each place that points there. Its value is a difference,
// so in place B it comes to what it comes to in place A, plus
//
//     shift = what B's parent inherits - what A's parent inherits,
//
// the same for every node of the subtree, since all differences inside are shared. B can be A where every
// value of A can be moved by `shift` into the range of its twin in B: the ranges of A and of B, moved back,
// meet; what remains of both is A's range from then on. In whole numbers all of this is exact.
//
// The shift is only known when both parents' values are. So subtrees are compared from the tallest down, and
// the values of nodes freeze before what hangs below them is compared: nodes stand in subtrees that are
// taller than what they point to. The paper re-centres the values of inner nodes with every merge, after what
// lies below them was compared by differences to the old ones: their children then leave their intervals (a
// test has the smallest case).
//
// Ours differs from the paper's algorithm 3 in this, too: what lies inside merged subtrees is no candidate
// any more; topologies are compared, not their hashes; ranges are compared by their extremes in both
// directions.

#include "hierarchy/mmh/merge.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

namespace obscura {
namespace {

/// The extremes of a subtree's ranges, relative to what it inherits: what tells most pairs apart (paper,
/// figure 6).
struct Extremes {
    std::int64_t least = INT64_MAX, greatest = INT64_MIN;                 ///< of all ranges
    std::int64_t least_greatest = INT64_MAX, greatest_least = INT64_MIN;  ///< of their ends

    void add(std::int64_t low, std::int64_t high) {
        least = std::min(least, low);
        greatest = std::max(greatest, high);
        least_greatest = std::min(least_greatest, high);
        greatest_least = std::max(greatest_least, low);
    }
    /// Some value of one of them lies beyond all of the other's.
    bool apart(const Extremes& b) const {
        return least_greatest < b.least || greatest_least > b.greatest || b.least_greatest < least ||
               b.greatest_least > greatest;
    }
};

class Merger {
  public:
    Merger(const SubtreeSet& set, const MergeParams& params, const Exec& exec)
        : set_(set), params_(params), exec_(exec), ranges_(set.values) {
        const std::size_t count = set.subtrees.size();
        merged_.stands_for.assign(count, no_subtree);
        merged_.alive.assign(count, 0);
        merged_.inherited.assign(count, 0);
    }

    Merged run() {
        collect_lists();
        for (std::size_t height = by_height_.size(); height-- > 1;)
            merge_height(by_height_[height]);
        choose_values();
        return std::move(merged_);
    }

  private:
    /// Subtrees of one topology, in depth-first order: the paper's collision lists.
    struct List {
        std::uint32_t begin = 0, end = 0;  ///< in members_
    };
    /// A subtree that others may become.
    struct Survivor {
        std::uint32_t subtree;
        std::uint32_t place;  ///< in its list
        Extremes extremes;
    };

    void collect_lists() {
        std::vector<std::uint32_t> first(set_.topologies + 1, 0);
        for (const Subtree& s : set_.subtrees)
            ++first[s.topology + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        members_.resize(set_.subtrees.size());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::uint32_t s = 0; s < set_.subtrees.size(); ++s)
            members_[next[set_.subtrees[s].topology]++] = s;
        for (std::uint32_t t = 0; t < set_.topologies; ++t) {
            const std::size_t height = set_.subtrees[members_[first[t]]].height;
            if (height >= by_height_.size()) by_height_.resize(height + 1);
            by_height_[height].push_back({first[t], first[t + 1]});
        }
        // The longest first: threads end together.
        for (std::vector<List>& lists : by_height_) {
            std::stable_sort(lists.begin(), lists.end(),
                             [](const List& a, const List& b) { return a.end - a.begin > b.end - b.begin; });
        }
    }

    void merge_height(const std::vector<List>& lists) {
        std::vector<MergeStats> stats(lists.size());
        parallel_for(lists.size(), exec_, [&](std::size_t i) { merge_list(lists[i], stats[i]); });
        for (const MergeStats& s : stats)
            merged_.stats += s;
    }

    /// The value that holds at a subtree's parent; the parent's own is frozen now.
    void inherit(std::uint32_t at) {
        const Subtree& s = set_.subtrees[at];
        merged_.alive[at] = s.parent == no_subtree || merged_.stored(s.parent) ? 1 : 0;
        if (merged_.alive[at] == 0) return;
        merged_.inherited[at] = s.parent_value == no_value
                                    ? merged_.inherited[s.parent]
                                    : stored_number(ranges_[s.parent_value], set_.layout);
    }

    void merge_list(List list, MergeStats& stats) {
        for (std::uint32_t m = list.begin; m < list.end; ++m)
            inherit(members_[m]);
        std::vector<Survivor> survivors;
        for (std::uint32_t m = list.end; m-- > list.begin;) {
            const std::uint32_t at = members_[m];
            if (merged_.alive[at] == 0) continue;
            const Survivor candidate{at, m, extremes_of(at)};
            if (!merge_into_one_of(survivors, candidate, stats)) survivors.push_back(candidate);
        }
    }

    /// The nearest first.
    bool merge_into_one_of(std::vector<Survivor>& survivors, const Survivor& b, MergeStats& stats) {
        if (set_.subtrees[b.subtree].level + 1 > params_.max_height) return false;
        const auto limit =
            params_.search_limit == 0 ? UINT32_MAX : static_cast<std::uint32_t>(params_.search_limit);
        std::uint32_t compared = 0;
        for (auto a = survivors.rbegin(); a != survivors.rend(); ++a) {
            if (params_.count_survivors ? compared == limit : a->place - b.place > limit) break;
            ++compared;
            if (a->extremes.apart(b.extremes)) {
                ++stats.interval_mismatch;
                continue;
            }
            if (distance(b.subtree, a->subtree) > params_.max_distance ||
                set_.subtrees[a->subtree].level + 1 > params_.max_height) {
                ++stats.too_far;
                continue;
            }
            if (!can_be_one(a->subtree, b.subtree)) {
                ++stats.full_rejected;
                continue;
            }
            tighten(a->subtree, b.subtree);
            a->extremes = extremes_of(a->subtree);
            merged_.stands_for[b.subtree] = a->subtree;
            ++stats.merged;
            return true;
        }
        return false;
    }

    Extremes extremes_of(std::uint32_t at) const {
        const Subtree& s = set_.subtrees[at];
        const std::int64_t inherited = merged_.inherited[at];
        Extremes e;
        for (const NumberRange *r = ranges_.data() + s.first_value, *end = r + s.values; r != end; ++r)
            e.add(r->least - inherited, r->greatest - inherited);
        return e;
    }

    /// Words from b's parent to a, which stands behind it, before anything is merged: never less than after.
    std::uint64_t distance(std::uint32_t b, std::uint32_t a) const {
        const std::uint32_t parent = set_.subtrees[b].parent;
        return set_.subtrees[a].unit - (parent == no_subtree ? 0 : set_.subtrees[parent].unit);
    }

    std::int64_t shift(std::uint32_t a, std::uint32_t b) const {
        return std::int64_t{merged_.inherited[b]} - std::int64_t{merged_.inherited[a]};
    }

    bool can_be_one(std::uint32_t a, std::uint32_t b) const {
        const NumberRange *of_a = ranges_.data() + set_.subtrees[a].first_value,
                          *of_b = ranges_.data() + set_.subtrees[b].first_value;
        const std::int64_t by = shift(a, b);
        for (std::uint32_t i = 0; i < set_.subtrees[a].values; ++i) {
            if (of_a[i].least + by > std::int64_t{of_b[i].greatest} ||
                of_a[i].greatest + by < std::int64_t{of_b[i].least})
                return false;
        }
        return true;
    }

    void tighten(std::uint32_t a, std::uint32_t b) {
        NumberRange* of_a = ranges_.data() + set_.subtrees[a].first_value;
        const NumberRange* of_b = ranges_.data() + set_.subtrees[b].first_value;
        const std::int64_t by = shift(a, b);
        for (std::uint32_t i = 0; i < set_.subtrees[a].values; ++i) {
            of_a[i].least =
                static_cast<std::uint32_t>(std::max<std::int64_t>(of_a[i].least, of_b[i].least - by));
            of_a[i].greatest =
                static_cast<std::uint32_t>(std::min<std::int64_t>(of_a[i].greatest, of_b[i].greatest - by));
        }
    }

    void choose_values() {
        merged_.values.resize(ranges_.size());
        for (std::size_t i = 0; i < ranges_.size(); ++i)
            merged_.values[i] = stored_number(ranges_[i], set_.layout);
    }

    const SubtreeSet& set_;
    const MergeParams& params_;
    const Exec& exec_;
    std::vector<NumberRange> ranges_;
    std::vector<std::uint32_t> members_;        ///< all subtrees, by topology
    std::vector<std::vector<List>> by_height_;  ///< lists of subtrees of one height
    Merged merged_;
};

}  // namespace

Merged merge_subtrees(const SubtreeSet& set, const MergeParams& params, const Exec& exec) {
    return Merger(set, params, exec).run();
}

}  // namespace obscura
