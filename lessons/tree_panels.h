#pragma once
// Panels of lessons 5 and 8: intervals in cells, nodes of a level, a kernel on the tree's squares.

#include <vector>

#include "core/image.h"
#include "core/types.h"
#include "filters/shadow_lookup.h"
#include "lessons/drawing/figure.h"
#include "lessons/tree_scene.h"

namespace obscura {

/// Every texel's interval as a bar, depth down its cell, and its ends in numbers; `side` pixels a side.
void draw_intervals(Figure& f, const Image<DepthInterval>& map, Vec2d origin, double side);

/// The nodes of one level, coloured by kind, with their values; `cells` are the squares of that level.
void draw_nodes(Figure& f, const std::vector<TreeSquare>& squares, int level, const Cells& cells);

/// Texel of the first pixel among those whose kernels take the most steps, though they part late: in squares
/// of 16 texels or less. `steps`: of every sample of `blocks`.
Vec2d telling_kernel(const std::vector<SurfaceBlock>& blocks, const std::vector<ref::PcfSteps>& steps,
                     const PcfLight& light);

/// The squares of a tree around texel (kx, ky), its kernel of 5 x 5 texels, and the kernel's lowest common
/// node; two lines of text below.
void draw_kernel(Figure& f, const std::vector<TreeSquare>& squares, int kx, int ky, const Cells& cells);

}  // namespace obscura
