#pragma once
// The serialised tree as lookups read it. POD: kernels include this.
//
// A *code* is a way to write a tree of depths (hierarchy/codes): `mh` is described here, since others are
// built on its nodes, `mmh` in hierarchy/mmh, `dag` in hierarchy/dag, `facet` in
// hierarchy/facet.
//
// Scandolo, Bauszat, Eisemann 2016, section 3.2, after S. Lefebvre, H. Hoppe, "Compressed Random-Access Trees
// for Spatially Coherent Data", EGSR 2007: depth first, siblings side by side, each inner node with the kinds
// of its children and one offset to the first of them, in units that grow with the height of the node.
//
//   header   bits 0-7: kinds of the four children (ChildKind, two bits each); above: offset
//   full     header, value        empty    header        leaf    value
//
// In words (32 bits) the header is one word; full nodes take two units, empty nodes and leaves one. The
// kinds' numbers are chosen so that the units of the siblings before child i are the bits that are set below
// bit 2i. In bytes the header has three (16 bits of offset), so full, empty, leaf take 7, 3 and 4 units:
// three for every high bit of a kind that is set and four for every low one.

#include <cstdint>

/// Of functions that kernels and scalar code share: no object exports one.
#define OBSCURA_TREE_INLINE inline __attribute__((always_inline))

namespace obscura {

/// Levels of the largest map (2^20 texels a side), and the root's.
constexpr int max_tree_levels = 20;
/// Levels of the largest top grid: 2^24 entries, 128 MiB.
constexpr int max_top_levels = 12;

/// The codes. Their numbers stand in files; what they can do is in hierarchy/codes/codes.h.
enum class ShadowCode : std::uint32_t { mh = 0, mmh = 1, dag = 2, facet = 3 };

struct ShadowCodeName {
    ShadowCode code;
    const char* name;  ///< in scene files
};
inline constexpr ShadowCodeName shadow_code_names[] = {
    {ShadowCode::mh, "mh"}, {ShadowCode::mmh, "mmh"}, {ShadowCode::dag, "dag"}, {ShadowCode::facet, "facet"}};
constexpr int shadow_code_count = static_cast<int>(sizeof shadow_code_names / sizeof shadow_code_names[0]);

/// Of a code that is one.
constexpr const char* name_of(ShadowCode code) {
    int i = 0;
    while (i + 1 < shadow_code_count && shadow_code_names[i].code != code)
        ++i;
    return shadow_code_names[i].name;
}

/// How a code writes its nodes (words16, words24, bytes16: mh) or its values (fractions, float_bits: mmh,
/// dag; floats: facet).
enum class TreeLayout : std::uint32_t {
    words16 = 0,
    words24 = 1,
    bytes16 = 2,
    fractions = 3,
    float_bits = 4,
    floats = 5
};

/// A layout of mh and all that tells it from the others.
struct TreeLayoutRow {
    TreeLayout layout;
    const char* name;  ///< in scene files
    bool bytes;        ///< its units; else words
    int offset_bits;
    TreeLayout wider;  ///< what is tried where its offsets do not reach; the widest: itself
};
inline constexpr TreeLayoutRow tree_layouts[] = {
    {TreeLayout::words24, "words24", false, 24, TreeLayout::words24},
    {TreeLayout::words16, "words16", false, 16, TreeLayout::words24},  // the paper's
    {TreeLayout::bytes16, "bytes16", true, 16, TreeLayout::words16},   // the paper's without padding
};
constexpr int tree_layout_count = static_cast<int>(sizeof tree_layouts / sizeof tree_layouts[0]);

/// Of a layout that is one.
constexpr const TreeLayoutRow& row_of(TreeLayout layout) {
    int i = 0;
    while (i + 1 < tree_layout_count && tree_layouts[i].layout != layout)
        ++i;
    return tree_layouts[i];
}

/// Where a descent stands.
struct TreePlace {
    /// Unit index of the inner node; no_tree_node when the descent ended above.
    std::uint32_t node = 0;
    /// What the code carries of the values on the way, this node's included. mh: the unit index of the last
    /// one (of the value itself, not its node). mmh: their sum. dag: the number of the last one.
    std::uint32_t value = 0;
    /// dag: values that stand before those below the node, and where in a treelet the descent stands. facet:
    /// the line that the descent ended in, and what it has of its own.
    std::uint32_t count = 0, inside = 0;
};
constexpr std::uint32_t no_tree_node = 0xffffffffu;

/// Two of the numbers of a place: what the dense top grid is made of.
struct TopNode {
    std::uint32_t node = 0, value = 0;
};

/// Of one entry of the top grid, which is where descents stand after their first levels: node and value; of
/// dag and facet then count and inside.
constexpr int top_nodes_of(ShadowCode code) {
    return code == ShadowCode::dag || code == ShadowCode::facet ? 2 : 1;
}

/// What a lookup needs of a tree. mh and mmh: the root stands at unit 0 and is always a full node, even
/// without children; children(node at height h) = node + offset * offset_scale[h]. Texels have height 0, the
/// root `levels`.
struct TreeCode {
    const std::uint8_t* units = nullptr;  ///< words: aligned to 4; bytes: readable 3 beyond the end
    ShadowCode code = ShadowCode::mh;
    TreeLayout layout = TreeLayout::words24;
    std::int32_t levels = 0;
    std::uint32_t offset_scale[max_tree_levels + 1] = {};
    const TopNode* top =
        nullptr;  ///< 2^top_levels squared entries of top_nodes_of(code), row by row; null: none
    std::int32_t top_levels = 0;
};

}  // namespace obscura
