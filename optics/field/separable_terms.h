#pragma once
// A mask as a sum of products: term k is (a function of x) times (a function of y), each a few intervals.
// Every separable strategy of the far field starts here.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "optics/field/phasor.h"
#include "optics/field/quads.h"

namespace obscura {

/// Weighted intervals, grouped by term; coordinates in texels from the mask's centre.
struct IntervalTerms {
    std::vector<std::int32_t> begin{0};  ///< term k owns intervals [begin[k], begin[k + 1])
    std::vector<double> x0, x1;
    std::vector<float> weight;

    void add(double from, double to, float w) {
        x0.push_back(from);
        x1.push_back(to);
        weight.push_back(w);
    }
    void close_term() { begin.push_back(static_cast<std::int32_t>(x0.size())); }
    int count() const { return static_cast<int>(begin.size()) - 1; }
    BoxTerms view() const { return {begin.data(), x0.data(), x1.data(), weight.data(), count()}; }
};

/// Mask = sum over k of x-term k times y-term k.
struct SeparableTerms {
    IntervalTerms x, y;
    int count() const { return x.count(); }
};

/// True when every term is an even function: its transform is real.
bool all_even(const IntervalTerms& terms);

/// Real products of a term's transforms that rows v and -v need: 1 (both factors even), 2 or 4.
int products_per_term(const SeparableTerms& terms);

/// One term per quad.
SeparableTerms separable_terms(const QuadList& quads);

/// One term per distinct column of texels: its runs in y, times the intervals in x where the mask shows that
/// column. Columns that are 0 throughout need none. distinct_rows: the same with x and y exchanged.
SeparableTerms distinct_columns(ImageView<const float> mask);
SeparableTerms distinct_rows(ImageView<const float> mask);

/// Whichever needs fewer products (columns where equal).
SeparableTerms separable_terms(ImageView<const float> mask);

}  // namespace obscura
