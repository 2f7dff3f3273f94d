#pragma once
// Every mesh and terrain of the data folder under one camera rule: for counting wrong pixels, not for timing.

#include <filesystem>
#include <vector>

#include "bench/shadows/scenes.h"

namespace obscura {

/// The scenes of shadow_recipes() and, below `data`, all other *.obj of meshes and cities and all *.pgm of
/// terrain whose .json tells the size of a cell, by name. Meshes stand on a slab, seen from the side and
/// above by a camera that sees all of them. Terrain is its middle, at most 300 x 300 cells, as an open sheet
/// of two triangles a cell.
std::vector<ShadowRecipe> sweep_recipes(const std::filesystem::path& data);

/// The recipe with its light from azimuth 215 degrees (clockwise from north, which is -Z) at that elevation.
ShadowRecipe with_sun_at(ShadowRecipe recipe, double elevation_deg);

}  // namespace obscura
