// Whether a serialised tree is sound, for trees that come from outside.

#include "core/error.h"
#include "hierarchy/mh/mh.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

class Walk {
  public:
    Walk(const TreeCode& code, std::uint64_t units, const MultiresCounts& counts)
        : code_(code), unit_of_(units_of_kinds(code.layout)), units_(units), left_(counts) {}

    const char* run() {
        if (units_ > max_tree_units) return "more units than lookups can name";
        if (units_ < unit_of_[3]) return "no room for the root";
        // A bound on the walk: children that are shared cannot make it longer than the tree.
        if (left_.full > units_ || left_.empty > units_ || left_.leaf > units_) return miscounted;
        const bool inner = header_at(code_, 0).kinds != 0;
        if (!take(inner ? ChildKind::full : ChildKind::leaf)) return miscounted;
        if (!is_depth(header_units(code_.layout))) return bad_value;
        if (const char* fault = below(0, code_.levels)) return fault;
        return left_ == MultiresCounts{} ? nullptr : miscounted;
    }

  private:
    static constexpr const char* miscounted = "the number of nodes is not the one stated";
    static constexpr const char* bad_value = "a value is not a depth in [0, 1]";

    /// Counts a node; false when there are more than stated, which also ends walks through shared children.
    bool take(ChildKind kind) {
        std::uint64_t& left = kind == ChildKind::leaf    ? left_.leaf
                              : kind == ChildKind::empty ? left_.empty
                                                         : left_.full;
        return left-- > 0;
    }

    bool is_depth(std::uint64_t unit) const {
        const float depth = depth_at(code_, unit);
        return depth >= 0.0f && depth <= 1.0f;
    }

    /// What hangs below an inner node that lies inside the units.
    const char* below(std::uint64_t node, int height) {
        const TreeHeader header = header_at(code_, node);
        if (header.offset >> offset_bits(code_.layout) != 0) return "an offset has too many bits";
        if (header.kinds == 0) return nullptr;
        if (height == 0) return "a texel has children";
        const std::uint64_t group = children_of(code_, node, height, header);
        if (group <= node) return "children do not follow their parent";
        if (group + units_before(unit_of_, header.kinds, 4) > units_) return "children lie outside the tree";

        std::uint64_t unit = group;
        for (int i = 0; i < 4; ++i) {
            const auto kind = static_cast<ChildKind>(kind_of(header.kinds, i));
            if (kind == ChildKind::none) continue;
            if (!take(kind)) return miscounted;
            if (kind == ChildKind::leaf) {
                if (!is_depth(unit)) return bad_value;
            } else {
                if (height == 1) return "an inner node at the height of texels";
                if (kind == ChildKind::full && !is_depth(unit + header_units(code_.layout))) return bad_value;
                if (const char* fault = below(unit, height - 1)) return fault;
            }
            unit += unit_of_[static_cast<std::size_t>(kind)];
        }
        return nullptr;
    }

    const TreeCode& code_;
    const KindUnits unit_of_;
    const std::uint64_t units_;
    MultiresCounts left_;
};

}  // namespace

const char* mh_fault_of(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    CHECK(code.levels >= 0 && code.levels <= max_tree_levels);
    if (row_of(code.layout).layout != code.layout) return "has an unknown layout";
    if (tree.bytes % unit_bytes(code.layout) != 0) return "ends within a word";
    const std::uint64_t units = tree.bytes / unit_bytes(code.layout);
    if (const char* fault = Walk(code, units, tree.counts).run()) return fault;
    // Counts are true now, so nothing overflows here.
    const std::uint64_t padding = byte_of_unit(code.layout, units - node_units(code.layout, tree.counts));
    return padding == tree.padding_bytes ? nullptr : "has other padding than stated";
}

}  // namespace obscura
