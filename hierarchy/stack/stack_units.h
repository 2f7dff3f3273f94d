#pragma once
// Reading a serialised octree word by word: what every plain reader shares (see stack_code.h).

#include <cstdint>
#include <cstring>

#include "hierarchy/stack/stack_code.h"
#include "hierarchy/tree_units.h"

namespace obscura {

constexpr KindUnits units_of_kinds(StackLayout layout) {
    return layout == StackLayout::wide ? KindUnits{0, 1, 2, 3} : KindUnits{0, 1, 1, 2};
}
constexpr std::uint32_t header_units(StackLayout layout) {
    return units_of_kinds(layout)[2];
}
constexpr int offset_bits(StackLayout layout) {
    return layout == StackLayout::wide ? 31 : 16;
}

struct StackHeader {
    std::uint32_t kinds = 0;
    std::uint64_t offset = 0;  ///< in units of offset_scale of the node's height
};

inline StackHeader header_at(const StackCode& code, std::uint64_t word) {
    const std::uint32_t first = code.words[word];
    StackHeader header{first & 0xffffu, first >> 16};
    if (code.layout == StackLayout::wide) header.offset |= std::uint64_t{code.words[word + 1]} << 16;
    return header;
}

inline float depth_at(const StackCode& code, std::uint64_t word) {
    float depth;
    std::memcpy(&depth, code.words + word, sizeof depth);
    return depth;
}

inline std::uint64_t children_of(const StackCode& code, std::uint64_t node, int height, StackHeader header) {
    return node + header.offset * code.offset_scale[height];
}

/// Words of an octree's nodes without padding; one of a single node, a leaf by count, is stored as a full
/// one.
constexpr std::uint64_t node_units(StackLayout layout, const MultiresCounts& counts) {
    const KindUnits units = units_of_kinds(layout);
    if (counts.full == 0) return units[3];
    return units[1] * counts.leaf + units[2] * counts.empty + units[3] * counts.full;
}

}  // namespace obscura
