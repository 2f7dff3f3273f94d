#pragma once
// Panels of lesson 21: where the maps stand, cuts through a stack along one row of texels, the octree's nodes
// on such a cut, and the runs of maps that answer a point.

#include <string>
#include <vector>

#include "hierarchy/stack/answered_runs.h"
#include "hierarchy/stack/stack.h"
#include "lessons/drawing/figure.h"
#include "lessons/stack_scene.h"

namespace obscura {

/// Points of a square along a Hilbert curve, one aligned run of a quarter of them in another colour.
void draw_curve(Figure& f, const Box& box, int count);

/// Depths of one row of texels in all maps: texels to the right, maps downwards. Found in the octree.
Image<float> row_of(const ShadowStack& stack, int row);

/// Near the light bright, far from it dark; what is as far as can be is background.
void draw_row(Figure& f, const Box& box, const Image<float>& depths);

/// Frames of the octree's nodes that the row meets, and how many there are.
int draw_row_nodes(Figure& f, const Box& box, const ShadowStack& stack, int row);

/// Texels from the left edge to where a map shows a point at height `h` over column `a` (stack_frame.h).
double column_of(const SliceView& map, double a, double h);

/// Runs of maps, downwards: lit ones orange, dark ones blue, with their number where there is room.
void draw_runs(Figure& f, const Box& box, const std::vector<AnsweredRun>& runs, int maps);

/// How many nodes each point took, a square of `zoom` pixels each: heat from `least` to `most`, logarithmic.
void draw_nodes_read(Figure& f, Vec2d at, const std::vector<double>& nodes, int columns, int zoom,
                     double least, double most);
/// The key to that.
void draw_heat_scale(Figure& f, const Box& box, double least, double most, const std::string& name);

}  // namespace obscura
