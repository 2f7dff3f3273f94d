#pragma once
// The smallest squares: planes and edges that suit texels whose intervals are known, tried out one by one.

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/block.h"
#include "hierarchy/facet/facet_tree.h"
#include "hierarchy/facet/plane_set.h"
#include "hierarchy/facets.h"

namespace obscura {

/// Finds the part of the tree over a block of up to 8 x 8 texels, in Morton order; keeps its working memory.
class BlockFit {
  public:
    explicit BlockFit(const PlaneSet& planes) : planes_(planes) {}

    /// `entry` and `exit` as block_intervals() gives them; `list`: the facets of the square. `as_root`: no
    /// edge for the square itself.
    FacetPart fit(const Square& square, std::span<const Listed> list, const float* entry, const float* exit,
                  bool as_root, FacetBuilder& builder);

  private:
    static constexpr std::size_t most_planes = 12, most_edges = 12;  ///< tried
    using Texels = std::uint64_t;                                    ///< a bit each

    struct PlaneDepths {
        std::uint32_t plane = no_plane;
        float z[block_texels];
    };
    struct EdgeTexels {
        FacetEdge edge;
        Texels high = 0;
    };

    void load(const Square& square, std::span<const Listed> list, const float* entry, const float* exit);
    bool is_seen(std::uint32_t plane, int count);
    FacetPart part(int first, const Square& square, bool as_root, FacetBuilder& builder);
    /// What all these texels can take, without ramps.
    Acceptable acceptable(Texels texels) const;
    /// A ramp for texels on one side of an edge.
    Acceptable ramped(Texels texels, const EdgeTexels& edge, bool high) const;
    bool by_edge(Texels texels, FacetPart& part) const;

    const PlaneSet& planes_;
    Square square_;
    const float *entry_ = nullptr, *exit_ = nullptr;
    float need_[block_texels];
    std::vector<PlaneDepths> depths_;
    std::vector<EdgeTexels> edges_;
};

}  // namespace obscura
