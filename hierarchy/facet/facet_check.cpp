// Whether a tree of planes and edges is sound, for trees that come from outside.

#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/facet/facet_step.h"
#include "hierarchy/tree_units.h"

namespace obscura {
namespace {

constexpr const char* miscounted = "the number of nodes is not the one stated";
constexpr const char* bad_value = "a value is not a depth in [0, 1]";

/// Numbers that exact products with texels, and what these come to, are certain to hold.
constexpr double most_edge = 0x1p52, most_plane = 0x1p64;

class Walk {
  public:
    Walk(const ShadowTree& tree, const FacetHeader& header)
        : code_(tree.code),
          header_(header),
          left_(tree.counts),
          end_(facet_header_words + std::uint64_t{header.nodes}) {}

    const char* run() {
        // A bound on the walk: children that are shared cannot make it longer than the tree.
        if (left_.full > header_.nodes || left_.empty > header_.nodes || left_.leaf > header_.nodes)
            return miscounted;
        const std::uint32_t root = word(facet_header_words);
        if (!take((root & kinds_mask) != 0 ? facet_full : facet_leaf)) return miscounted;
        if (!is_value(facet_header_words + 1)) return bad_value;
        units_ = 2;
        if (const char* fault = below(facet_header_words, code_.levels)) return fault;
        return left_ == MultiresCounts{} ? nullptr : miscounted;
    }

    std::uint64_t units() const { return units_; }

  private:
    static constexpr std::uint32_t kinds_mask = (1u << facet_kind_bits) - 1;

    std::uint32_t word(std::uint64_t at) const {
        return FacetCode::word(code_, static_cast<std::uint32_t>(at));
    }

    bool take(std::uint32_t kind) {
        std::uint64_t& left = kind == facet_empty  ? left_.empty
                              : kind == facet_full ? left_.full
                                                   : left_.leaf;
        return left-- > 0;
    }

    bool is_value(std::uint64_t at) const {
        const std::uint32_t value = word(at);
        if ((value & facet_is_plane) != 0) return facet_plane_of(value) < header_.planes;
        const auto depth = std::bit_cast<float>(value);
        return depth >= 0.0f && depth <= 1.0f;
    }

    /// What hangs below an inner node that lies inside the units.
    const char* below(std::uint64_t node, int height) {
        const std::uint32_t head = word(node), kinds = head & kinds_mask;
        if (kinds == 0) return nullptr;
        if (height == 0) return "a texel has children";
        const std::uint64_t group =
            node + std::uint64_t{head >> facet_kind_bits} * code_.offset_scale[height];
        if (group <= node) return "children do not follow their parent";
        if (group + static_cast<unsigned>(std::popcount(kinds)) > end_)
            return "children lie outside the tree";
        units_ += static_cast<unsigned>(std::popcount(kinds));
        std::uint64_t unit = group;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = kinds >> (3 * i) & 7u;
            if (kind == 0) continue;
            if (kind == facet_line) return "a line without values of its own";
            if (!take(kind)) return miscounted;
            if (const char* fault =
                    (kind & facet_line) != 0 ? line(unit, kind) : node_at(unit, kind, height - 1))
                return fault;
            unit += static_cast<unsigned>(std::popcount(kind));
        }
        return nullptr;
    }

    const char* line(std::uint64_t at, std::uint32_t kind) const {
        if (word(at) >= header_.edges) return "an edge is not in the table";
        for (int k = 1; k < std::popcount(kind); ++k) {
            if (!is_value(at + static_cast<unsigned>(k))) return bad_value;
        }
        return nullptr;
    }

    const char* node_at(std::uint64_t at, std::uint32_t kind, int height) {
        const bool inner = (kind & facet_empty) != 0;
        if ((kind & facet_leaf) != 0 && !is_value(at + (inner ? 1 : 0))) return bad_value;
        if (!inner) return nullptr;
        if (height == 0) return "an inner node at the height of texels";
        if ((word(at) & kinds_mask) == 0) return "an inner node has no children";
        return below(at, height);
    }

    const TreeCode& code_;
    const FacetHeader& header_;
    MultiresCounts left_;
    const std::uint64_t end_;
    std::uint64_t units_ = 0;
};

const char* fault_of_tables(const TreeCode& code, const FacetHeader& header) {
    for (std::uint32_t i = 0; i < header.edges; ++i) {
        const FacetEdge e = FacetCode::edge(code, i);
        if (!(std::fabs(e.c) <= most_edge) || e.c != std::floor(e.c) || (e.a == 0 && e.b == 0) ||
            e.a == INT32_MIN || e.b == INT32_MIN)
            return "an edge means nothing";
    }
    for (std::uint32_t i = 0; i < header.planes; ++i) {
        const FacetPlane p = FacetCode::plane(code, i);
        const bool bounded =
            std::fabs(p.a) <= most_plane && std::fabs(p.b) <= most_plane && std::fabs(p.c) <= most_plane;
        if (!bounded || !(p.zmin >= 0.0f) || !(p.zmin <= p.zmax) || !(p.zmax <= 1.0f))
            return "a plane means nothing";
    }
    return nullptr;
}

}  // namespace

const char* facet_fault_of(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    CHECK(code.levels >= 0 && code.levels <= max_tree_levels);
    if (code.layout != TreeLayout::floats) return "has an unknown layout";
    if (tree.bytes % 4 != 0) return "ends within a word";
    const std::uint64_t units = tree.bytes / 4;
    if (units > max_tree_units) return "more units than lookups can name";
    if (units < facet_header_words + 2) return "no room for the root";
    const FacetHeader header = FacetCode::header(code);
    const std::uint64_t edges = facet_header_words + std::uint64_t{header.nodes};
    const std::uint64_t planes = edges + std::uint64_t{header.edges} * facet_edge_words;
    if (header.nodes < 2 || header.nodes % 2 != 0 || header.first_edge != edges ||
        header.first_plane != planes || planes + std::uint64_t{header.planes} * facet_plane_words != units ||
        header.planes > facet_most_planes || header.zero[0] != 0 || header.zero[1] != 0 ||
        header.zero[2] != 0)
        return "has a header that means nothing";
    Walk walk(tree, header);
    if (const char* fault = walk.run()) return fault;
    if (walk.units() > header.nodes || (header.nodes - walk.units()) * 4 != tree.padding_bytes)
        return "has other padding than stated";
    return fault_of_tables(code, header);
}

}  // namespace obscura
