#pragma once
// Triangles against the pixels they show: how far they miss the map, and corners that make them miss less.

#include <cstdint>
#include <span>
#include <vector>

#include "core/isa.h"
#include "stereo/bisection.h"
#include "stereo/vertex_gather.h"

namespace obscura {

/// How many of a triangle's pixels its corners' changes, interpolated, miss by more than `tolerance_px`.
std::uint32_t missed_pixels(const SeenChange& seen, const Bisection& surface, std::uint32_t triangle,
                            double tolerance_px);

/// Moves the change of every point that `free` marks towards the least squares of what `triangles` show (all
/// others fixed: one damped Jacobi sweep). Pixels that hardly depend on a point hardly move it.
void fit_points(const SeenChange& seen, std::span<const std::uint32_t> triangles,
                std::span<const std::uint8_t> free, const Exec& exec, Bisection& surface);

}  // namespace obscura
