#include "hierarchy/stack/stack_check.h"

#include "core/error.h"
#include "hierarchy/stack/stack_units.h"

namespace obscura {
namespace {

class Walk {
  public:
    Walk(const StackCode& code, std::uint64_t words, const MultiresCounts& counts)
        : code_(code), unit_of_(units_of_kinds(code.layout)), words_(words), left_(counts) {}

    const char* run() {
        if (words_ > max_tree_units) return "more words than lookups can name";
        if (words_ < unit_of_[3]) return "no room for the root";
        // A bound on the walk: children that are shared cannot make it longer than the octree.
        if (left_.full > words_ || left_.empty > words_ || left_.leaf > words_) return miscounted;
        const bool inner = header_at(code_, 0).kinds != 0;
        if (!take(inner ? ChildKind::full : ChildKind::leaf)) return miscounted;
        if (!is_depth(header_units(code_.layout))) return bad_value;
        if (const char* fault = below(0, code_.shape.levels())) return fault;
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

    bool is_depth(std::uint64_t word) const {
        const float depth = depth_at(code_, word);
        return depth >= 0.0f && depth <= 1.0f;
    }

    /// Kinds of the children that a node of this height can have.
    std::uint32_t possible(int height) const {
        std::uint32_t kinds = 0xffff;
        if (!code_.shape.divides_map(height)) kinds &= 0x0303;
        if (!code_.shape.divides_slices(height)) kinds &= 0x00ff;
        return kinds;
    }

    /// What hangs below an inner node that lies inside the words.
    const char* below(std::uint64_t node, int height) {
        const StackHeader header = header_at(code_, node);
        if (header.offset >> offset_bits(code_.layout) != 0) return "an offset has too many bits";
        if (header.kinds == 0) return nullptr;
        if (height == 0) return "a texel has children";
        if ((header.kinds & ~possible(height)) != 0) return "a child on an axis that is not divided";
        const std::uint64_t group = children_of(code_, node, height, header);
        if (group <= node) return "children do not follow their parent";
        if (group > words_) return outside;
        std::uint64_t end = group;
        for (int i = 0; i < 8; ++i)
            end += unit_of_[kind_of(header.kinds, i)];
        if (end > words_) return outside;

        std::uint64_t word = group;
        for (int i = 0; i < 8; ++i) {
            const auto kind = static_cast<ChildKind>(kind_of(header.kinds, i));
            if (kind == ChildKind::none) continue;
            if (!take(kind)) return miscounted;
            if (kind == ChildKind::leaf) {
                if (!is_depth(word)) return bad_value;
            } else {
                if (height == 1) return "an inner node at the height of texels";
                if (kind == ChildKind::full && !is_depth(word + header_units(code_.layout))) return bad_value;
                if (const char* fault = below(word, height - 1)) return fault;
            }
            word += unit_of_[static_cast<std::size_t>(kind)];
        }
        return nullptr;
    }

    static constexpr const char* outside = "children lie outside the octree";

    const StackCode& code_;
    const KindUnits unit_of_;
    const std::uint64_t words_;
    MultiresCounts left_;
};

}  // namespace

const char* fault_of(const StackShape& shape) {
    if (shape.map_levels < 0 || shape.map_levels > max_tree_levels) return "too many texels a side";
    if (shape.slice_levels < 0 || shape.slice_levels > max_slice_levels) return "too many maps";
    if (shape.anisotropy < -shape.slice_levels || shape.anisotropy > shape.map_levels)
        return "an anisotropy that its maps have no room for";
    return shape.levels() > max_tree_levels ? "too many levels" : nullptr;
}

const char* fault_of(const StackCode& code, std::uint64_t words, const MultiresCounts& counts) {
    CHECK(fault_of(code.shape) == nullptr);
    return Walk(code, words, counts).run();
}

}  // namespace obscura
