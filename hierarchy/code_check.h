#pragma once
// Whether a serialised tree is sound, for trees that come from outside: the walk that quadtrees and octrees
// share. What it reads with is found by its code: header_at, depth_at, children_of, units_of_kinds,
// header_units, offset_bits (tree_units.h has those of quadtrees).

#include <cstddef>
#include <cstdint>

#include "hierarchy/multires.h"
#include "hierarchy/tree_units.h"

namespace obscura {

/// What faults are called that a code has words of its own for.
struct CodeFaults {
    const char* too_many;  ///< units
    const char* outside;   ///< children
};

/// Of nodes with `fan` children. `Possible`: the bits of the kinds that children of a node of a height may
/// have.
template <int fan, class Code, class Possible>
class CodeCheck {
  public:
    CodeCheck(const Code& code, std::uint64_t units, const MultiresCounts& counts, const CodeFaults& faults,
              Possible possible)
        : code_(code),
          unit_of_(units_of_kinds(code.layout)),
          units_(units),
          left_(counts),
          faults_(faults),
          possible_(possible) {}

    /// What is wrong with a tree whose root has this height, or null.
    const char* run(int levels) {
        if (units_ > max_tree_units) return faults_.too_many;
        if (units_ < unit_of_[3]) return "no room for the root";
        // A bound on the walk: children that are shared cannot make it longer than the tree.
        if (left_.full > units_ || left_.empty > units_ || left_.leaf > units_) return miscounted;
        const bool inner = header_at(code_, 0).kinds != 0;
        if (!take(inner ? ChildKind::full : ChildKind::leaf)) return miscounted;
        if (!is_depth(header_units(code_.layout))) return bad_value;
        if (const char* fault = below(0, levels)) return fault;
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
        const auto header = header_at(code_, node);
        if (header.offset >> offset_bits(code_.layout) != 0) return "an offset has too many bits";
        if (header.kinds == 0) return nullptr;
        if (height == 0) return "a texel has children";
        if ((header.kinds & ~possible_(height)) != 0) return "a child on an axis that is not divided";
        const std::uint64_t group = children_of(code_, node, height, header);
        if (group <= node) return "children do not follow their parent";
        if (group > units_ || group + units_before(unit_of_, header.kinds, fan) > units_)
            return faults_.outside;

        std::uint64_t unit = group;
        for (int i = 0; i < fan; ++i) {
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

    const Code& code_;
    const KindUnits unit_of_;
    const std::uint64_t units_;
    MultiresCounts left_;
    const CodeFaults faults_;
    const Possible possible_;
};

template <int fan, class Code, class Possible>
const char* check_code(const Code& code, int levels, std::uint64_t units, const MultiresCounts& counts,
                       const CodeFaults& faults, Possible possible) {
    return CodeCheck<fan, Code, Possible>(code, units, counts, faults, possible).run(levels);
}

}  // namespace obscura
