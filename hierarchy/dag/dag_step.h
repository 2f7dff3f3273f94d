#pragma once
// One step down a tree of the code dag (dag_format.h), and the value that its number stands for. POD: kernels
// include this.
//
// L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow Maps", High-Performance
// Graphics 2021, section 3.5 and algorithms 1 and 2. Errata: algorithm 2 takes a bit of a chunk that is set
// for a factor, the text for the representative (here: a factor); its index counts the bits below, not up to
// it; algorithm 1 adds one to a count of bits that has it already, or leaves out the value of a full node
// above, which neither it nor the text counts. Treelets are gone down from the top, level by level, since a
// lookup may stop at any; the shift of coordinates is that of the node's height, so that a treelet which
// reaches below the texels is never asked for what it cannot hold.

#include <cstdint>

#include "hierarchy/dag/dag_format.h"
#include "hierarchy/fixed_depth.h"
#include "hierarchy/tree_code.h"

namespace obscura {

struct DagCode {
    static constexpr std::uint32_t unit_bytes = 4;
    static constexpr bool counts_values = true;
    static constexpr bool varies = false;

    static OBSCURA_TREE_INLINE std::uint32_t bytes_at(const TreeCode& tree, std::uint64_t byte) {
        std::uint32_t bits;
        __builtin_memcpy(&bits, tree.units + byte, sizeof bits);
        return bits;
    }
    static OBSCURA_TREE_INLINE std::uint32_t word(const TreeCode& tree, std::uint32_t at) {
        return bytes_at(tree, static_cast<std::uint64_t>(at) * unit_bytes);
    }
    static OBSCURA_TREE_INLINE DagHeader header(const TreeCode& tree) {
        DagHeader header;
        __builtin_memcpy(&header, tree.units, sizeof header);
        return header;
    }

    static OBSCURA_TREE_INLINE DagForm form_of(const TreeCode& tree) {
        return DagForm::of(header(tree).form);
    }

    static OBSCURA_TREE_INLINE TreePlace root(const TreeCode& tree) {
        return {dag_header_words << (2 - form_of(tree).unit_log2()), 0, 1, 0};
    }

    static OBSCURA_TREE_INLINE TreePlace child(const TreeCode& tree, TreePlace at, int height, std::int32_t x,
                                               std::int32_t y) {
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): no descent goes below height 1
        const int i = (x >> (height - 1) & 1) + (y >> (height - 1) & 1) * 2;
        return at.inside != 0 ? child_in_treelet(tree, at, i) : child_of_node(tree, at, i);
    }

    static OBSCURA_TREE_INLINE float depth(const TreeCode& tree, TreePlace place) {
        return depth_of_fixed(tree.layout, number_of(tree, place.value));
    }

    /// So many bytes, 1 to 4.
    static OBSCURA_TREE_INLINE std::uint32_t number_at(const TreeCode& tree, std::uint64_t byte,
                                                       std::uint32_t size) {
        return bytes_at(tree, byte) & (0xffffffffu >> (32 - 8 * size));
    }

    /// A packed node, and where its parts are: bytes.
    struct PackedNode {
        std::uint32_t kinds, existing, children;  ///< existing: a bit for each child, at its kind's first
        std::uint32_t count_bytes, pointer_bytes;
        std::uint64_t counts, pointers, end;
    };
    static OBSCURA_TREE_INLINE PackedNode packed_node_at(const TreeCode& tree, std::uint32_t node) {
        const std::uint32_t head = bytes_at(tree, node), kinds = head & 0xffu;
        PackedNode n;
        n.kinds = kinds;
        n.existing = (kinds | kinds >> 1) & 0x55u;
        n.children = static_cast<std::uint32_t>(__builtin_popcount(n.existing));
        n.pointer_bytes = (head >> 8 & 3u) + 1;
        n.count_bytes = (head >> 10 & 3u) + 1;
        n.counts = std::uint64_t{node} + packed_node_bytes;
        n.pointers = n.counts + (n.children == 0 ? 0 : n.children - 1) * n.count_bytes;
        n.end = n.pointers + n.children * n.pointer_bytes;
        return n;
    }
    /// Where pointer `index` of a packed node leads.
    static OBSCURA_TREE_INLINE std::uint32_t packed_target(const TreeCode& tree, DagForm form,
                                                           std::uint32_t node, const PackedNode& n,
                                                           std::uint32_t index, bool treelet) {
        const std::uint32_t place = number_at(tree, n.pointers + index * n.pointer_bytes, n.pointer_bytes);
        return treelet ? (header(tree).first_treelet + place * treelet_words(form.treelet_levels)) * 4
                       : node + place;
    }

    /// A child, and how many values below its parent stand before its own.
    struct Child {
        std::uint32_t kind, unit, before;
    };
    static OBSCURA_TREE_INLINE Child packed_child_at(const TreeCode& tree, DagForm form, std::uint32_t node,
                                                     int i) {
        const PackedNode n = packed_node_at(tree, node);
        const std::uint32_t kind = n.kinds >> (2 * i) & 3u;
        if (kind == 0) return {0, 0, 0};
        const auto index =
            static_cast<std::uint32_t>(__builtin_popcount(n.existing & ((1u << (2 * i)) - 1u)));
        return {
            kind,
            packed_target(tree, form, node, n, index, kind == static_cast<std::uint32_t>(DagKind::treelet)),
            index == 0 ? 0 : number_at(tree, n.counts + (index - 1) * n.count_bytes, n.count_bytes)};
    }
    static OBSCURA_TREE_INLINE Child child_at(const TreeCode& tree, DagForm form, std::uint32_t node, int i) {
        const std::uint32_t kinds = word(tree, node) & 0xffu;
        Child child{kinds >> (2 * i) & 3u, 0, 0};
        if (child.kind == 0) return child;
        // The siblings before it, each with what is below it.
        std::uint32_t pointer = node + form.node_words();
        for (int k = 0; k < i; ++k) {
            const std::uint32_t other = kinds >> (2 * k) & 3u;
            if (other == 0) continue;
            const std::uint32_t sibling = word(tree, pointer++), head = word(tree, sibling);
            child.before += other == static_cast<std::uint32_t>(DagKind::treelet)
                                ? head & treelet_count_mask
                                : (form.wide ? word(tree, sibling + 1) : head >> 8) + (other & 1u);
        }
        child.unit = word(tree, pointer);
        return child;
    }

    static OBSCURA_TREE_INLINE TreePlace child_of_node(const TreeCode& tree, TreePlace at, int i) {
        const DagForm form = form_of(tree);
        const Child child =
            form.packed ? packed_child_at(tree, form, at.node, i) : child_at(tree, form, at.node, i);
        if (child.kind == 0) return {no_tree_node, at.value, at.count, 0};
        const std::uint32_t count = at.count + child.before;
        if (child.kind != static_cast<std::uint32_t>(DagKind::treelet)) {
            const bool own = child.kind == static_cast<std::uint32_t>(DagKind::full);
            return {child.unit, own ? count : at.value, count + (own ? 1u : 0u), 0};
        }
        const std::uint32_t head = bytes_at(tree, std::uint64_t{child.unit} << form.unit_log2());
        const std::uint32_t own = head >> treelet_count_bits & 1u;
        const bool more = (head & treelet_count_mask) > own;
        return {more ? child.unit : no_tree_node, own != 0 ? count : at.value, count,
                more ? inside_of(0, form.treelet_levels - 1) : 0};
    }

    /// Bits of a treelet before that of a node.
    static OBSCURA_TREE_INLINE std::uint32_t values_before(const TreeCode& tree, std::uint64_t first_byte,
                                                           std::uint32_t position) {
        const std::uint32_t end = treelet_count_bits + position;
        std::uint32_t count = 0;
        for (std::uint32_t begin = 0; begin < end; begin += 32) {
            std::uint32_t bits = bytes_at(tree, first_byte + begin / 8);
            if (begin == 0) bits &= ~treelet_count_mask;
            if (end - begin < 32) bits &= (1u << (end - begin)) - 1u;
            count += static_cast<std::uint32_t>(__builtin_popcount(bits));
        }
        return count;
    }

    static OBSCURA_TREE_INLINE TreePlace child_in_treelet(const TreeCode& tree, TreePlace at, int i) {
        const int below = static_cast<int>(at.inside >> 9 & 7u);
        // The full trees of the siblings before it.
        const std::uint32_t nodes = full_tree_nodes(below);
        const std::uint32_t position = (at.inside & 511u) + 1 + static_cast<std::uint32_t>(i) * nodes;
        const std::uint32_t bit = treelet_count_bits + position;
        const std::uint64_t first_byte = std::uint64_t{at.node} << form_of(tree).unit_log2();
        const std::uint32_t window = bytes_at(tree, first_byte + bit / 8) >> (bit % 8);
        if ((window & 1u) != 0) at.value = at.count + values_before(tree, first_byte, position);
        const bool more = nodes > treelet_window || (window & ((1u << nodes) - 2u)) != 0;
        return {more ? at.node : no_tree_node, at.value, at.count, more ? inside_of(position, below - 1) : 0};
    }

    /// Algorithm 2: the whole number (hierarchy/fixed_depth.h) that is value `index`.
    static OBSCURA_TREE_INLINE std::uint32_t number_of(const TreeCode& tree, std::uint32_t index) {
        const DagHeader head = header(tree);
        const DagForm form = DagForm::of(head.form);
        const std::uint64_t record = std::uint64_t{head.first_chunk} * 4 +
                                     std::uint64_t{index >> form.chunk_log2} * form.chunk_bytes();
        const std::uint32_t in_chunk = index & ((1u << form.chunk_log2) - 1u);
        if (form.packed)
            return packed_number_of(tree, form, std::uint64_t{head.first_factor} * 4 + bytes_at(tree, record),
                                    in_chunk);
        std::uint64_t at = record + 16;
        std::uint32_t before = 0;
        for (std::uint32_t k = 0; k < in_chunk / 32; ++k, at += 4)
            before += static_cast<std::uint32_t>(__builtin_popcount(bytes_at(tree, at)));
        const std::uint32_t bits = bytes_at(tree, at);
        if ((bits >> in_chunk % 32 & 1u) == 0) return bytes_at(tree, record);
        before += static_cast<std::uint32_t>(__builtin_popcount(bits & ((1u << in_chunk % 32) - 1u)));
        const std::uint32_t first = bytes_at(tree, record + 12), bytes = (first & 3u) + 1;
        const std::uint32_t factor =
            bytes_at(tree, std::uint64_t{head.first_factor} * 4 + (first >> 2) + before * bytes) &
            (0xffffffffu >> (32 - 8 * bytes));
        return bytes_at(tree, record + 4) + bytes_at(tree, record + 8) * factor;
    }

    /// So many bits, up to 32, from a bit on.
    static OBSCURA_TREE_INLINE std::uint32_t bits_from(const TreeCode& tree, std::uint64_t first_byte,
                                                       std::uint32_t bit, std::uint32_t width) {
        if (width == 0) return 0;
        const std::uint64_t byte = first_byte + bit / 8;
        std::uint32_t bits = bytes_at(tree, byte) >> bit % 8;
        // The next byte's word overlaps; what both have is the same.
        if (width > 25) bits |= bytes_at(tree, byte + 1) << (8 - bit % 8);
        return bits & (0xffffffffu >> (32 - width));
    }

    /// The value at place `in` of a packed chunk.
    static OBSCURA_TREE_INLINE std::uint32_t packed_number_of(const TreeCode& tree, DagForm form,
                                                              std::uint64_t chunk, std::uint32_t in) {
        const std::uint32_t head = bytes_at(tree, chunk), classes = (head & 3u) + 1;
        const std::uint32_t plane_bytes = (1u << form.chunk_log2) / 8;
        const std::uint64_t planes = chunk + packed_head_bytes + classes * packed_class_bytes;
        // Which class it is of, and how many of each stand before it.
        std::uint32_t own = 0, low = 0, high = 0, both = 0;
        for (std::uint32_t begin = 0; begin <= in && classes > 1; begin += 32) {
            const std::uint32_t below = in - begin < 32 ? (1u << (in - begin)) - 1u : 0xffffffffu;
            const std::uint32_t a = bytes_at(tree, planes + begin / 8);
            const std::uint32_t b = classes > 2 ? bytes_at(tree, planes + plane_bytes + begin / 8) : 0;
            low += static_cast<std::uint32_t>(__builtin_popcount(a & below));
            high += static_cast<std::uint32_t>(__builtin_popcount(b & below));
            both += static_cast<std::uint32_t>(__builtin_popcount(a & b & below));
            if (in - begin < 32) own = (a >> (in - begin) & 1u) + 2 * (b >> (in - begin) & 1u);
        }
        const std::uint32_t before[4] = {in - low - high + both, low - both, high - both, both};
        std::uint32_t bit = 0;
        for (std::uint32_t c = 0; c < most_classes; ++c)
            bit += before[c] * (head >> (2 + 6 * c) & 63u);
        const std::uint32_t width = head >> (2 + 6 * own) & 63u;
        const std::uint64_t factors = planes + (classes == 1 ? 0 : classes == 2 ? 1 : 2) * plane_bytes;
        const std::uint64_t of_class = chunk + packed_head_bytes + own * packed_class_bytes;
        const std::uint32_t shift = bytes_at(tree, of_class + 4) & 31u;
        return bytes_at(tree, of_class) + (bits_from(tree, factors, bit, width) << shift);
    }
};

}  // namespace obscura
