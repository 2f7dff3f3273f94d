// A tree of planes and edges as bits (facet_format.h).
//
// Blocks stand as in mh (hierarchy/layout_plan.h): the children of a node side by side, then the blocks of
// these, smallest first, at distances that are multiples of the scale of their height.

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/buffer.h"
#include "core/error.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

static_assert(std::endian::native == std::endian::little, "headers are written as little-endian words");

std::uint32_t units_of(std::uint32_t kinds, int children) {
    return static_cast<std::uint32_t>(std::popcount(kinds & ((1u << (3 * children)) - 1u)));
}
bool is_inner(std::uint32_t kind) {
    return (kind & facet_line) == 0 && (kind & facet_empty) != 0;
}

/// Where the blocks of a node's children stand, in units from the first child.
struct Family {
    int count = 0;
    struct Member {
        std::uint32_t unit = 0;
        std::uint64_t block = 0, start = 0, node = 0;
    } member[4];
    std::uint64_t end = 0, reach = 0;
};

/// The sizes of all blocks and the scales of all heights, from the texels up.
class Layout {
  public:
    Layout(const FacetTree& tree, std::uint64_t most_offset)
        : tree_(tree), most_offset_(most_offset), block_(tree.nodes.size(), 0) {
        collect(tree.root, tree.levels);
        for (int height = 1; height <= tree.levels; ++height)
            size_blocks(height);
        root_block = tree.root.kinds == 0 ? 0 : family_of(tree.root, scale_below(tree.levels)).end;
    }

    Family family_of(const FacetNode& node, std::uint32_t step) const {
        Family f;
        std::uint64_t child = node.first_child;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = node.child(i);
            if (kind == 0) continue;
            if (is_inner(kind)) {
                int place = f.count++;
                for (; place > 0 && f.member[place - 1].block > block_[child]; --place)
                    f.member[place] = f.member[place - 1];
                f.member[place] = {units_of(node.kinds, i), block_[child], 0, child};
            }
            ++child;
        }
        f.end = units_of(node.kinds, 4);
        for (int k = 0; k < f.count; ++k) {
            Family::Member& m = f.member[k];
            m.start = m.unit + (f.end - m.unit + step - 1) / step * step;
            f.reach = std::max(f.reach, m.start - m.unit);
            f.end = m.start + m.block;
        }
        return f;
    }
    /// Of the children of nodes of this height.
    std::uint32_t scale_below(int height) const { return height == 0 ? 1 : scale[height - 1]; }

    std::uint32_t scale[max_tree_levels + 1] = {};
    std::uint64_t root_block = 0;
    std::uint64_t node_units = 0;
    MultiresCounts counts;

  private:
    void collect(const FacetNode& node, int height) {
        if (node.kinds == 0) return;
        std::uint64_t child = node.first_child;
        node_units += units_of(node.kinds, 4);
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = node.child(i);
            if (kind == 0) continue;
            if (is_inner(kind)) {
                ++((kind & facet_leaf) != 0 ? counts.full : counts.empty);
                inner_[height - 1].push_back(child);
                collect(tree_.nodes[child], height - 1);
            } else {
                ++counts.leaf;
            }
            ++child;
        }
    }

    /// Chooses the scale of nodes of height - 1, and so the blocks of nodes of `height`.
    void size_blocks(int height) {
        std::uint32_t& s = scale[height - 1];
        for (s = 1;;) {
            std::uint64_t reach = 0;
            const auto look_at = [&](const FacetNode& node) {
                reach = std::max(reach, family_of(node, s).reach);
            };
            for (const std::uint64_t i : inner_[height])
                look_at(tree_.nodes[i]);
            if (height == tree_.levels) look_at(tree_.root);
            const std::uint64_t least = (reach + most_offset_ - 1) / most_offset_;
            if (least <= s) break;
            s = static_cast<std::uint32_t>(std::min<std::uint64_t>(least, max_tree_units));
        }
        for (const std::uint64_t i : inner_[height])
            block_[i] = family_of(tree_.nodes[i], s).end;
    }

    const FacetTree& tree_;
    const std::uint64_t most_offset_;
    std::vector<std::uint64_t> block_;  ///< of inner nodes: units
    std::vector<std::uint64_t> inner_[max_tree_levels + 1];
};

/// Planes and edges that nodes name, each once, in the order in which nodes name them.
class Tables {
  public:
    explicit Tables(const FacetTree& tree) : tree_(tree), plane_(tree.planes.size(), no_plane) {}

    std::uint32_t word_of(const FacetValue& value) {
        if (value.plane == no_plane) return value.bits;
        std::uint32_t& number = plane_[value.plane];
        if (number == no_plane) {
            number = static_cast<std::uint32_t>(planes.size());
            planes.push_back(tree_.planes[value.plane]);
            if (planes.size() > facet_most_planes)
                throw LimitError("a shadow tree has more planes than 20 bits can number");
        }
        return facet_plane_value(number, value.bits & 31u, value.bits >> 5);
    }
    std::uint32_t edge(std::uint32_t index) {
        const FacetEdge& e = tree_.edges[index];
        const auto [place, is_new] =
            edge_.try_emplace(std::tuple(e.a, e.b, e.c), static_cast<std::uint32_t>(edges.size()));
        if (is_new) edges.push_back(e);
        return place->second;
    }

    std::vector<FacetPlane> planes;
    std::vector<FacetEdge> edges;

  private:
    const FacetTree& tree_;
    std::vector<std::uint32_t> plane_;
    std::map<std::tuple<std::int32_t, std::int32_t, double>, std::uint32_t> edge_;
};

/// Writes nodes at the places that the layout gives them.
class Emitter {
  public:
    Emitter(const FacetTree& tree, const Layout& layout, Tables& tables, std::vector<std::uint32_t>& words)
        : tree_(tree), layout_(layout), tables_(tables), words_(words) {}

    void run() {
        words_[facet_header_words] = header_of(tree_.root, tree_.levels, tree_.root.kinds == 0 ? 0 : 2);
        words_[facet_header_words + 1] = tables_.word_of(tree_.root.value[0]);
        if (tree_.root.kinds != 0) group(tree_.root, tree_.levels, facet_header_words + 2);
    }

  private:
    std::uint32_t header_of(const FacetNode& node, int height, std::uint64_t distance) const {
        return node.kinds | static_cast<std::uint32_t>(distance / layout_.scale[height]) << facet_kind_bits;
    }

    /// The children of a node of this height, at unit `at`, and all below them.
    void group(const FacetNode& node, int height, std::uint64_t at) {
        const Family f = layout_.family_of(node, layout_.scale_below(height));
        std::uint64_t child = node.first_child;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = node.child(i);
            if (kind == 0) continue;
            const FacetNode& c = tree_.nodes[child];
            const std::uint32_t unit = units_of(node.kinds, i);
            std::uint32_t* out = words_.data() + at + unit;
            if ((kind & facet_line) != 0) {
                *out++ = tables_.edge(c.edge);
                if ((kind & facet_own_low) != 0) *out++ = tables_.word_of(c.value[0]);
                if ((kind & facet_own_high) != 0) *out++ = tables_.word_of(c.value[1]);
            } else {
                if (is_inner(kind)) {
                    const auto* m = std::find_if(f.member, f.member + f.count,
                                                 [&](const Family::Member& p) { return p.node == child; });
                    *out++ = header_of(c, height - 1, m->start - unit);
                    group(c, height - 1, at + m->start);
                }
                if ((kind & facet_leaf) != 0) *out++ = tables_.word_of(c.value[0]);
            }
            ++child;
        }
    }

    const FacetTree& tree_;
    const Layout& layout_;
    Tables& tables_;
    std::vector<std::uint32_t>& words_;
};

}  // namespace

ShadowTree encode_facet(const FacetTree& tree, const LightView& view, const EncodeParams& params) {
    const int bits = params.offset_bits == 0 ? facet_offset_bits : params.offset_bits;
    CHECK(bits >= min_offset_bits && bits <= facet_offset_bits);
    Layout layout(tree, (1u << bits) - 1);
    layout.scale[tree.levels] = 1;
    const std::uint64_t nodes = 2 + layout.root_block, padded = nodes + nodes % 2;
    const std::uint64_t most = std::min(params.max_units, max_tree_units);
    const auto check_units = [&](std::uint64_t units) {
        if (units > most) {
            throw LimitError(
                fmt::format("a shadow tree of {} words takes more than the {} units that lookups can "
                            "name; lower the resolution of the shadow map",
                            units, most));
        }
    };
    check_units(facet_header_words + padded);
    std::vector<std::uint32_t> words(facet_header_words + padded, 0);
    Tables tables(tree);
    Emitter(tree, layout, tables, words).run();

    FacetHeader header;
    header.nodes = static_cast<std::uint32_t>(padded);
    header.first_edge = static_cast<std::uint32_t>(words.size());
    header.edges = static_cast<std::uint32_t>(tables.edges.size());
    const std::uint64_t first_plane = words.size() + tables.edges.size() * facet_edge_words;
    const std::uint64_t units = first_plane + tables.planes.size() * facet_plane_words;
    check_units(units);
    header.first_plane = static_cast<std::uint32_t>(first_plane);
    header.planes = static_cast<std::uint32_t>(tables.planes.size());
    std::memcpy(words.data(), &header, sizeof header);

    ShadowTree result;
    result.view = view;
    result.counts = layout.counts;
    ++(tree.root.kinds == 0 ? result.counts.leaf : result.counts.full);
    result.bytes = units * 4;
    result.padding_bytes = (padded - 2 - layout.node_units) * 4;
    auto buffer =
        std::make_shared<Buffer<std::uint8_t>>(static_cast<std::size_t>(result.bytes) + tree_slack_bytes);
    std::uint8_t* out = buffer->data();
    const auto append = [&](const void* data, std::size_t bytes) {
        if (bytes != 0) std::memcpy(out, data, bytes);
        out += bytes;
    };
    append(words.data(), words.size() * sizeof words[0]);
    append(tables.edges.data(), tables.edges.size() * sizeof(FacetEdge));
    append(tables.planes.data(), tables.planes.size() * sizeof(FacetPlane));
    std::memset(out, 0, tree_slack_bytes);

    result.code.units = buffer->data();
    result.code.code = ShadowCode::facet;
    result.code.layout = TreeLayout::floats;
    result.code.levels = tree.levels;
    std::copy(std::begin(layout.scale), std::end(layout.scale), result.code.offset_scale);
    result.bits = std::move(buffer);
    return result;
}

ShadowTree encode_facet(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    return encode_facet(facet_tree_of(tree), view, params);
}

ShadowTree facet_from_mesh(const Mesh& mesh, const LightView& view, const BuildParams& params,
                           const EncodeParams& encode, BuildStats* stats, const std::atomic<bool>* cancel) {
    const FacetTree tree = build_facet_tree(mesh, view, params, encode.exec, stats, cancel);
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return {};
    return encode_facet(tree, view, encode);
}

FacetStats facet_stats(const ShadowTree& tree) {
    FacetHeader header;
    std::memcpy(&header, tree.code.units, sizeof header);
    return {header.nodes, header.edges, header.planes};
}

std::string facet_text(const ShadowTree& tree) {
    const FacetStats s = facet_stats(tree);
    return fmt::format("{} bytes of nodes, {} edges, {} planes", s.node_words * 4, s.edges, s.planes);
}

}  // namespace obscura
