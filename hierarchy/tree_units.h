#pragma once
// Reading the serialised tree unit by unit (see tree_code.h): what every plain reader shares.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// Units that a node takes, by its kind.
using KindUnits = std::array<std::uint32_t, 4>;
constexpr KindUnits units_of_kinds(TreeLayout layout) {
    return row_of(layout).bytes ? KindUnits{0, 4, 3, 7} : KindUnits{0, 1, 1, 2};
}

constexpr std::size_t unit_bytes(TreeLayout layout) {
    return row_of(layout).bytes ? 1 : 4;
}

/// Units of a header: where the value of a full node stands behind the node.
constexpr std::uint32_t header_units(TreeLayout layout) {
    return units_of_kinds(layout)[2];
}

constexpr int offset_bits(TreeLayout layout) {
    return row_of(layout).offset_bits;
}

/// Lookups index units with signed 32-bit numbers.
constexpr std::uint64_t max_tree_units = std::uint64_t{1} << 31;

/// Kind of child i.
constexpr std::uint32_t kind_of(std::uint32_t kinds, int i) {
    return kinds >> (2 * i) & 3u;
}

/// Units of the siblings before child i; i = 4: of all.
constexpr std::uint32_t units_before(const KindUnits& units, std::uint32_t kinds, int i) {
    std::uint32_t sum = 0;
    for (int k = 0; k < i; ++k)
        sum += units[kind_of(kinds, k)];
    return sum;
}

/// Units of a tree's nodes without padding; a tree of one node, a leaf by count, is stored as a full one.
constexpr std::uint64_t node_units(TreeLayout layout, const MultiresCounts& counts) {
    const KindUnits units = units_of_kinds(layout);
    if (counts.full == 0) return units[3];
    return units[1] * counts.leaf + units[2] * counts.empty + units[3] * counts.full;
}

/// First byte of a unit, beyond 4 GiB too.
constexpr std::size_t byte_of_unit(TreeLayout layout, std::uint64_t unit) {
    return static_cast<std::size_t>(unit) * unit_bytes(layout);
}

struct TreeHeader {
    std::uint32_t kinds = 0;
    std::uint32_t offset = 0;  ///< in units of offset_scale of the node's height
};

inline std::uint32_t bits_at(const TreeCode& code, std::uint64_t unit) {
    std::uint32_t bits;
    std::memcpy(&bits, code.units + byte_of_unit(code.layout, unit), sizeof bits);
    return bits;
}

inline TreeHeader header_at(const TreeCode& code, std::uint64_t unit) {
    std::uint32_t bits = bits_at(code, unit);
    // The fourth byte belongs to the next unit.
    if (unit_bytes(code.layout) == 1) bits &= 0xffffffu;
    return {bits & 0xffu, bits >> 8};
}

inline float depth_at(const TreeCode& code, std::uint64_t unit) {
    float depth;
    std::memcpy(&depth, code.units + byte_of_unit(code.layout, unit), sizeof depth);
    return depth;
}

/// First unit of a node's children.
inline std::uint64_t children_of(const TreeCode& code, std::uint64_t node, int height, TreeHeader header) {
    return node + std::uint64_t{header.offset} * code.offset_scale[height];
}

}  // namespace obscura
