#pragma once
// A run of maps on its way into the octree: what of it is finished, and above that what it is certain of.
//
// Nodes of the octree that span no more maps than a run of 2^j has are the same whatever maps come before and
// behind: they are finished. Of larger squares only this matters to what they will become: which depths all
// their texels in all maps of the run have in common, and the same of their quadrants. If a square's in this
// run agree with those of the next, the octree has nothing below that square (hierarchy/README.md, "why this
// equals the bottom-up construction"); if not, its node is joined from its eight children, and so on down to
// what is finished. So two runs are merged by walking their squares together, without a texel being looked
// at.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hierarchy/certain_tree.h"
#include "hierarchy/multires.h"
#include "hierarchy/stack/stack_shape.h"

namespace obscura {

/// 2^j maps. The squares of `certain` end at the side of the finished nodes, where a group's number is that
/// of a finished part instead.
struct Slab {
    using Octree = MultiresBuilder<3>;
    int slices_exponent = 0;
    int height = 0;                              ///< of the finished nodes
    std::shared_ptr<const CertainTree> certain;  ///< never altered: runs of one map share the map's
    std::vector<Octree::Part> finished;          ///< those with children
    Octree octree;                               ///< nodes below the finished
};

/// A map by itself, its nodes of one map's thickness finished. The map has 2^shape.map_levels texels a side,
/// and detail down to squares of shape.detail_height() or less.
Slab slab_of(std::shared_ptr<const CertainTree> map, const StackShape& shape);

/// A run of 2^slices_exponent maps that take any depth (paper, section 4: placeholders).
Slab placeholder_slab(const StackShape& shape, int slices_exponent);

/// Two runs of 2^j maps, one behind the other, to one of 2^(j + 1). Nothing when the octree gets more than
/// `max_nodes` nodes. O(nodes and squares of both).
std::optional<Slab> merge_slabs(Slab first, const Slab& second, const StackShape& shape,
                                std::uint64_t max_nodes = UINT64_MAX);

/// The octree of all maps: `slab` has them all.
MultiresTree octree_of(Slab slab, const StackShape& shape);

}  // namespace obscura
