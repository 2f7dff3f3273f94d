// Serialises a merged tree (paper, section 3.3): places first, then nodes with offsets to where what they
// point to has come to stand.
//
// Groups stand depth-first in child order, so a subtree that stands for an earlier one is behind it, and
// offsets are positive: a file can hold no cycle. Where a subtree is shared by nodes of several heights,
// offsets count in the same units at all of them: words. That is so as long as the tree has fewer than 2^24
// words, and below the first height whose blocks have more (paper: the lowest twelve); where it is not,
// merging is tried again with lesser heights or distances.

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "hierarchy/layout_plan.h"
#include "hierarchy/mmh/mmh.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "headers are written as little-endian words");

constexpr TreeLayout words = TreeLayout::words24;  // whose nodes these are
constexpr std::uint32_t full_kind = static_cast<std::uint32_t>(ChildKind::full);
constexpr std::uint32_t empty_kind = static_cast<std::uint32_t>(ChildKind::empty);

/// Calls visit(child, kind, unit in the group, subtree below or no_subtree) for the nodes of a subtree's own
/// group.
template <class Visit>
void for_each_node(const SubtreeSet& set, std::uint32_t at, const Visit& visit) {
    const Subtree& s = set.subtrees[at];
    std::uint32_t unit = 0, below = at + 1;
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t kind = kind_of(s.kinds, i);
        if (kind == 0) continue;
        const bool inner = kind >= empty_kind;
        visit(kind, unit, inner ? below : no_subtree);
        if (inner) below += set.subtrees[below].groups;
        unit += units_of_kinds(words)[kind];
    }
}

/// The tree that is stored: nodes whose subtree stands elsewhere have none of their own.
TreeShape shape_of_merged(const SubtreeSet& set, const Merged& merged) {
    TreeShape shape;
    shape.levels = set.levels;
    shape.kinds[set.levels + 1].push_back(full_kind);
    shape.kinds[set.levels].push_back(static_cast<std::uint8_t>(set.root.kinds));
    (set.root.kinds == 0 ? shape.counts.leaf : shape.counts.full) = 1;
    for (std::uint32_t at = 0; at < set.subtrees.size(); ++at) {
        if (!merged.stored(at)) continue;
        for_each_node(set, at, [&](std::uint32_t kind, std::uint32_t, std::uint32_t below) {
            shape.counts.leaf += kind == static_cast<std::uint32_t>(ChildKind::leaf);
            shape.counts.empty += kind == empty_kind;
            shape.counts.full += kind == full_kind;
            if (below == no_subtree) return;
            const bool own = merged.stored(below);
            shape.kinds[set.subtrees[at].level].push_back(own ? set.subtrees[below].kinds : std::uint8_t{0});
        });
    }
    return shape;
}

/// Where groups stand: units, by subtree, of those that are stored.
class Placer {
  public:
    Placer(const SubtreeSet& set, const Merged& merged, const LayoutPlan& plan)
        : set_(set), merged_(merged), plan_(plan), units_(set.subtrees.size(), 0) {}

    std::vector<std::uint64_t> run() {
        if (set_.root.kinds == 0) return std::move(units_);
        // The parent that stands above the root: a group of one full node, at unit 0.
        const Family family = family_at(set_.levels, full_kind);
        put(0, place(family, plan_.scale[set_.levels]).start[0], set_.levels - 1);
        return std::move(units_);
    }

  private:
    Family family_at(int height, std::uint32_t kinds) {
        const Family family = family_of<4>(units_of_kinds(words), kinds,
                                           plan_.blocks[height].data() + next_[height], BlockOrder::child);
        next_[height] += static_cast<std::size_t>(family.inner);
        return family;
    }

    void put(std::uint32_t at, std::uint64_t unit, int height) {
        units_[at] = unit;
        const Family family = family_at(height, set_.subtrees[at].kinds);
        const Placement placement = place(family, plan_.scale[height]);
        int member = 0;
        for_each_node(set_, at, [&](std::uint32_t, std::uint32_t, std::uint32_t below) {
            if (below == no_subtree || !merged_.stored(below)) return;
            put(below, unit + placement.start[member++], height - 1);
        });
    }

    const SubtreeSet& set_;
    const Merged& merged_;
    const LayoutPlan& plan_;
    std::vector<std::uint64_t> units_;
    std::size_t next_[max_tree_levels + 1] = {};  ///< by height: inner nodes that were met
};

/// A merged tree and where it goes.
struct Draft {
    Merged merged;
    TreeShape shape;
    LayoutPlan plan;
    std::vector<std::uint64_t> units;
};

std::uint32_t most_offset(const EncodeParams& params) {
    return (1u << (params.offset_bits == 0 ? offset_bits(words) : params.offset_bits)) - 1;
}

/// Whether offsets to shared subtrees can be written as the plan has it; lowers `merge` where they cannot.
bool offsets_reach(const SubtreeSet& set, const Draft& draft, std::uint32_t max_offset, MergeParams& merge) {
    // Up to where offsets count words.
    int words_to = 0;
    while (words_to < set.levels && draft.plan.scale[words_to + 1] == 1)
        ++words_to;
    bool reach = true, too_high = false;
    for (std::uint32_t at = 0; at < set.subtrees.size(); ++at) {
        const std::uint32_t target = draft.merged.stands_for[at];
        if (target == no_subtree || draft.merged.alive[at] == 0) continue;
        too_high = too_high || std::max(set.subtrees[at].level, set.subtrees[target].level) + 1 > words_to;
        const std::uint32_t parent = set.subtrees[at].parent;
        const std::uint64_t from = parent == no_subtree ? 0 : draft.units[parent];
        reach = reach && draft.units[target] - from <= max_offset;
    }
    if (too_high) merge.max_height = words_to;
    if (!reach) merge.max_distance /= 2;
    return reach && !too_high;
}

Draft draft_of(const SubtreeSet& set, const EncodeParams& params) {
    MergeParams merge = params.merge;
    const std::uint32_t max_offset = most_offset(params);
    merge.max_distance = std::min<std::uint64_t>(merge.max_distance, max_offset);
    for (;;) {
        Draft draft;
        draft.merged = merge_subtrees(set, merge, params.exec);
        draft.shape = shape_of_merged(set, draft.merged);
        draft.plan = plan_layout<4>(draft.shape, units_of_kinds(words), max_offset, params.max_units,
                                    BlockOrder::child);
        if (!draft.plan.fits) {
            throw LimitError(
                fmt::format("a merged shadow tree takes more than the {} units that lookups can name; "
                            "lower the resolution of the shadow map",
                            params.max_units));
        }
        draft.units = Placer(set, draft.merged, draft.plan).run();
        if (offsets_reach(set, draft, max_offset, merge)) return draft;
    }
}

class Emitter {
  public:
    Emitter(const SubtreeSet& set, const Draft& draft, std::uint8_t* bits)
        : set_(set), draft_(draft), bits_(bits) {}

    void run() {
        node(0, full_kind, set_.root.kinds == 0 ? no_subtree : 0, set_.levels, draft_.merged.values[0]);
        for (std::uint32_t at = 0; at < set_.subtrees.size(); ++at) {
            if (draft_.merged.stored(at)) group(at);
        }
    }

  private:
    void group(std::uint32_t at) {
        const Subtree& s = set_.subtrees[at];
        std::uint32_t value = s.first_value;
        for_each_node(set_, at, [&](std::uint32_t kind, std::uint32_t unit, std::uint32_t below) {
            std::uint32_t difference = 0;
            if (kind != empty_kind) difference = draft_.merged.values[value++] - draft_.merged.inherited[at];
            node(draft_.units[at] + unit, kind, below, s.level, difference);
        });
    }

    void node(std::uint64_t unit, std::uint32_t kind, std::uint32_t below, int height, std::uint32_t value) {
        std::uint8_t* out = bits_ + byte_of_unit(words, unit);
        if (kind >= empty_kind) {
            std::uint32_t header = 0;
            if (below != no_subtree) {
                const std::uint64_t distance = draft_.units[draft_.merged.target(below)] - unit;
                header = set_.subtrees[below].kinds |
                         static_cast<std::uint32_t>(distance / draft_.plan.scale[height]) << 8;
            }
            std::memcpy(out, &header, sizeof header);
            out += sizeof header;
        }
        if (kind != empty_kind) std::memcpy(out, &value, sizeof value);
    }

    const SubtreeSet& set_;
    const Draft& draft_;
    std::uint8_t* bits_;
};

}  // namespace

ShadowTree encode_mmh(const MultiresTree& tree, const LightView& view, const EncodeParams& params,
                      MergeStats* stats) {
    CHECK(params.offset_bits == 0 ||
          (params.offset_bits >= min_offset_bits && params.offset_bits <= offset_bits(words)));
    const SubtreeSet set = subtrees_of(
        tree, params.layout == TreeLayout::float_bits ? TreeLayout::float_bits : TreeLayout::fractions);
    const Draft draft = draft_of(set, params);
    if (stats != nullptr) *stats = draft.merged.stats;

    ShadowTree result;
    result.view = view;
    result.counts = draft.shape.counts;
    result.bytes = byte_of_unit(words, draft.plan.units);
    result.padding_bytes = byte_of_unit(words, draft.plan.padding);
    auto bits =
        std::make_shared<Buffer<std::uint8_t>>(static_cast<std::size_t>(result.bytes) + tree_slack_bytes);
    std::memset(bits->data(), 0, bits->size());
    Emitter(set, draft, bits->data()).run();

    result.code.units = bits->data();
    result.code.code = ShadowCode::mmh;
    result.code.layout = set.layout;
    result.code.levels = tree.levels;
    for (int height = 0; height <= tree.levels; ++height)
        result.code.offset_scale[height] = draft.plan.scale[height];
    result.bits = std::move(bits);
    return result;
}

ShadowTree encode_mmh(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    return encode_mmh(tree, view, params, nullptr);
}

std::string mmh_text(const ShadowTree& tree) {
    return tree.code.layout == TreeLayout::float_bits ? "differences of float bits"
                                                      : "differences of fractions";
}

}  // namespace obscura
