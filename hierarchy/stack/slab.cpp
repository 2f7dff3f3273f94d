// Merging runs of maps: see slab.h.

#include "hierarchy/stack/slab.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace obscura {
namespace {

using Octree = Slab::Octree;
using Part = Octree::Part;

/// What a child that does not exist counts as: every depth lies in it, so it never decides (paper, section
/// 4).
constexpr Part placeholder{{0.0f, 1.0f}, 0, 0};

/// Height to which nodes of 2^j maps are finished without those of more maps.
int finished_height(const StackShape& shape, int slices_exponent) {
    return slices_exponent == shape.slice_levels ? shape.levels() : shape.slice_start() + slices_exponent;
}

/// A finished node, by its number if it has children.
CertainSquare square_of(const Part& part, std::vector<Part>& finished) {
    if (part.kinds == 0) return CertainSquare(part.interval);
    CHECK(finished.size() <= UINT32_MAX);
    finished.push_back(part);
    return CertainSquare::of_group(static_cast<std::uint32_t>(finished.size() - 1));
}

/// What a square of a slab has in common, and what it is where it is finished.
struct View {
    const Slab& slab;
    const CertainTree& certain = *slab.certain;
    int low;                   ///< log2 of the side of finished squares
    std::uint64_t offset = 0;  ///< of the nodes of its octree, in the octree that is made

    DepthInterval common(CertainSquare s, int exponent) const {
        if (!s.is_group()) return s.depths();
        return exponent == low ? no_common_depth : certain.groups[s.group()].common;
    }
    Part part(CertainSquare s) const {
        if (!s.is_group()) return Octree::texel(s.depths());
        Part part = slab.finished[s.group()];
        part.first_child += offset;
        return part;
    }
};

/// Finishes the squares of one run up to a height, along the map's axes alone.
class Raise {
  public:
    Raise(Slab& from, const StackShape& shape, int height)
        : from_{from, *from.certain, shape.side_exponent(from.height)}, high_(shape.side_exponent(height)) {
        to.slices_exponent = from.slices_exponent;
        to.height = height;
        to.octree = std::move(from.octree);
        CertainTree made;
        made.levels = from.certain->levels;
        made.root = square(from.certain->root, made.levels, made.groups);
        to.certain = std::make_shared<const CertainTree>(std::move(made));
    }
    Slab to;

  private:
    CertainSquare square(CertainSquare s, int exponent, std::vector<CertainGroup>& groups) {
        if (!s.is_group()) return s;
        if (exponent == high_) return square_of(part(s, exponent), to.finished);
        CertainSquare quadrant[4];
        for (int i = 0; i < 4; ++i)
            quadrant[i] = square(from_.certain.quadrant(s, i), exponent - 1, groups);
        return add_certain(quadrant, from_.common(s, exponent), groups);
    }

    Part part(CertainSquare s, int exponent) {
        const DepthInterval common = from_.common(s, exponent);
        if (has_depth(common)) return Octree::texel(common);
        if (exponent == from_.low) return from_.part(s);
        Part child[8];
        std::fill(std::begin(child), std::end(child), placeholder);
        for (int i = 0; i < 4; ++i)
            child[i] = part(from_.certain.quadrant(s, i), exponent - 1);
        return to.octree.join(child);
    }

    View from_;
    int high_;
};

class Merge {
  public:
    Merge(Slab& first, const Slab& second, const StackShape& shape, std::uint64_t max_nodes)
        : first_{first, *first.certain, shape.side_exponent(first.height)},
          second_{second, *second.certain, first_.low},
          max_nodes_(max_nodes),
          high_(shape.side_exponent(first.height + 1)) {
        to.slices_exponent = first.slices_exponent + 1;
        to.height = first.height + 1;
        to.octree = std::move(first.octree);
        second_.offset = to.octree.append(second.octree);
        CertainTree made;
        made.levels = first.certain->levels;
        made.root = square(first.certain->root, second.certain->root, made.levels, made.groups);
        to.certain = std::make_shared<const CertainTree>(std::move(made));
    }
    bool over() const { return to.octree.nodes.size() > max_nodes_; }
    Slab to;

  private:
    CertainSquare square(CertainSquare a, CertainSquare b, int exponent, std::vector<CertainGroup>& groups) {
        const DepthInterval common = common_depths(first_.common(a, exponent), second_.common(b, exponent));
        const bool agree = has_depth(common);
        if (agree && (exponent == high_ || (!a.is_group() && !b.is_group()))) return CertainSquare(common);
        if (over()) return CertainSquare();
        if (exponent == high_) return square_of(joined(a, b), to.finished);
        CertainSquare quadrant[4];
        for (int i = 0; i < 4; ++i) {
            quadrant[i] =
                square(first_.certain.quadrant(a, i), second_.certain.quadrant(b, i), exponent - 1, groups);
        }
        return add_certain(quadrant, common, groups);
    }

    Part joined(CertainSquare a, CertainSquare b) {
        Part child[8];
        std::fill(std::begin(child), std::end(child), placeholder);
        if (high_ == first_.low) {
            child[0] = first_.part(a);
            child[4] = second_.part(b);
        } else {
            for (int i = 0; i < 4; ++i) {
                child[i] = first_.part(first_.certain.quadrant(a, i));
                child[4 + i] = second_.part(second_.certain.quadrant(b, i));
            }
        }
        return to.octree.join(child);
    }

    View first_, second_;
    std::uint64_t max_nodes_;
    int high_;
};

void finish(Slab& slab, const StackShape& shape) {
    const int height = finished_height(shape, slab.slices_exponent);
    if (height > slab.height) slab = Raise(slab, shape, height).to;
}

}  // namespace

Slab slab_of(std::shared_ptr<const CertainTree> map, const StackShape& shape) {
    CHECK(map->levels == shape.map_levels);
    CHECK(shape.anisotropy >= -shape.slice_levels && shape.anisotropy <= shape.map_levels);
    Slab slab;
    slab.certain = std::move(map);
    finish(slab, shape);
    return slab;
}

Slab placeholder_slab(const StackShape& shape, int slices_exponent) {
    Slab slab;
    slab.slices_exponent = slices_exponent;
    slab.height = finished_height(shape, slices_exponent);
    CertainTree map;
    map.levels = shape.map_levels;
    map.root = CertainSquare(placeholder.interval);
    slab.certain = std::make_shared<const CertainTree>(std::move(map));
    return slab;
}

std::optional<Slab> merge_slabs(Slab first, const Slab& second, const StackShape& shape,
                                std::uint64_t max_nodes) {
    CHECK(first.slices_exponent == second.slices_exponent && first.slices_exponent < shape.slice_levels);
    Merge merge(first, second, shape, max_nodes);
    if (merge.over()) return {};
    finish(merge.to, shape);
    if (merge.over()) return {};
    return std::move(merge.to);
}

MultiresTree octree_of(Slab slab, const StackShape& shape) {
    CHECK(slab.slices_exponent == shape.slice_levels && slab.height == shape.levels());
    MultiresTree tree;
    tree.dimensions = 3;
    tree.levels = shape.levels();
    const CertainSquare root = slab.certain->root;
    const Part part = root.is_group() ? slab.finished[root.group()] : Octree::texel(root.depths());
    tree.root = {stored_depth(part.interval), part.kinds, part.first_child};
    tree.root_interval = part.interval;
    tree.nodes = std::move(slab.octree.nodes);
    return tree;
}

}  // namespace obscura
