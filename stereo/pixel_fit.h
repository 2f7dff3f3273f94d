#pragma once
// Triangles against the pixels they show: how far they miss the map, and corners that make them miss less.

#include <cstdint>
#include <span>
#include <vector>

#include "core/isa.h"
#include "stereo/bisection.h"
#include "stereo/vertex_gather.h"

namespace obscura {

/// What a triangle lacks.
struct Miss {
    std::uint32_t pixels = 0;  ///< further from the map than the tolerance
    float worst_px = 0;        ///< largest distance
};

/// A triangle's pixels against its corners' changes, interpolated.
Miss miss_of(const SeenChange& seen, const Bisection& surface, std::uint32_t triangle, double tolerance_px);

/// Moves the change of every point that `moves` marks towards the least squares of what `triangles` show, all
/// others fixed, by damped Jacobi sweeps. Every shown triangle of a point that moves must be listed. Pixels
/// that hardly depend on a point hardly move it; of large triangles some pixels stand for all.
void fit_points(const SeenChange& seen, std::span<const std::uint32_t> triangles,
                std::span<const std::uint8_t> moves, const Exec& exec, Bisection& surface);

}  // namespace obscura
