// The upper levels of the recursion, in parallel; what lies below them is a SquareBuilder's.

#include "hierarchy/build.h"

#include <bit>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/square_builder.h"
#include "raster/layer_tile.h"

namespace obscura {
namespace {

/// The upper squares, level by level, until there are enough to keep every thread busy: a fixed number, so
/// that nothing depends on the threads.
template <class Tree>
class Forest {
  public:
    using Part = typename Tree::Part;

    Forest(const FacetSet& set, const BuildParams& params, const Exec& exec, const std::atomic<bool>* cancel)
        : set_(set), params_(params), exec_(exec), cancel_(cancel) {
        budget_.most = params.max_nodes;
    }

    /// Appends the tree's nodes to `all`; returns its root.
    Part build(int levels, Tree& all) {
        plant(levels);
        while (divide_lowest()) {
        }
        grow();
        std::size_t count = 4 * nodes_.size();
        for (const Node& node : nodes_)
            count += node.below ? node.below->nodes.size() : 0;
        all.nodes.reserve(count);
        if constexpr (!Tree::keeps_detail) all.intervals.reserve(all.keeps_intervals ? count : 0);
        return harvest(0, all);
    }

    BuildStats stats;

  private:
    /// A square of the upper levels.
    struct Node {
        Site site;
        std::vector<Listed> list;
        float deepest = 2.0f;
        std::optional<Part> part;     ///< decided, without nodes of its own
        std::size_t first_child = 0;  ///< index of the first of four, 0: none
        std::unique_ptr<Tree> below;  ///< what a worker made of it; its root is `part`
        std::vector<BuildSquare> trace;
    };

    /// A worker from the pool: their working memory is as large as the scene.
    class Lease {
      public:
        explicit Lease(Forest& f) : forest_(f) {
            const std::lock_guard lock(f.mutex_);
            if (!f.idle_.empty()) {
                worker_ = std::move(f.idle_.back());
                f.idle_.pop_back();
            } else {
                worker_ = std::make_unique<SquareBuilder<Tree>>(f.set_, f.params_, f.exec_.isa, f.budget_,
                                                                f.cancel_);
            }
        }
        ~Lease() {
            const std::lock_guard lock(forest_.mutex_);
            forest_.stats += worker_->stats;
            worker_->stats = {};
            forest_.idle_.push_back(std::move(worker_));
        }
        SquareBuilder<Tree>* operator->() { return worker_.get(); }

      private:
        Forest& forest_;
        std::unique_ptr<SquareBuilder<Tree>> worker_;
    };

    bool cancelled() const { return cancel_ != nullptr && cancel_->load(std::memory_order_relaxed); }

    void plant(int levels) {
        Node root;
        root.site.square = {0, 0, 1 << levels};
        root.site.height = levels;
        if (params_.needed != nullptr) {
            root.site.needed = params_.needed->all();
            root.site.whole = NeededNodes::asks_for_all(root.site.needed, 0, levels);
        }
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f) {
            const auto placed = place(set_, f, set_.facets[f].edges == 4 ? 15u : 7u, root.site.square);
            if (placed) root.list.push_back(*placed);
        }
        nodes_.push_back(std::move(root));
        lowest_ = 0;
    }

    /// Decides the lowest level, then divides what is left of it. False when that is enough.
    bool divide_lowest() {
        const std::size_t begin = lowest_, end = nodes_.size();
        std::size_t open = 0;
        for (std::size_t i = begin; i < end; ++i)
            open += !nodes_[i].part;
        if (cancelled() || open == 0 || open >= params_.tuning.open_squares ||
            nodes_[begin].site.square.side <= params_.tuning.smallest_task)
            return false;
        parallel_for(end - begin, exec_, [&](std::size_t i) {
            Node& node = nodes_[begin + i];
            if (node.part) return;
            Lease worker(*this);
            node.part = worker->decide(node.site, node.list, 0, node.deepest);
            if (!node.part) worker->note(node.site, BuildSquare::divided);
            node.trace = std::exchange(worker->trace, {});
        });
        for (std::size_t i = begin; i < end; ++i) {
            if (nodes_[i].part) continue;
            nodes_[i].first_child = nodes_.size();
            for (int k = 0; k < 4; ++k) {
                Node child;
                child.site = nodes_[i].site.child(k);
                nodes_.push_back(std::move(child));
                parents_.push_back(i);
            }
        }
        parallel_for(nodes_.size() - end, exec_, [&](std::size_t i) {
            Node& child = nodes_[end + i];
            const Node& parent = nodes_[parents_[end + i - 1]];
            Lease worker(*this);
            if (!child.site.not_needed()) {
                worker->hand_down(parent.list, 0, parent.list.size(), parent.deepest, child.site.square,
                                  child.list);
            }
        });
        for (std::size_t i = begin; i < end; ++i)
            nodes_[i].list = {};
        lowest_ = end;
        return nodes_.size() > end;
    }

    /// Gives every open square of the lowest level to a worker.
    void grow() {
        parallel_for(nodes_.size() - lowest_, exec_, [&](std::size_t i) {
            Node& node = nodes_[lowest_ + i];
            if (node.part || cancelled()) return;
            Lease worker(*this);
            node.part = worker->build(node.site, node.list);
            node.list = {};
            // As large as it must be: workers keep their room for the next square.
            node.below = std::make_unique<Tree>();
            node.below->assign(worker->tree);
            worker->tree.drop(0);
            node.trace = std::exchange(worker->trace, {});
        });
    }

    /// Joins what has grown, in the order of the recursion, and gives the parts' memory back.
    Part harvest(std::size_t i, Tree& all) {
        if (params_.trace != nullptr) {
            params_.trace->insert(params_.trace->end(), nodes_[i].trace.begin(), nodes_[i].trace.end());
        }
        if (nodes_[i].first_child != 0) {
            const std::size_t mark = all.nodes.size();
            Part child[4];
            for (std::size_t k = 0; k < 4; ++k)
                child[k] = harvest(nodes_[i].first_child + k, all);
            Part part = all.join(child);
            if (nodes_[i].site.value_only()) {
                part.kinds = 0;
                all.drop(mark);
            }
            return part;
        }
        Part part = nodes_[i].part.value_or(Tree::texel(any_depth));
        if (nodes_[i].below) {
            part.first_child += all.append(*nodes_[i].below);
            nodes_[i].below.reset();
        }
        return part;
    }

    const FacetSet& set_;
    const BuildParams& params_;
    const Exec& exec_;
    const std::atomic<bool>* cancel_;
    std::vector<Node> nodes_;           ///< level by level
    std::vector<std::size_t> parents_;  ///< of node i at i - 1
    std::size_t lowest_ = 0;            ///< where the lowest level begins
    NodeBudget budget_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<SquareBuilder<Tree>>> idle_;
};

/// Sets the triangles up and builds: what both kinds of tree share.
template <class Tree>
typename Tree::Part build(const Mesh& mesh, const LightView& view, const BuildParams& params,
                          const Exec& exec, BuildStats* stats, const std::atomic<bool>* cancel, Tree& all) {
    CHECK(std::has_single_bit(static_cast<unsigned>(params.tuning.block_side)) &&
          params.tuning.block_side <= block_side);
    CHECK(view.width == view.height && std::has_single_bit(static_cast<unsigned>(view.width)) &&
              view.width <= 1 << 20,
          "a hierarchy needs a square power-of-two map");
    const BuildTuning& t = params.tuning;
    CHECK(t.block_side >= 1 && t.block_side <= block_side && t.tile_side >= 1 &&
              t.tile_side <= layer_tile_side && t.texels_per_facet >= 1 && t.smallest_task >= 1,
          "tuning out of range");
    const Stopwatch setup;
    const FacetSet set = facets_of(mesh, view, params.only_casters, exec);
    const double setup_s = setup.seconds();
    const Stopwatch building;
    Forest<Tree> forest(set, params, exec, cancel);
    const typename Tree::Part root = forest.build(std::countr_zero(static_cast<unsigned>(view.width)), all);
    if (stats != nullptr) {
        *stats = forest.stats;
        stats->facets = set.facets.size();
        stats->setup_s = setup_s;
        stats->build_s = building.seconds();
    }
    return root;
}

}  // namespace

MultiresTree build_shadow_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats, const std::atomic<bool>* cancel) {
    MultiresBuilder<2> all;
    all.keeps_intervals = params.keep_intervals;
    const auto root = build(mesh, view, params, exec, stats, cancel, all);
    MultiresTree tree;
    tree.levels = std::countr_zero(static_cast<unsigned>(view.width));
    tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
    tree.root_interval = root.interval;
    tree.nodes = std::move(all.nodes);
    tree.intervals = std::move(all.intervals);
    return tree;
}

CertainTree build_certain_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats, const std::atomic<bool>* cancel) {
    CHECK(params.needed == nullptr, "trees of certain squares are whole");
    CertainBuilder all;
    const auto root = build(mesh, view, params, exec, stats, cancel, all);
    CertainTree tree;
    tree.levels = std::countr_zero(static_cast<unsigned>(view.width));
    tree.root = root.square();
    tree.groups = std::move(all.nodes);
    return tree;
}

}  // namespace obscura
