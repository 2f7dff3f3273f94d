// From triangles to a tree of planes and edges: the recursion of hierarchy/square_builder.h with two more
// ways to stop (J. Warnock, "A Hidden Surface Algorithm for Computer Generated Halftone Pictures", 1969: "at
// most one feature in a square").

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "hierarchy/certificate.h"
#include "hierarchy/facet/block_fit.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/facet/region.h"
#include "hierarchy/square_builder.h"
#include "raster/interval_map.h"
#include "raster/layer_tile.h"

namespace obscura {
namespace {

/// What all threads read.
struct Job {
    const PlaneSet& planes;
    const BuildParams& params;
    Isa isa;
    NodeBudget& budget;
    const std::atomic<bool>* cancel;

    const FacetSet& set() const { return *planes.facets; }
    bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

/// Builds what lies below one square, depth first. One per thread.
class Worker {
  public:
    explicit Worker(const Job& job)
        : job_(job),
          judge_(job.set(), job.params.receivers,
                 job.params.mesh_certificate ? job.params.tuning.longest_surface : 0),
          region_(job.planes, job.params.receivers),
          fit_(job.planes) {
        builder.planes = &job.planes.planes;
    }

    /// What is known of a square before it is divided; `list` from `begin` on are its facets, `deepest` is
    /// lowered to the depth beyond which nothing counts.
    std::optional<FacetPart> decide(const Square& square, std::vector<Listed>& list, std::size_t begin,
                                    bool as_root, float& deepest) {
        ++stats.nodes_visited;
        if (list.size() == begin) return FacetPart::of(DepthInterval{});
        const Verdict verdict = judge_.judge(square, list, begin);
        deepest = std::min(deepest, verdict.deepest);
        const std::span<const Listed> own(list.data() + begin, list.size() - begin);
        if (own.empty()) return FacetPart::of(DepthInterval{});
        const bool looked = region_.look(square, own);
        if (verdict.common) {
            ++(verdict.by_mesh ? stats.certified_mesh : stats.certified_cover);
            FacetPart part = FacetPart::of(*verdict.common);
            // A plane may be what the squares beside it can take.
            if (looked && !verdict.by_mesh) {
                if (const std::optional<FacetPart> plane = region_.by_plane()) {
                    take_plane(part.value[0], plane->value[0]);
                }
            }
            return part;
        }
        if (!looked) return {};
        std::optional<FacetPart> part = region_.by_plane();
        if (!part && !as_root) part = region_.by_edge();
        if (part) ++stats.certified_cover;
        return part;
    }

    void hand_down(const std::vector<Listed>& list, std::size_t begin, std::size_t end, float deepest,
                   const Square& square, std::vector<Listed>& to) {
        for (std::size_t i = begin; i < end; ++i) {
            const Listed l = list[i];  // a copy: `to` may be the same vector
            if (l.low > deepest) continue;
            ++stats.list_operations;
            if (const std::optional<Listed> placed = place(job_.set(), l.facet, l.crossed, square))
                to.push_back(*placed);
        }
    }

    FacetPart build(const Square& square, const std::vector<Listed>& list, bool as_root) {
        list_ = list;
        accounted_ = builder.nodes.size();
        const FacetPart part = visit(square, 0, as_root);
        account(0);
        return part;
    }

    FacetBuilder builder;
    BuildStats stats;

  private:
    void account(std::size_t step) {
        if (builder.nodes.size() <= accounted_ + step) return;
        job_.budget.take(builder.nodes.size() - accounted_);
        accounted_ = builder.nodes.size();
    }

    /// The square's list is list_ from `begin` to its end.
    FacetPart visit(const Square& square, std::size_t begin, bool as_root) {
        if (job_.cancelled()) return FacetPart::of(DepthInterval{});
        float deepest = 2.0f;
        if (const std::optional<FacetPart> part = decide(square, list_, begin, as_root, deepest))
            return *part;
        const std::size_t end = list_.size();
        if (is_dense(square.side, end - begin, job_.params.tuning))
            return rasterize_tile(square, begin, as_root);
        if (square.side <= job_.params.tuning.block_side) return rasterize_block(square, begin, as_root);
        FacetPart child[4];
        for (int i = 0; i < 4; ++i) {
            const Square quadrant = square.child(i);
            hand_down(list_, begin, end, deepest, quadrant, list_);
            child[i] = visit(quadrant, end, false);
            list_.resize(end);
        }
        const FacetPart part = builder.join(child, square, as_root);
        constexpr std::size_t step = 4096;
        account(step);
        return part;
    }

    void list_records(const Square& square, std::size_t begin) {
        const auto side = static_cast<std::uint64_t>(square.side);
        stats.texels_rasterized += side * side;
        records_.clear();
        for (std::size_t i = begin; i < list_.size(); ++i)
            records_.push_back(job_.set().facets[list_[i].facet].record);
    }

    FacetPart rasterize_block(const Square& square, std::size_t begin, bool as_root) {
        list_records(square, begin);
        alignas(64) float entry[block_texels], exit[block_texels];
        OBSCURA_DISPATCH(job_.isa, block_intervals, job_.set().setup.records.data(), records_.data(),
                         records_.size(), square.x0, square.y0,
                         job_.params.receivers == Receivers::static_only, entry, exit);
        return fit_.fit(square, {list_.data() + begin, list_.size() - begin}, entry, exit, as_root, builder);
    }

    /// Many facets: intervals first, then what suits them.
    FacetPart rasterize_tile(const Square& square, std::size_t begin, bool as_root) {
        list_records(square, begin);
        const TileRect rect{square.x0, square.y0, std::max(square.side, 16), square.side};
        intervals_.resize(layer_tile_texels);
        tiler_.run(job_.set().setup, records_, rect, job_.params.receivers, job_.isa, intervals_.data());
        return of_rows(intervals_.data(), rect.width, square, begin, as_root);
    }

    /// The part over rows of `stride` texels; the square's list is list_ from `begin` to its end.
    FacetPart of_rows(const DepthInterval* rows, int stride, const Square& square, std::size_t begin,
                      bool as_root) {
        if (square.side <= block_side) {
            alignas(64) float entry[block_texels], exit[block_texels];
            for (int i = 0; i < square.side * square.side; ++i) {
                const DepthInterval& interval = rows[block_row(i) * stride + block_column(i)];
                entry[i] = interval.entry;
                exit[i] = interval.exit;
            }
            return fit_.fit(square, {list_.data() + begin, list_.size() - begin}, entry, exit, as_root,
                            builder);
        }
        const int half = square.side / 2;
        const std::size_t end = list_.size();
        FacetPart child[4];
        for (int i = 0; i < 4; ++i) {
            hand_down(list_, begin, end, 2.0f, square.child(i), list_);
            child[i] =
                of_rows(rows + (i / 2) * half * stride + (i % 2) * half, stride, square.child(i), end, false);
            list_.resize(end);
        }
        return builder.join(child, square, as_root);
    }

    const Job& job_;
    Judge judge_;
    RegionJudge region_;
    BlockFit fit_;
    IntervalTiler tiler_;
    std::vector<Listed> list_;
    std::vector<std::uint32_t> records_;
    std::vector<DepthInterval> intervals_;
    std::size_t accounted_ = 0;
};

/// The upper squares, level by level, until there are enough to keep every thread busy: a fixed number, so
/// that nothing depends on the threads.
class Upper {
  public:
    Upper(const Job& job, const Exec& exec) : job_(job), exec_(exec) {}

    FacetPart build(int levels, FacetBuilder& all) {
        Node root;
        root.square = {0, 0, 1 << levels};
        for (std::uint32_t f = 0; f < job_.set().facets.size(); ++f) {
            const auto placed = place(job_.set(), f, job_.set().facets[f].edges == 4 ? 15u : 7u, root.square);
            if (placed) root.list.push_back(*placed);
        }
        nodes_.push_back(std::move(root));
        while (divide_lowest()) {
        }
        parallel_for(nodes_.size() - lowest_, exec_, [&](std::size_t i) {
            Node& node = nodes_[lowest_ + i];
            if (node.part || job_.cancelled()) return;
            with_worker([&](Worker& worker) {
                node.part = worker.build(node.square, node.list, lowest_ + i == 0);
                node.list = {};
                // As large as it must be: workers keep their room for the next square.
                node.below = std::make_unique<FacetBuilder>();
                node.below->append(worker.builder);
                worker.builder.nodes.clear();
                worker.builder.edges.clear();
            });
        });
        return harvest(0, all);
    }

    BuildStats stats;

  private:
    struct Node {
        Square square;
        std::vector<Listed> list;
        float deepest = 2.0f;
        std::optional<FacetPart> part;  ///< decided, or built
        std::size_t first_child = 0;    ///< index of the first of four, 0: none
        std::unique_ptr<FacetBuilder> below;
    };

    /// Workers' memory is as large as the scene: they are kept.
    template <class F>
    void with_worker(F&& f) {
        std::unique_ptr<Worker> worker;
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                worker = std::move(idle_.back());
                idle_.pop_back();
            }
        }
        if (!worker) worker = std::make_unique<Worker>(job_);
        f(*worker);
        const std::lock_guard lock(mutex_);
        stats += worker->stats;
        worker->stats = {};
        idle_.push_back(std::move(worker));
    }

    bool divide_lowest() {
        const std::size_t begin = lowest_, end = nodes_.size();
        const BuildTuning& tuning = job_.params.tuning;
        const auto open =
            static_cast<std::size_t>(std::count_if(nodes_.begin() + static_cast<std::ptrdiff_t>(begin),
                                                   nodes_.end(), [](const Node& n) { return !n.part; }));
        if (job_.cancelled() || open == 0 || open >= tuning.open_squares ||
            nodes_[begin].square.side <= tuning.smallest_task)
            return false;
        parallel_for(end - begin, exec_, [&](std::size_t i) {
            Node& node = nodes_[begin + i];
            if (node.part) return;
            with_worker([&](Worker& worker) {
                node.part = worker.decide(node.square, node.list, 0, begin + i == 0, node.deepest);
            });
        });
        std::vector<std::size_t> parents;
        for (std::size_t i = begin; i < end; ++i) {
            if (nodes_[i].part) continue;
            nodes_[i].first_child = nodes_.size();
            for (int k = 0; k < 4; ++k) {
                Node child;
                child.square = nodes_[i].square.child(k);
                nodes_.push_back(std::move(child));
                parents.push_back(i);
            }
        }
        parallel_for(nodes_.size() - end, exec_, [&](std::size_t i) {
            const Node& parent = nodes_[parents[i]];
            with_worker([&](Worker& worker) {
                worker.hand_down(parent.list, 0, parent.list.size(), parent.deepest, nodes_[end + i].square,
                                 nodes_[end + i].list);
            });
        });
        for (std::size_t i = begin; i < end; ++i)
            nodes_[i].list = {};
        lowest_ = end;
        return nodes_.size() > end;
    }

    FacetPart harvest(std::size_t i, FacetBuilder& all) {
        Node& node = nodes_[i];
        if (node.first_child != 0) {
            FacetPart child[4];
            for (std::size_t k = 0; k < 4; ++k)
                child[k] = harvest(node.first_child + k, all);
            return all.join(child, node.square, i == 0);
        }
        FacetPart part = node.part.value_or(FacetPart::of(DepthInterval{}));
        if (node.below) {
            part.first_child += all.append(*node.below);
            node.below.reset();
        }
        return part;
    }

    const Job& job_;
    const Exec& exec_;
    std::vector<Node> nodes_;  ///< level by level
    std::size_t lowest_ = 0;   ///< where the lowest level begins
    std::mutex mutex_;
    std::vector<std::unique_ptr<Worker>> idle_;
};

}  // namespace

FacetTree build_facet_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                           const Exec& exec, BuildStats* stats, const std::atomic<bool>* cancel) {
    CHECK(view.width == view.height && std::has_single_bit(static_cast<unsigned>(view.width)) &&
              view.width <= 1 << 20,
          "a hierarchy needs a square power-of-two map");
    CHECK(params.needed == nullptr, "trees of planes and edges are whole");
    const Stopwatch setup;
    const FacetSet set = facets_of(mesh, view, params.only_casters, exec);
    PlaneSet planes = planes_of(set);
    const double setup_s = setup.seconds();
    const Stopwatch building;
    NodeBudget budget;
    budget.most = params.max_nodes;
    const Job job{planes, params, exec.isa, budget, cancel};
    Upper upper(job, exec);
    FacetBuilder all;
    all.planes = &planes.planes;
    FacetTree tree;
    tree.levels = std::countr_zero(static_cast<unsigned>(view.width));
    const FacetPart root = upper.build(tree.levels, all);
    tree.root = all.node_of(root);
    // Every descent ends in some value: where nothing is common, any serves that is never the last.
    if (root.value[0].empty()) tree.root.value[0] = depth_value(1.0f);
    tree.nodes = std::move(all.nodes);
    tree.edges = std::move(all.edges);
    tree.planes = std::move(planes.planes);
    if (stats != nullptr) {
        *stats = upper.stats;
        stats->facets = set.facets.size();
        stats->setup_s = setup_s;
        stats->build_s = building.seconds();
    }
    return tree;
}

}  // namespace obscura
