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
    /// Largest distance, less what snapping of the corners to 1/256 pixel explains: triangles seen edge-on
    /// change so much within a pixel that no cut brings their pixels home.
    float worst_px = 0;
};

/// A triangle's pixels against its corners' changes, interpolated.
Miss miss_of(const SeenChange& seen, const Bisection& surface, std::uint32_t triangle, double tolerance_px);

/// How a point comes to its change: from the map around it, or from the pixels of its triangles.
enum class Follow : std::uint8_t { gathered, moving, resting };

struct PointMove {
    std::uint32_t point = 0;
    double moved_px = 0;
};

/// Moves the change of every point that is `moving` towards the least squares of what `triangles` show, all
/// others fixed, by damped Jacobi sweeps; says how far. Every shown triangle of such a point must be listed.
/// Pixels that hardly depend on a point hardly move it; of large triangles some pixels stand for all.
std::vector<PointMove> fit_points(const SeenChange& seen, std::span<const std::uint32_t> triangles,
                                  std::span<const Follow> follow, const Exec& exec, Bisection& surface);

}  // namespace obscura
