// Where blocks go is decided in hierarchy/layout_plan.h; here they are filled.

#include "hierarchy/stack/encode.h"

#include <cstring>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "hierarchy/layout_plan.h"
#include "hierarchy/stack/stack_units.h"

namespace obscura {
namespace {

constexpr auto leaf_kind = static_cast<std::uint32_t>(ChildKind::leaf);
constexpr auto empty_kind = static_cast<std::uint32_t>(ChildKind::empty);
constexpr auto full_kind = static_cast<std::uint32_t>(ChildKind::full);

/// Writes groups, left to right, at the places that the plan gives them.
class Emitter {
  public:
    Emitter(const MultiresTree& tree, StackLayout layout, const LayoutPlan& plan, std::uint32_t* words)
        : tree_(tree), layout_(layout), plan_(plan), units_(units_of_kinds(layout)), words_(words) {}

    /// The parent that stands above the root: a group of one full node, at word 0.
    void run() { group(&tree_.root, full_kind, tree_.levels, 0); }

  private:
    /// Siblings of this height at word `at`, and all below them.
    void group(const MultiresNode* siblings, std::uint32_t kinds, int height, std::uint64_t at) {
        const FamilyOf<8> family = family_of<8>(units_, kinds, plan_.blocks[height].data() + next_[height]);
        next_[height] += static_cast<std::size_t>(family.inner);
        const Placement placement = place(family, plan_.scale[height]);

        std::uint64_t block_of[8] = {}, end = family.group_units;
        for (int m = 0; m < family.count; ++m) {
            block_of[family.member[m].child] = placement.start[m];
            std::memset(words_ + at + end, 0, (placement.start[m] - end) * sizeof *words_);
            end = placement.start[m] + family.member[m].block;
        }

        const MultiresNode* node = siblings;
        std::uint64_t unit = 0;
        for (int i = 0; i < 8; ++i) {
            const std::uint32_t kind = kind_of(kinds, i);
            if (kind == 0) continue;
            write(at + unit, kind, *node, block_of[i] == 0 ? 0 : block_of[i] - unit, height);
            if (block_of[i] != 0)
                group(tree_.nodes.data() + node->first_child(), node->kinds, height - 1, at + block_of[i]);
            unit += units_[kind];
            ++node;
        }
    }

    void write(std::uint64_t word, std::uint32_t kind, const MultiresNode& node, std::uint64_t distance,
               int height) {
        std::uint32_t* out = words_ + word;
        if (kind != leaf_kind) {
            const std::uint64_t offset = distance / plan_.scale[height];
            *out++ = (node.kinds & 0xffffu) | static_cast<std::uint32_t>(offset & 0xffffu) << 16;
            if (layout_ == StackLayout::wide) *out++ = static_cast<std::uint32_t>(offset >> 16);
        }
        if (kind != empty_kind) std::memcpy(out, &node.value, sizeof node.value);
    }

    const MultiresTree& tree_;
    const StackLayout layout_;
    const LayoutPlan& plan_;
    const KindUnits units_;
    std::uint32_t* words_;
    std::size_t next_[max_tree_levels + 1] = {};  ///< by height: inner nodes that were met
};

/// The narrow layout, or the wide one where its offsets do not reach at a bearable price.
std::pair<StackLayout, LayoutPlan> choose_layout(const TreeShapeOf<8>& shape,
                                                 const StackEncodeParams& params) {
    for (StackLayout layout = params.layout;; layout = StackLayout::wide) {
        const int bits =
            params.offset_bits == 0 || layout != params.layout ? offset_bits(layout) : params.offset_bits;
        LayoutPlan plan = plan_layout<8>(shape, units_of_kinds(layout), (1u << bits) - 1, params.max_units);
        const bool widest = layout == StackLayout::wide;
        if (!plan.fits && widest) {
            throw LimitError(
                fmt::format("a stack of shadow maps of {} nodes takes more than the {} words that lookups "
                            "can name; lower the "
                            "resolution or the number of its maps",
                            shape.counts.full + shape.counts.empty + shape.counts.leaf, params.max_units));
        }
        const double share =
            static_cast<double>(plan.padding) / static_cast<double>(plan.units - plan.padding);
        if (plan.fits && (widest || share <= params.bearable_padding)) return {layout, std::move(plan)};
    }
}

/// Appends what hangs below a node, children before parents; returns the node without its value.
MultiresNode decode_below(const StackCode& code, std::uint64_t node, int height, MultiresTree& tree) {
    const StackHeader header = header_at(code, node);
    const KindUnits units = units_of_kinds(code.layout);
    std::uint64_t unit = children_of(code, node, height, header);
    MultiresNode group[8];
    int count = 0;
    for (int i = 0; i < 8; ++i) {
        const std::uint32_t kind = kind_of(header.kinds, i);
        if (kind == 0) continue;
        MultiresNode& child = group[count++];
        if (kind != leaf_kind) child = decode_below(code, unit, height - 1, tree);
        if (kind != empty_kind)
            child.value = depth_at(code, kind == leaf_kind ? unit : unit + header_units(code.layout));
        unit += units[kind];
    }
    const MultiresNode result(0, header.kinds, tree.nodes.size());
    tree.nodes.insert(tree.nodes.end(), group, group + count);
    return result;
}

}  // namespace

void encode_stack(const StackTree& tree, const StackEncodeParams& params, ShadowStack& stack) {
    CHECK(params.offset_bits == 0 ||
          (params.offset_bits >= 5 && params.offset_bits <= offset_bits(params.layout)));
    const TreeShapeOf<8> shape = shape_of<8>(tree.tree);
    const auto [layout, plan] = choose_layout(shape, params);
    stack.counts = shape.counts;
    stack.bytes = plan.units * sizeof(std::uint32_t);
    stack.padding_bytes = plan.padding * sizeof(std::uint32_t);
    auto words = std::make_shared<Buffer<std::uint32_t>>(static_cast<std::size_t>(plan.units));
    Emitter(tree.tree, layout, plan, words->data()).run();

    stack.code = {};
    stack.code.words = words->data();
    stack.code.layout = layout;
    stack.code.shape = tree.shape;
    for (int height = 0; height <= tree.tree.levels; ++height)
        stack.code.offset_scale[height] = plan.scale[height];
    stack.bits = std::move(words);
}

MultiresTree decode_stack(const ShadowStack& stack) {
    MultiresTree tree;
    tree.dimensions = 3;
    tree.levels = stack.code.shape.levels();
    tree.root = decode_below(stack.code, 0, tree.levels, tree);
    tree.root.value = depth_at(stack.code, header_units(stack.code.layout));
    tree.root_interval = {tree.root.value, tree.root.value};
    return tree;
}

float stack_value(const StackCode& code, std::uint32_t x, std::uint32_t y, std::uint32_t k) {
    const StackShape& shape = code.shape;
    const KindUnits units = units_of_kinds(code.layout);
    std::uint64_t node = 0, value = header_units(code.layout);
    for (int height = shape.levels(); height > 0; --height) {
        int i = 0;
        if (shape.divides_map(height)) {
            const int bit = shape.side_exponent(height - 1);
            i = static_cast<int>((x >> bit & 1u) + 2 * (y >> bit & 1u));
        }
        if (shape.divides_slices(height))
            i += static_cast<int>(4 * (k >> shape.slices_exponent(height - 1) & 1u));
        const StackHeader header = header_at(code, node);
        const std::uint32_t kind = kind_of(header.kinds, i);
        if (kind == 0) break;
        const std::uint64_t child =
            children_of(code, node, height, header) + units_before(units, header.kinds, i);
        if (kind == leaf_kind) return depth_at(code, child);
        if (kind == full_kind) value = child + header_units(code.layout);
        node = child;
    }
    return depth_at(code, value);
}

}  // namespace obscura
