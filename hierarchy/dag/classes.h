#pragma once
// Values in chunks of up to four classes, each with factors of its own width. Beyond L. Scandolo, E.
// Eisemann, High-Performance Graphics 2021, section 3.3, whose chunks have one representative and one width
// in whole bytes: a representative is a class whose factors have no bits, and there may be several; the
// values of one chunk are of a roof, a street and a wall more often than not, each within few steps of
// itself and far from the others.

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/dag/dag_format.h"
#include "hierarchy/number_range.h"
#include "hierarchy/tree_code.h"

namespace obscura {

/// A value of it is base + (factor << shift), with a factor of `width` bits.
struct ValueClass {
    std::uint32_t base = 0;
    std::uint32_t shift = 0, width = 0;  ///< bits: up to 31, up to 32
};

struct ClassedChunk {
    std::vector<ValueClass> classes;     ///< one to four
    std::vector<std::uint8_t> class_of;  ///< of each value
    std::vector<std::uint32_t> factors;  ///< of each value; zero where its class has no bits
    /// As it is written: head, classes, planes of 2^chunk_log2 bits, factors.
    std::uint64_t bytes(int chunk_log2) const;
};

/// A number for each range, none of which is empty, up to 2^max_chunk_log2 of them, in few bits: the best
/// of taking up to three numbers that most ranges hold, each as a class, and cutting what is left, in order
/// of depth, into the rest of the classes. `layout` tells which number of a range is preferred
/// (stored_number()).
ClassedChunk classed_chunk_of(std::span<const NumberRange> ranges, TreeLayout layout, int chunk_log2);

}  // namespace obscura
