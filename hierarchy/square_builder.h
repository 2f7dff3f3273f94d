#pragma once
// The recursion below one square (J. Warnock, "A Hidden Surface Algorithm for Computer Generated Halftone
// Pictures", 1969): what is not decided hands each quadrant the facets that reach into it; the smallest
// squares are rasterized.

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/isa.h"
#include "hierarchy/block.h"
#include "hierarchy/build.h"
#include "hierarchy/certain_tree.h"
#include "hierarchy/certificate.h"
#include "hierarchy/facets.h"
#include "hierarchy/multires.h"
#include "raster/interval_map.h"

namespace obscura {

/// A square on the way down, and what is needed of it.
struct Site {
    Square square;
    std::uint64_t morton = 0;  ///< place among the squares of its size
    int height = 0;            ///< log2 of its side
    bool whole = true;         ///< everything in it is needed; else `needed` says what
    NeededNodes::Codes needed;

    Site child(int i) const;
    bool not_needed() const { return !whole && needed.empty(); }
    /// Its value is wanted, and nothing below it.
    bool value_only() const;
};

/// The interval of squares that nothing needs: every depth lies in it, so it never decides its parent's
/// (paper, section 4, does the same for maps that a stack lacks).
constexpr DepthInterval any_depth{0.0f, 1.0f};

/// How many nodes all threads together may make.
struct NodeBudget {
    std::uint64_t most = UINT64_MAX;
    std::atomic<std::uint64_t> used = 0;
    /// Throws LimitError beyond `most`.
    void take(std::uint64_t nodes);
};

/// Whether a square's list is so long that rasterizing it as one tile costs less than the facets' way through
/// further divisions, or longer than a block can take.
bool is_dense(std::int32_t side, std::size_t count, const BuildTuning& tuning);

/// Builds the part of the tree below one square, depth first. One per thread: it keeps working memory as
/// large as the scene. Tree: MultiresBuilder<2> for depths, CertainBuilder for what depths are chosen from.
template <class Tree>
class SquareBuilder {
  public:
    using Part = typename Tree::Part;

    /// `set`, `params` and `cancel` (null: never) must outlive it.
    SquareBuilder(const FacetSet& set, const BuildParams& params, Isa isa, NodeBudget& budget,
                  const std::atomic<bool>* cancel);

    /// What is known of a square before it is divided: its part of the tree, which then has no nodes. `list`
    /// from `begin` on holds the facets that reach into it; `deepest` is lowered to the depth beyond which
    /// nothing counts.
    std::optional<Part> decide(const Site& site, std::vector<Listed>& list, std::size_t begin,
                               float& deepest);

    /// Appends to `to` what of list[begin, end) reaches into `square` and begins before `deepest`. `to` may
    /// be `list`.
    void hand_down(const std::vector<Listed>& list, std::size_t begin, std::size_t end, float deepest,
                   const Square& square, std::vector<Listed>& to);

    /// The whole part of the tree below a square; its nodes are appended to `tree`. Without meaning, but
    /// soon, when `cancel` is set meanwhile.
    Part build(const Site& site, const std::vector<Listed>& list);

    Tree tree;
    BuildStats stats;                ///< exact counts of all that was done so far
    std::vector<BuildSquare> trace;  ///< squares visited, where params.trace asks for them

    void note(const Site& site, BuildSquare::Fate fate);

  private:
    bool detail_wanted(const Site& site) const {
        return Tree::keeps_detail && site.height > params_.detail_height;
    }
    Part settled(Part part, int height, std::size_t mark);
    Part done(const Site& site, BuildSquare::Fate fate, DepthInterval interval);
    Part visit(const Site& site, std::size_t begin);
    void account(std::size_t step);
    void list_records(const Site& site, std::size_t begin);
    Part rasterize_block(const Site& site, std::size_t begin);
    Part rasterize_tile(const Site& site, std::size_t begin);
    Part reduce(const float* entry, const float* exit, int height);
    Part reduce_rows(const DepthInterval* rows, int stride, int height);

    const FacetSet& set_;
    const BuildParams& params_;
    Isa isa_;
    NodeBudget& budget_;
    /// Of the square decided last: its common depths are certain, its detail is wanted.
    bool certain_ = false;
    std::size_t accounted_ = 0;  ///< of the tree's nodes, those that the budget knows
    const std::atomic<bool>* cancel_;
    Judge judge_;
    IntervalTiler tiler_;
    std::vector<Listed> list_;  ///< the lists of all squares on the way down, one after the other
    std::vector<std::uint32_t> records_;
    std::vector<DepthInterval> intervals_;
};

extern template class SquareBuilder<MultiresBuilder<2>>;
extern template class SquareBuilder<CertainBuilder>;

}  // namespace obscura
