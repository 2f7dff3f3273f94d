// Serialises a quadtree.
//
// L. Scandolo, P. Bauszat, E. Eisemann, "Compressed Multiresolution Hierarchies for High-Quality Precomputed
// Shadows", Eurographics 2016, section 3.2. Where blocks go is decided in layout_plan.h; here they are
// filled. The authors' code writes a tree of one node as a leaf that its readers take for a full node; here
// the root is a full node always.

#include "hierarchy/mh/mh.h"

#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "hierarchy/layout_plan.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "headers are written as little-endian words");

/// Writes groups, left to right, at the places that the plan gives them.
class Emitter {
  public:
    Emitter(const MultiresTree& tree, TreeLayout layout, const LayoutPlan& plan, std::uint8_t* bits)
        : tree_(tree), layout_(layout), plan_(plan), units_(units_of_kinds(layout)), bits_(bits) {}

    void run() {
        // The parent that stands above the root: a group of one full node, at unit 0.
        group(&tree_.root, static_cast<std::uint32_t>(ChildKind::full), tree_.levels, 0);
        std::memset(bits_ + byte_of_unit(layout_, plan_.units), 0, tree_slack_bytes);
    }

  private:
    /// Siblings of this height at unit `at`, and all below them.
    void group(const MultiresNode* siblings, std::uint32_t kinds, int height, std::uint64_t at) {
        const Family family = family_of<4>(units_, kinds, plan_.blocks[height].data() + next_[height]);
        next_[height] += static_cast<std::size_t>(family.inner);
        const Placement placement = place(family, plan_.scale[height]);

        std::uint64_t block_of[4] = {}, end = family.group_units;
        for (int m = 0; m < family.count; ++m) {
            block_of[family.member[m].child] = placement.start[m];
            clear(at + end, at + placement.start[m]);
            end = placement.start[m] + family.member[m].block;
        }

        const MultiresNode* node = siblings;
        std::uint64_t unit = 0;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = kind_of(kinds, i);
            if (kind == 0) continue;
            write(at + unit, kind, *node, block_of[i] == 0 ? 0 : block_of[i] - unit, height);
            if (block_of[i] != 0) {
                group(tree_.nodes.data() + node->first_child(), node->kinds, height - 1, at + block_of[i]);
            }
            unit += units_[kind];
            ++node;
        }
    }

    void write(std::uint64_t unit, std::uint32_t kind, const MultiresNode& node, std::uint64_t distance,
               int height) {
        std::uint8_t* out = bits_ + byte_of_unit(layout_, unit);
        if (kind != static_cast<std::uint32_t>(ChildKind::leaf)) {
            const std::size_t size = byte_of_unit(layout_, header_units(layout_));
            const std::uint32_t scale = plan_.scale[height];
            const std::uint64_t offset = scale == 1 ? distance : distance / scale;
            const std::uint32_t header = node.kinds | static_cast<std::uint32_t>(offset) << 8;
            std::memcpy(out, &header, size);
            out += size;
        }
        if (kind != static_cast<std::uint32_t>(ChildKind::empty)) {
            std::memcpy(out, &node.value, sizeof node.value);
        }
    }

    void clear(std::uint64_t from, std::uint64_t to) {
        if (from == to) return;
        const std::size_t first = byte_of_unit(layout_, from);
        std::memset(bits_ + first, 0, byte_of_unit(layout_, to) - first);
    }

    const MultiresTree& tree_;
    const TreeLayout layout_;
    const LayoutPlan& plan_;
    const KindUnits units_;
    std::uint8_t* bits_;
    std::size_t next_[max_tree_levels + 1] = {};  ///< by height: inner nodes that were met
};

/// The layout asked for, or the next wider one whose offsets reach at a bearable price.
std::pair<TreeLayout, LayoutPlan> choose_layout(const TreeShape& shape, const EncodeParams& params) {
    for (TreeLayout layout = params.layout;; layout = row_of(layout).wider) {
        const int bits = params.offset_bits == 0 ? offset_bits(layout) : params.offset_bits;
        LayoutPlan plan = plan_layout<4>(shape, units_of_kinds(layout), (1u << bits) - 1, params.max_units);
        const bool widest = row_of(layout).wider == layout;
        if (!plan.fits && widest) {
            throw LimitError(
                fmt::format("a shadow tree of {} nodes takes more than the {} units that "
                            "lookups can name; lower the resolution of the shadow map",
                            shape.counts.full + shape.counts.empty + shape.counts.leaf, params.max_units));
        }
        const double share =
            static_cast<double>(plan.padding) / static_cast<double>(plan.units - plan.padding);
        if (plan.fits && (widest || share <= params.bearable_padding)) return {layout, std::move(plan)};
    }
}

}  // namespace

ShadowTree encode_mh(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    CHECK(params.offset_bits == 0 ||
          (params.offset_bits >= min_offset_bits && params.offset_bits <= offset_bits(params.layout)));
    const TreeShape shape = shape_of<4>(tree);
    const auto [layout, plan] = choose_layout(shape, params);

    ShadowTree result;
    result.view = view;
    result.counts = shape.counts;
    result.bytes = byte_of_unit(layout, plan.units);
    result.padding_bytes = byte_of_unit(layout, plan.padding);
    auto bits =
        std::make_shared<Buffer<std::uint8_t>>(static_cast<std::size_t>(result.bytes) + tree_slack_bytes);
    Emitter(tree, layout, plan, bits->data()).run();

    result.code.units = bits->data();
    result.code.layout = layout;
    result.code.levels = tree.levels;
    for (int height = 0; height <= tree.levels; ++height)
        result.code.offset_scale[height] = plan.scale[height];
    result.bits = std::move(bits);
    return result;
}

}  // namespace obscura
