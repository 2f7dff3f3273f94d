#pragma once
// Values in chunks: one that many of them can be, and small whole numbers for the others.
//
// L. Scandolo, E. Eisemann, "Directed Acyclic Graph Encoding for Compressed Shadow Maps", High-Performance
// Graphics 2021, section 3.3. There factors are of floats, and c_l + c_f i, computed with one rounding or
// with two, may leave an interval that was tested otherwise. Here all are whole numbers modulo 2^32
// (hierarchy/fixed_depth.h): what is tested is what readers get.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/dag/dag_format.h"
#include "hierarchy/number_range.h"
#include "hierarchy/tree_code.h"

namespace obscura {

struct ValueChunk {
    std::uint32_t representative = 0;
    std::uint32_t base = 0, step = 0;  ///< the paper's c_l and c_f: a value is base + step * factor
    std::uint32_t factor_bytes = 1;    ///< 1 to 4
    std::array<std::uint32_t, (1u << max_chunk_log2) / 32> has_factor = {};  ///< bit i % 32 of word i / 32
    std::vector<std::uint32_t> factors;  ///< of the values that have one, in their order
};

/// The least numbers that most of the ranges hold: all from one of their ends to the next. Up to
/// 2^max_chunk_log2 ranges.
NumberRange most_held(std::span<const NumberRange> ranges);

/// A number for each range, none of which is empty, up to 2^max_chunk_log2 of them. The representative is the
/// one that most ranges hold; factors have as few bytes as a step was found for. `layout` tells which number
/// of a range is preferred (stored_number()).
ValueChunk chunk_of(std::span<const NumberRange> ranges, TreeLayout layout);

}  // namespace obscura
