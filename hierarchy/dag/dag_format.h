#pragma once
// The words of a tree of the code dag. POD: kernels include this.
//
// L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow Maps", High-Performance
// Graphics 2021, sections 3.2 to 3.4, figures 2 to 4.
//
//   header | inner nodes, the root first | treelets | chunks | factors                      little-endian
//
// in one of two forms. As the paper has it:
//
//   inner node   kinds of the four children 8 | values below it 24 | of each child that exists a word: where
//                it stands, in words from the header; always behind its parent. Where a tree has too many
//                values for 24 bits, every node has a word for their number after its first (`wide`).
//   treelet      number of its values 9 | which nodes of a full tree of so many levels have one, depth-first
//   chunk        representative 32 | c_l 32 | c_f 32 | bytes of a factor - 1 2, first factor 30 | a bit for
//                each value: it has a factor
//   factors      bytes
//
// Packed, in bytes, with the same treelets:
//
//   inner node   kinds 8 | bytes of a pointer - 1 2, bytes of a count - 1 2, zeros 4 | counts: of each child
//                that exists but the first, the values below the node before it | pointers: of each child, a
//                treelet's number or the bytes from the node's first to the child's
//   chunk        where its part of the factors begins 32, bytes
//   factors      of each chunk: classes - 1 2, bits of a factor of classes 0 to 3 6 each | of each class:
//                base 32, shift 8 | with more than one class, the low bits of all values' classes; with more
//                than two, the high bits | factors, bits, in the order of the values, which are
//                base + (factor << shift)
//
// Numbers of values are depth-first: a node's own stands before those below it, child by child. The root's
// is 0.

#include <cstdint>

#include "hierarchy/tree_code.h"

namespace obscura {

struct DagHeader {
    std::uint32_t first_treelet = 0, first_chunk = 0, first_factor = 0;  ///< words
    std::uint32_t values = 0;                                            ///< how many
    std::uint32_t form = 0;                                              ///< DagForm
};
constexpr std::uint32_t dag_header_words = sizeof(DagHeader) / 4;

constexpr int min_treelet_levels = 1, max_treelet_levels = 5;
constexpr int min_chunk_log2 = 4, max_chunk_log2 = 7;

/// Bits 0-3: levels of treelets; 4-7: chunks have 2^this values; 8: wide; 9: packed.
struct DagForm {
    int treelet_levels = 4;
    int chunk_log2 = 5;
    bool wide = false;
    bool packed = false;

    static constexpr DagForm of(std::uint32_t form) {
        return {static_cast<int>(form & 15u), static_cast<int>(form >> 4 & 15u), (form >> 8 & 1u) != 0,
                (form >> 9 & 1u) != 0};
    }
    constexpr std::uint32_t bits() const {
        return static_cast<std::uint32_t>(treelet_levels) | static_cast<std::uint32_t>(chunk_log2) << 4 |
               (wide ? 256u : 0u) | (packed ? 512u : 0u);
    }
    /// Nodes and treelets are named by their first unit, a word or packed a byte, from the header on.
    constexpr int unit_log2() const { return packed ? 0 : 2; }
    /// Not packed: words of a node before those of its children.
    constexpr std::uint32_t node_words() const { return wide ? 2 : 1; }
    /// Records of chunks are bytes side by side: 18, 20, 24 or 32, or packed 4.
    constexpr std::uint32_t chunk_bytes() const { return packed ? 4u : 16u + (1u << chunk_log2) / 8u; }
};

/// What stands in a child's place.
enum class DagKind : std::uint32_t {
    none = 0,
    treelet = 1,
    empty = 2,  ///< an inner node without a value of its own
    full = 3    ///< an inner node with one; which of the two is not part of the
                ///< node: both share it
};

/// Nodes of a full tree of so many levels.
constexpr std::uint32_t full_tree_nodes(int levels) {
    return ((1u << (2 * levels)) - 1u) / 3u;
}
constexpr std::uint32_t treelet_count_bits = 9;
constexpr std::uint32_t treelet_count_mask = (1u << treelet_count_bits) - 1u;
/// 1, 1, 1, 3 and 11 for one to five levels.
constexpr std::uint32_t treelet_words(int levels) {
    return (treelet_count_bits + full_tree_nodes(levels) + 31u) / 32u;
}
static_assert(treelet_words(4) == 3 && treelet_words(max_treelet_levels) == 11);

/// Packed: what a node begins with.
constexpr std::uint32_t packed_node_bytes = 2;
/// Bytes that a number takes, at least one.
constexpr std::uint32_t bytes_of_number(std::uint64_t n) {
    return n < 1u << 8 ? 1 : n < 1u << 16 ? 2 : n < 1u << 24 ? 3 : 4;
}
/// Packed: what the factors' bytes of a chunk begin with, and have for each class.
constexpr std::uint32_t packed_head_bytes = 4, packed_class_bytes = 5, most_classes = 4;

/// TreePlace::inside: zero at inner nodes; in a treelet the number of the node among those of the full tree
/// (9 bits), the levels below it (3) and a one.
constexpr std::uint32_t inside_treelet = 1u << 12;
OBSCURA_TREE_INLINE std::uint32_t inside_of(std::uint32_t position, int levels_below) {
    return inside_treelet | static_cast<std::uint32_t>(levels_below) << 9 | position;
}
/// What four bytes tell from the one on in which a node's bit is: its own and those of all below it, if these
/// are no more.
constexpr std::uint32_t treelet_window = 25;

}  // namespace obscura
