#pragma once
// The scenes of lessons 5 to 8: a map of sixteen texels, a small town in the sun, and a tree as squares that
// can be painted.

#include <vector>

#include "core/image.h"
#include "core/mesh.h"
#include "core/pixel.h"
#include "core/types.h"
#include "hierarchy/multires.h"

namespace obscura {

/// A map of 4 x 4 texels: roofs, a street, and one texel that fits nowhere.
Image<DepthInterval> small_map();

/// A town of the generator, with its topology.
Mesh lesson_town();
/// A ball and a ring over a slab: surfaces of many small triangles.
Mesh lesson_solids();
/// The same sun for every lesson.
Vec3d lesson_sun();
/// The sun's view of a mesh, N x N texels.
LightView lesson_view(const Mesh& mesh, int texels);

/// A node of a tree and the square it stands for: 2^level texels a side, at (x, y) in squares of that level.
struct TreeSquare {
    int level = 0;
    std::uint32_t x = 0, y = 0;
    ChildKind kind = ChildKind::leaf;
    float value = 0;  ///< not of empty nodes
};
/// Every node of a quadtree, the root first.
std::vector<TreeSquare> squares_of(const MultiresTree& tree);

/// Full nodes blue, leaves green, empty ones orange.
Rgb8 kind_color(ChildKind kind);

}  // namespace obscura
