#pragma once
// Places on a light, one after the other beside each other: along a Hilbert curve, as T. Ritschel, T. Grosch,
// J. Kautz, S. Mueller, "Interactive Illumination with Coherent Shadow Maps", EGSR 2007, so that neighbours
// in a stack see nearly the same.

#include <cstddef>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// Samples of a light: where they stand, or the way their light travels (unit).
struct LightSamples {
    bool directional = false;
    std::vector<Vec3d> at;
};

/// `count` (a power of two) cells of the unit square in the order of a Hilbert curve, their middles: 2^i x
/// 2^i cells, or two such squares side by side. Every run of 4^j of them, aligned, is a square of cells.
std::vector<Vec2d> hilbert_samples(int count);

/// Which of `places` comes k-th along a Hilbert curve over the square that holds them: for samples that were
/// made in another order. Places in one of its 2^16 x 2^16 cells keep their order.
std::vector<std::size_t> hilbert_order(const std::vector<Vec2d>& places);

/// Of the parallelogram centre + (u - 1/2) edge_u + (v - 1/2) edge_v.
LightSamples parallelogram_samples(Vec3d centre, Vec3d edge_u, Vec3d edge_v, int count);

/// Of a disc with this normal: equal areas (P. Shirley, K. Chiu, "A Low Distortion Map Between Disk and
/// Square", 1997).
LightSamples disc_samples(Vec3d centre, Vec3d normal, double radius, int count);

/// Directions of a round light at infinity, the sun, seen `angular_radius_deg` wide to each side; `direction`
/// is the way the light of its middle travels. Equal areas of the disc that its tangent plane cuts out.
LightSamples sun_samples(Vec3d direction, double angular_radius_deg, int count);

}  // namespace obscura
