// The recursion (J. Warnock, "A Hidden Surface Algorithm for Computer Generated Halftone Pictures", 1969): a
// square that is not decided hands each of its quadrants the facets that reach into it.

#include "hierarchy/build.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <memory>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "hierarchy/block.h"
#include "hierarchy/certificate.h"
#include "hierarchy/combine.h"
#include "hierarchy/facets.h"
#include "raster/interval_map.h"

namespace obscura {
namespace {

using Quadtree = MultiresBuilder<2>;
using Part = Quadtree::Part;
using Clock = std::chrono::steady_clock;

/// A square on the way down: what is needed of it.
struct Site {
    Square square;
    std::uint64_t morton = 0;  ///< place among the squares of its size
    int height = 0;            ///< log2 of its side
    bool whole = true;         ///< everything in it is needed; else `needed` says what
    NeededNodes::Codes needed;

    Site child(int i) const {
        Site c{square.child(i), morton * 4 + static_cast<std::uint64_t>(i), height - 1, whole, {}};
        if (!whole) {
            c.needed = NeededNodes::inside_child(needed, c.morton, c.height);
            c.whole = NeededNodes::asks_for_all(c.needed, c.morton, c.height);
        }
        return c;
    }
    bool not_needed() const { return !whole && needed.empty(); }
    bool value_only() const {
        constexpr std::size_t few =
            64;  // longer runs are seldom of this kind; keeping the nodes does no harm
        return !needed.empty() && needed.size() <= few &&
               NeededNodes::asks_for_value_only(needed, morton, height);
    }
};

/// Takes part in nothing: any depth will do (the paper's placeholder, section 4).
constexpr DepthInterval any_depth{0.0f, 1.0f};

/// Square side from which on long lists are rasterized as a tile, and how long that is: facets of few texels
/// each cost less there than their way through further divisions.
constexpr std::int32_t widest_tile = layer_tile_side;
bool dense(std::int32_t side, std::size_t count) {
    if (side > widest_tile) return false;
    return side <= 16 ? count > block_facets
                      : count > static_cast<std::size_t>(side) * static_cast<std::size_t>(side) / 16;
}

/// Builds the part of the tree below one square, depth first.
class Worker {
  public:
    Worker(const FacetSet& set, const BuildParams& params, Isa isa)
        : set_(set), params_(params), isa_(isa), judge_(set, params.receivers, params.mesh_certificate) {}

    /// What is known of a square before it is divided.
    std::optional<Part> decide(const Site& site, std::vector<Listed>& list, std::size_t begin,
                               float& deepest) {
        ++stats.nodes_visited;
        if (site.not_needed()) return done(site, BuildSquare::not_needed, any_depth);
        if (list.size() == begin) return done(site, BuildSquare::nothing, DepthInterval{});
        const Verdict verdict = judge_.judge(site.square, list, begin);
        deepest = std::min(deepest, verdict.deepest);
        if (!verdict.common) return {};
        ++(verdict.by_mesh ? stats.certified_mesh : stats.certified_cover);
        return done(site, verdict.by_mesh ? BuildSquare::mesh : BuildSquare::cover, *verdict.common);
    }

    /// Appends to `to` what of list[begin, end) reaches into `square` and begins before `deepest`.
    void hand_down(const std::vector<Listed>& list, std::size_t begin, std::size_t end, float deepest,
                   const Square& square, std::vector<Listed>& to) {
        for (std::size_t i = begin; i < end; ++i) {
            const Listed l = list[i];  // a copy: `to` may be the same vector
            if (l.low > deepest) continue;
            ++stats.list_operations;
            const std::optional<Listed> placed = place(set_, l.facet, l.crossed, square);
            if (placed) to.push_back(*placed);
        }
    }

    Part build(const Site& site, const std::vector<Listed>& list) {
        list_.assign(list.begin(), list.end());
        return visit(site, 0);
    }

    Quadtree tree;
    BuildStats stats;
    std::vector<BuildSquare> trace;

  private:
    Part done(const Site& site, BuildSquare::Fate fate, DepthInterval interval) {
        note(site, fate);
        return Quadtree::texel(interval);
    }
    void note(const Site& site, BuildSquare::Fate fate) {
        if (params_.trace != nullptr)
            trace.push_back({fate, site.square.x0, site.square.y0, site.square.side});
    }

    /// The square's list is list_ from `begin` to its end.
    Part visit(const Site& site, std::size_t begin) {
        float deepest = 2.0f;
        if (const std::optional<Part> part = decide(site, list_, begin, deepest)) return *part;
        const std::size_t end = list_.size(), mark = tree.nodes.size();
        Part part;
        if (dense(site.square.side, end - begin)) {
            part = rasterize_tile(site, begin);
        } else if (site.square.side <= block_side) {
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
            part = tree.join(child);
        }
        if (site.value_only()) {
            part.kinds = 0;
            tree.nodes.resize(mark);
        }
        return part;
    }

    Part rasterize_block(const Site& site, std::size_t begin) {
        note(site, BuildSquare::rasterized);
        const Square& s = site.square;
        stats.texels_rasterized += static_cast<std::uint64_t>(s.side) * static_cast<std::uint64_t>(s.side);
        records_.clear();
        for (std::size_t i = begin; i < list_.size(); ++i)
            records_.push_back(set_.facets[list_[i].facet].record);
        alignas(64) float entry[block_texels], exit[block_texels];
        OBSCURA_DISPATCH(isa_, block_intervals, set_.setup.records.data(), records_.data(), records_.size(),
                         s.x0, s.y0, params_.receivers == Receivers::static_only, entry, exit);
        return reduce(entry, exit, s.side * s.side);
    }

    /// The bottom-up construction over `count` texels in Morton order.
    Part reduce(const float* entry, const float* exit, int count) {
        float low = entry[0], high = exit[0];
        for (int i = 1; i < count; ++i) {
            low = std::max(low, entry[i]);
            high = std::min(high, exit[i]);
        }
        if (low <= high) return Quadtree::texel({low, high});
        const int quarter = count / 4;
        Part child[4];
        for (int i = 0; i < 4; ++i)
            child[i] = reduce(entry + i * quarter, exit + i * quarter, quarter);
        return tree.join(child);
    }

    Part rasterize_tile(const Site& site, std::size_t begin) {
        note(site, BuildSquare::rasterized);
        const Square& s = site.square;
        stats.texels_rasterized += static_cast<std::uint64_t>(s.side) * static_cast<std::uint64_t>(s.side);
        records_.clear();
        for (std::size_t i = begin; i < list_.size(); ++i)
            records_.push_back(set_.facets[list_[i].facet].record);
        const TileRect rect{s.x0, s.y0, std::max(s.side, 16), s.side};
        intervals_.resize(layer_tile_texels);
        tiler_.run(set_.setup, records_, rect, params_.receivers, isa_, intervals_.data());
        return reduce_rows(intervals_.data(), rect.width, s.side);
    }

    /// The same over rows of `stride` texels.
    Part reduce_rows(const DepthInterval* rows, int stride, int side) {
        if (side == 1) return Quadtree::texel(rows[0]);
        const int half = side / 2;
        const Part child[4] = {reduce_rows(rows, stride, half), reduce_rows(rows + half, stride, half),
                               reduce_rows(rows + half * stride, stride, half),
                               reduce_rows(rows + half * stride + half, stride, half)};
        return tree.join(child);
    }

    const FacetSet& set_;
    const BuildParams& params_;
    Isa isa_;
    Judge judge_;
    IntervalTiler tiler_;
    std::vector<Listed> list_;  ///< the lists of all squares on the way down, one after the other
    std::vector<std::uint32_t> records_;
    std::vector<DepthInterval> intervals_;
};

void add(BuildStats& to, const BuildStats& s) {
    to.nodes_visited += s.nodes_visited;
    to.certified_cover += s.certified_cover;
    to.certified_mesh += s.certified_mesh;
    to.texels_rasterized += s.texels_rasterized;
    to.list_operations += s.list_operations;
}

/// The upper squares, level by level, until there are enough to keep every thread busy: a fixed number, so
/// that nothing depends on the threads.
class Forest {
  public:
    Forest(const FacetSet& set, const BuildParams& params, const Exec& exec, const std::atomic<bool>* cancel)
        : set_(set), params_(params), exec_(exec), cancel_(cancel) {}

    MultiresTree build(int levels) {
        plant(levels);
        while (divide_lowest()) {
        }
        grow();
        MultiresTree tree;
        tree.levels = levels;
        Quadtree all;
        std::size_t count = 4 * nodes_.size();
        for (const Node& node : nodes_)
            count += node.below ? node.below->nodes.size() : 0;
        all.nodes.reserve(count);
        const Part root = harvest(0, all);
        tree.root = {stored_depth(root.interval), root.kinds, root.first_child};
        tree.root_interval = root.interval;
        tree.nodes = std::move(all.nodes);
        return tree;
    }

    BuildStats stats;

  private:
    /// A square of the upper levels.
    struct Node {
        Site site;
        std::vector<Listed> list;
        float deepest = 2.0f;
        std::optional<Part> part;         ///< decided, without nodes of its own
        std::size_t first_child = 0;      ///< index of the first of four, 0: none
        std::unique_ptr<Quadtree> below;  ///< what a worker made of it; its root is `part`
        std::vector<BuildSquare> trace;
    };
    static constexpr std::size_t enough = 256;
    static constexpr std::int32_t smallest = 64;

    /// A worker from the pool: their working memory is as large as the scene.
    class Lease {
      public:
        explicit Lease(Forest& f) : forest_(f) {
            const std::lock_guard lock(f.mutex_);
            if (!f.idle_.empty()) {
                worker_ = std::move(f.idle_.back());
                f.idle_.pop_back();
            } else {
                worker_ = std::make_unique<Worker>(f.set_, f.params_, f.exec_.isa);
            }
        }
        ~Lease() {
            const std::lock_guard lock(forest_.mutex_);
            add(forest_.stats, worker_->stats);
            worker_->stats = {};
            forest_.idle_.push_back(std::move(worker_));
        }
        Worker* operator->() { return worker_.get(); }

      private:
        Forest& forest_;
        std::unique_ptr<Worker> worker_;
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
        if (cancelled() || open == 0 || open >= enough || nodes_[begin].site.square.side <= smallest)
            return false;
        parallel_for(end - begin, exec_, [&](std::size_t i) {
            Node& node = nodes_[begin + i];
            if (node.part) return;
            Lease worker(*this);
            node.part = worker->decide(node.site, node.list, 0, node.deepest);
            if (!node.part && params_.trace != nullptr) {
                const Square& s = node.site.square;
                worker->trace.push_back({BuildSquare::divided, s.x0, s.y0, s.side});
            }
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
            node.below = std::make_unique<Quadtree>();
            node.below->nodes.assign(worker->tree.nodes.begin(), worker->tree.nodes.end());
            worker->tree.nodes.clear();
            node.trace = std::exchange(worker->trace, {});
        });
    }

    /// Joins what has grown, in the order of the recursion, and gives the parts' memory back.
    Part harvest(std::size_t i, Quadtree& all) {
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
                all.nodes.resize(mark);
            }
            return part;
        }
        Part part = nodes_[i].part.value_or(Quadtree::texel(any_depth));
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
    std::mutex mutex_;
    std::vector<std::unique_ptr<Worker>> idle_;
};

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

MultiresTree build_shadow_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                               const Exec& exec, BuildStats* stats, const std::atomic<bool>* cancel) {
    CHECK(view.width == view.height && std::has_single_bit(static_cast<unsigned>(view.width)) &&
              view.width <= 1 << 20,
          "a hierarchy needs a square power-of-two map");
    const Clock::time_point begin = Clock::now();
    const FacetSet set = facets_of(mesh, view, params.only_casters, exec);
    const double setup_s = seconds_since(begin);
    const Clock::time_point built = Clock::now();
    Forest forest(set, params, exec, cancel);
    MultiresTree tree = forest.build(std::countr_zero(static_cast<unsigned>(view.width)));
    if (stats != nullptr) {
        *stats = forest.stats;
        stats->facets = set.facets.size();
        stats->setup_s = setup_s;
        stats->build_s = seconds_since(built);
    }
    return tree;
}

}  // namespace obscura
