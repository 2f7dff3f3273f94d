// Whether a merged tree is sound, for trees that come from outside.
//
// A group may be pointed to from many nodes, so walks through all ways could be longer than the file by any
// factor: each group is looked at once, and what the ways through it need to know is kept: how high it
// reaches, and how far the sums of its differences go.

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "hierarchy/mmh/mmh.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr TreeLayout words = TreeLayout::words24;  // whose nodes these are
constexpr KindUnits unit_of = units_of_kinds(words);
constexpr std::int64_t bits_of_one = 0x3f800000;

constexpr const char* miscounted = "the number of nodes is not the one stated";
constexpr const char* bad_value = "a value is not a depth in [0, 1]";

class Walk {
  public:
    Walk(const TreeCode& code, std::uint64_t units) : code_(code), units_(units), known_(units, not_known) {}

    const char* run() {
        if (units_ < unit_of[3]) return "no room for the root";
        const std::uint32_t kinds = word(0) & 0xffu;
        count(kinds == 0 ? ChildKind::leaf : ChildKind::full);
        Group below;
        if (const char* fault = visit_below(0, code_.levels, below)) return fault;
        const std::int64_t root = difference(1);
        const bool depths = root >= 0 && root + std::min<std::int64_t>(below.least, 0) >= 0 &&
                            root + std::max<std::int64_t>(below.greatest, 0) <= bits_of_one;
        if (code_.layout == TreeLayout::float_bits && !depths) return bad_value;
        return nullptr;
    }

    MultiresCounts counts;

  private:
    /// What hangs below a node, and what is known of it.
    struct Group {
        std::uint32_t kinds = 0;
        int level = 0;                         ///< height of its nodes where it was met first
        int height = 0;                        ///< groups on its longest way down
        std::int64_t least = 0, greatest = 0;  ///< sums of differences on ways into it
    };
    static constexpr std::uint32_t not_known = 0xffffffffu;

    std::uint32_t word(std::uint64_t unit) const {
        std::uint32_t bits;
        std::memcpy(&bits, code_.units + byte_of_unit(words, unit), sizeof bits);
        return bits;
    }
    std::int64_t difference(std::uint64_t unit) const { return static_cast<std::int32_t>(word(unit)); }
    void count(ChildKind kind) {
        ++(kind == ChildKind::leaf ? counts.leaf : kind == ChildKind::empty ? counts.empty : counts.full);
    }

    /// The group that an inner node of this height, inside the units, points to.
    const char* visit_below(std::uint64_t node, int height, Group& below) {
        const std::uint32_t header = word(node), kinds = header & 0xffu;
        if (kinds == 0) return nullptr;
        if (height == 0) return "a texel has children";
        const std::uint64_t at = node + std::uint64_t{header >> 8} * code_.offset_scale[height];
        if (at <= node) return "children do not follow their parent";
        if (at + units_before(unit_of, kinds, 4) > units_) return "children lie outside the tree";
        if (known_[at] == not_known) {
            Group group;
            group.kinds = kinds;
            group.level = height - 1;
            if (const char* fault = visit(at, group)) return fault;
            known_[at] = static_cast<std::uint32_t>(groups_.size());
            groups_.push_back(group);
        }
        below = groups_[known_[at]];
        if (below.kinds != kinds) return "shared children are of different kinds";
        if (below.height > height) return "an inner node at the height of texels";
        // Offsets inside must mean the same from here as from where the group was met first.
        for (int k = 0; k + 1 < below.height; ++k) {
            if (code_.offset_scale[height - 1 - k] != code_.offset_scale[below.level - k])
                return "shared children have different scales";
        }
        return nullptr;
    }

    const char* visit(std::uint64_t at, Group& group) {
        std::uint64_t unit = at;
        for (int i = 0; i < 4; ++i) {
            const auto kind = static_cast<ChildKind>(kind_of(group.kinds, i));
            if (kind == ChildKind::none) continue;
            count(kind);
            std::int64_t own = 0;
            if (kind != ChildKind::empty) own = difference(unit + (kind == ChildKind::full ? 1 : 0));
            Group below;
            if (kind != ChildKind::leaf) {
                if (group.level == 0) return "an inner node at the height of texels";
                if ((word(unit) & 0xffu) == 0) return "an inner node has no children";
                if (const char* fault = visit_below(unit, group.level, below)) return fault;
            }
            group.height = std::max(group.height, below.height + 1);
            group.least = std::min({group.least, own, own + below.least});
            group.greatest = std::max({group.greatest, own, own + below.greatest});
            unit += unit_of[static_cast<std::size_t>(kind)];
        }
        return nullptr;
    }

    const TreeCode& code_;
    const std::uint64_t units_;
    std::vector<std::uint32_t> known_;  ///< by first unit: index in groups_
    std::vector<Group> groups_;
};

}  // namespace

const char* mmh_fault_of(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    CHECK(code.levels >= 0 && code.levels <= max_tree_levels);
    if (code.layout != TreeLayout::fractions && code.layout != TreeLayout::float_bits)
        return "has an unknown layout";
    if (tree.bytes % unit_bytes(words) != 0) return "ends within a word";
    const std::uint64_t units = tree.bytes / unit_bytes(words);
    if (units > max_tree_units) return "more units than lookups can name";
    Walk walk(code, units);
    if (const char* fault = walk.run()) return fault;
    if (!(walk.counts == tree.counts)) return miscounted;
    // Overlapping groups would have more nodes than there is room for.
    const std::uint64_t used = node_units(words, tree.counts);
    if (used > units || byte_of_unit(words, units - used) != tree.padding_bytes)
        return "has other padding than stated";
    return nullptr;
}

}  // namespace obscura
