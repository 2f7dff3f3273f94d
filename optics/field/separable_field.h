#pragma once
// The far field of separable terms: factors in panels, then one matrix product.

#include <cstdint>
#include <vector>

#include "core/isa.h"
#include "optics/field/field.h"
#include "optics/field/frequency_grid.h"
#include "optics/field/separable_terms.h"

namespace obscura {

/// Which blocks of 8 x 8 pixels are wanted; row-major, columns x rows of them.
struct BlockSet {
    int columns = 0, rows = 0;
    std::vector<std::uint8_t> active;  ///< 0 or 1
};

/// What of F is wanted.
enum class Slope {
    none,  ///< F itself
    u,     ///< its derivative by u, times the grid's step_u
    v,     ///< its derivative by v, times step_v
};

struct SeparableParams {
    bool add = false;                  ///< to the target's re and im, which must be there
    const BlockSet* blocks = nullptr;  ///< pixels of other blocks are left alone; null: all are wanted
    Slope slope = Slope::none;
    bool points = false;  ///< intervals stand for points at their middles; no slopes then
};

/// Row of the grid at which v = 0, or -1: the rows around it come in conjugate pairs.
int mirror_row(const FrequencyGrid& grid);

/// F of the terms over the grid.
void separable_field(const SeparableTerms& terms, const FrequencyGrid& grid, const SeparableParams& params,
                     const FieldTarget& target, const Exec& exec);

/// Nanoseconds on one thread (AVX-512).
double separable_cost_ns(const SeparableTerms& terms, const FrequencyGrid& grid);

}  // namespace obscura
