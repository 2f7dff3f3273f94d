#include "hierarchy/square_builder.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "raster/layer_tile.h"

namespace obscura {
bool is_dense(std::int32_t side, std::size_t count, const BuildTuning& tuning) {
    if (side <= tuning.block_side && count > block_facets) return true;
    if (side > tuning.tile_side) return false;
    const auto texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    return count > (side <= 16 ? block_facets : texels / static_cast<std::size_t>(tuning.texels_per_facet));
}

void NodeBudget::take(std::uint64_t nodes) {
    if (used.fetch_add(nodes, std::memory_order_relaxed) + nodes <= most) return;
    throw LimitError(fmt::format("a shadow tree passes {} nodes", most));
}

Site Site::child(int i) const {
    Site c{square.child(i), morton * 4 + static_cast<std::uint64_t>(i), height - 1, whole, {}};
    if (!whole) {
        c.needed = NeededNodes::inside_child(needed, c.morton, c.height);
        c.whole = NeededNodes::asks_for_all(c.needed, c.morton, c.height);
    }
    return c;
}

bool Site::value_only() const {
    // Longer runs of codes are seldom of this kind, and keeping the nodes does no harm.
    constexpr std::size_t few = 64;
    return !needed.empty() && needed.size() <= few &&
           NeededNodes::asks_for_value_only(needed, morton, height);
}

template <class Tree>
SquareBuilder<Tree>::SquareBuilder(const FacetSet& set, const BuildParams& params, Isa isa,
                                   NodeBudget& budget, const std::atomic<bool>* cancel)
    : set_(set),
      params_(params),
      isa_(isa),
      budget_(budget),
      cancel_(cancel),
      judge_(set, params.receivers, params.mesh_certificate ? params.tuning.longest_surface : 0) {
    if constexpr (!Tree::keeps_detail) tree.keeps_intervals = params.keep_intervals;
}

template <class Tree>
auto SquareBuilder<Tree>::decide(const Site& site, std::vector<Listed>& list, std::size_t begin,
                                 float& deepest) -> std::optional<Part> {
    ++stats.nodes_visited;
    certain_ = false;
    if (site.not_needed()) return done(site, BuildSquare::not_needed, any_depth);
    if (list.size() == begin) return done(site, BuildSquare::nothing, DepthInterval{});
    const Verdict verdict = judge_.judge(site.square, list, begin);
    deepest = std::min(deepest, verdict.deepest);
    if (!verdict.common) return {};
    certain_ = detail_wanted(site) && !verdict.uniform;
    if (certain_) return {};
    ++(verdict.by_mesh ? stats.certified_mesh : stats.certified_cover);
    return done(site, verdict.by_mesh ? BuildSquare::mesh : BuildSquare::cover, *verdict.common);
}

template <class Tree>
void SquareBuilder<Tree>::hand_down(const std::vector<Listed>& list, std::size_t begin, std::size_t end,
                                    float deepest, const Square& square, std::vector<Listed>& to) {
    for (std::size_t i = begin; i < end; ++i) {
        const Listed l = list[i];  // a copy: `to` may be the same vector
        if (l.low > deepest) continue;
        ++stats.list_operations;
        const std::optional<Listed> placed = place(set_, l.facet, l.crossed, square);
        if (placed) to.push_back(*placed);
    }
}

template <class Tree>
auto SquareBuilder<Tree>::build(const Site& site, const std::vector<Listed>& list) -> Part {
    list_.assign(list.begin(), list.end());
    accounted_ = tree.nodes.size();
    const Part part = visit(site, 0);
    account(0);
    return part;
}

/// Tells the budget of nodes made since last time, if they are more than `step`. Nodes that were made and
/// dropped again, below a square of which only the value is wanted, stay accounted while the square lasts.
template <class Tree>
void SquareBuilder<Tree>::account(std::size_t step) {
    if (tree.nodes.size() <= accounted_ + step) return;
    budget_.take(tree.nodes.size() - accounted_);
    accounted_ = tree.nodes.size();
}

template <class Tree>
auto SquareBuilder<Tree>::done(const Site& site, BuildSquare::Fate fate, DepthInterval interval) -> Part {
    note(site, fate);
    return Tree::texel(interval);
}

template <class Tree>
void SquareBuilder<Tree>::note(const Site& site, BuildSquare::Fate fate) {
    if (params_.trace != nullptr) trace.push_back({fate, site.square.x0, site.square.y0, site.square.side});
}

/// The square's list is list_ from `begin` to its end.
template <class Tree>
auto SquareBuilder<Tree>::visit(const Site& site, std::size_t begin) -> Part {
    if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed)) return Tree::texel(any_depth);
    float deepest = 2.0f;
    if (const std::optional<Part> part = decide(site, list_, begin, deepest)) return *part;
    const std::size_t end = list_.size(), mark = tree.nodes.size();
    Part part;
    if (is_dense(site.square.side, end - begin, params_.tuning) ||
        (certain_ && site.square.side <= params_.tuning.tile_side)) {
        part = rasterize_tile(site, begin);
    } else if (site.square.side <= params_.tuning.block_side) {
        part = rasterize_block(site, begin);
    } else {
        note(site, BuildSquare::divided);
        Part child[4];
        for (int i = 0; i < 4; ++i) {
            const Site quadrant = site.child(i);
            if (!quadrant.not_needed()) hand_down(list_, begin, end, deepest, quadrant.square, list_);
            child[i] = visit(quadrant, end);
            list_.resize(end);
        }
        part = settled(tree.join(child), site.height, mark);
        constexpr std::size_t step = 4096;
        account(step);
    }
    if (site.value_only()) {
        part.kinds = 0;
        tree.drop(mark);
    }
    return part;
}

template <class Tree>
void SquareBuilder<Tree>::list_records(const Site& site, std::size_t begin) {
    note(site, BuildSquare::rasterized);
    const auto side = static_cast<std::uint64_t>(site.square.side);
    stats.texels_rasterized += side * side;
    records_.clear();
    for (std::size_t i = begin; i < list_.size(); ++i)
        records_.push_back(set_.facets[list_[i].facet].record);
}

template <class Tree>
auto SquareBuilder<Tree>::rasterize_block(const Site& site, std::size_t begin) -> Part {
    list_records(site, begin);
    const Square& s = site.square;
    alignas(64) float entry[block_texels], exit[block_texels];
    OBSCURA_DISPATCH(isa_, block_intervals, set_.setup.records.data(), records_.data(), records_.size(), s.x0,
                     s.y0, params_.receivers == Receivers::static_only, entry, exit);
    return reduce(entry, exit, site.height);
}

/// Of a square of which no detail is wanted, nothing is kept but its common depths, if it has any.
template <class Tree>
auto SquareBuilder<Tree>::settled(Part part, int height, std::size_t mark) -> Part {
    if constexpr (Tree::keeps_detail) {
        if (part.kinds == 0 || height > params_.detail_height || !has_depth(part.interval)) return part;
        tree.drop(mark);
        return Tree::texel(part.interval);
    }
    return part;
}

/// The bottom-up construction over 4^height texels in Morton order.
template <class Tree>
auto SquareBuilder<Tree>::reduce(const float* entry, const float* exit, int height) -> Part {
    const int count = 1 << (2 * height);
    float low = entry[0], high = exit[0];
    bool uniform = true;
    for (int i = 1; i < count; ++i) {
        uniform = uniform && entry[i] == entry[0] && exit[i] == exit[0];
        low = std::max(low, entry[i]);
        high = std::min(high, exit[i]);
    }
    const bool detail = Tree::keeps_detail && height > params_.detail_height;
    if (low <= high && (uniform || !detail)) return Tree::texel({low, high});
    const int quarter = count / 4;
    Part child[4];
    for (int i = 0; i < 4; ++i)
        child[i] = reduce(entry + i * quarter, exit + i * quarter, height - 1);
    return tree.join(child);
}

template <class Tree>
auto SquareBuilder<Tree>::rasterize_tile(const Site& site, std::size_t begin) -> Part {
    list_records(site, begin);
    const Square& s = site.square;
    const TileRect rect{s.x0, s.y0, std::max(s.side, 16), s.side};
    intervals_.resize(layer_tile_texels);
    tiler_.run(set_.setup, records_, rect, params_.receivers, isa_, intervals_.data());
    return reduce_rows(intervals_.data(), rect.width, site.height);
}

/// The bottom-up construction over 2^height rows of `stride` texels.
template <class Tree>
auto SquareBuilder<Tree>::reduce_rows(const DepthInterval* rows, int stride, int height) -> Part {
    if (height == 0) return Tree::texel(rows[0]);
    const int half = 1 << (height - 1);
    const std::size_t mark = tree.nodes.size();
    const Part child[4] = {reduce_rows(rows, stride, height - 1),
                           reduce_rows(rows + half, stride, height - 1),
                           reduce_rows(rows + half * stride, stride, height - 1),
                           reduce_rows(rows + half * stride + half, stride, height - 1)};
    return settled(tree.join(child), height, mark);
}

template class SquareBuilder<MultiresBuilder<2>>;
template class SquareBuilder<CertainBuilder>;

}  // namespace obscura
