#pragma once
// Voxelised shadows: which of N^3 voxels of light space are lit, as an octree whose equal subtrees are one.
//
// E. Sintorn, V. Kaempe, O. Olsson, U. Assarsson, "Compact Precomputed Voxelized Shadows", SIGGRAPH 2014; the
// reduction to a graph and words of 64 voxels after V. Kaempe, E. Sintorn, U. Assarsson, "High Resolution
// Sparse Voxel DAGs", SIGGRAPH 2013. As theirs for closed objects, what lies inside solids may be either.
//
// Theirs begins with a depth map and voxels; ours never holds more than what changes along z. A square of the
// map is the run of cubes behind it, away from the light, and four squares make the cubes of one of twice the
// side. Squares whose texels can turn dark at a common boundary are one square, as in the trees that this is
// compared with.

#include <cstdint>
#include <vector>

#include "bench/peer_codes/voxel_cubes.h"
#include "core/image.h"
#include "core/types.h"

namespace obscura {

/// Where voxels may turn dark: at a boundary t in [first, last] of [0, N], all nearer ones lit.
struct VoxelRange {
    std::int32_t first = 0, last = 0;
    bool empty() const { return first > last; }
};

/// Of an interval at 2^levels voxels; empty where no boundary lies in it.
VoxelRange voxel_range(DepthInterval interval, int levels);

/// Cubes along z, equal ones together: up to `end`, counted in cubes, from where the run before ends.
struct CubeRun {
    std::uint32_t end = 0;
    CubeId id = CubeId::shadow;
};
using CubeRuns = std::vector<CubeRun>;

class VoxelDag {
  public:
    /// Of 2^levels texels a side and as many voxels in depth; levels in [leaf_level + 1, 20].
    explicit VoxelDag(int levels);

    /// The next rows of the map, all of the same number, a power of two.
    void add_band(ImageView<const DepthInterval> band);
    /// After all bands.
    void finish();

    bool lit(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return cubes_.lit(levels_, root_, x, y, z);
    }
    /// See CubeTable::bytes().
    std::uint64_t bytes() const { return cubes_.bytes(root_); }
    /// Different mixed cubes by level, from leaf_level to the root's.
    std::vector<std::size_t> counts() const { return cubes_.reached(root_); }
    /// Texels whose interval has no boundary of voxels in it: they turn dark at the next one behind its
    /// entry.
    std::uint64_t rounded_texels() const { return rounded_; }

  private:
    using Pyramid = std::vector<Image<VoxelRange>>;  ///< common ranges of squares, from the smallest up
    template <class Smallest>
    CubeRuns square(const Pyramid& ranges, int lowest, int level, int x, int y, const Smallest& smallest);
    CubeRuns uniform(int level, VoxelRange range);
    CubeId uniform_cube(int level, std::uint32_t boundary);
    CubeRuns join(int level, const CubeRuns (&quadrant)[4]);
    void quantise(ImageView<const DepthInterval> texels, Image<VoxelRange>& ranges);

    int levels_, tile_levels_ = -1;
    std::uint64_t rounded_ = 0;
    CubeTable cubes_;
    CubeId root_ = CubeId::shadow;
    std::vector<CubeRuns> tiles_;  ///< row by row, with their
    std::vector<VoxelRange> tile_ranges_;
    std::vector<std::vector<CubeId>> uniform_cubes_;  ///< by level and boundary, once asked for
};

}  // namespace obscura
