#pragma once
// Couplings between cells and hubs: of the finest level out of matching sets, of a coarser one out of the
// level above.

#include <algorithm>

#include "stereo/solver/grid_hierarchy.h"

namespace obscura {

/// A coupling before it is filed by rows.
struct PlacedCoupling {
    std::int32_t x = 0, y = 0;
    std::uint32_t hub = 0;
    float weight = 0;
};

/// Hubs, and what they are coupled to: members of their sets and the four neighbours of their pixel.
/// `hub_matrix` gets the hubs' own terms and those between hubs.
std::vector<PlacedCoupling> finest_couplings(const DisparitySystem& system,
                                             const std::vector<GridHierarchy::Pixel>& hubs,
                                             std::vector<double>& hub_matrix);

/// Source pixels of all sets that can be solved for, ascending, each once.
std::vector<GridHierarchy::Pixel> source_pixels(const DisparitySystem& system);

/// Files couplings into the level (equal places add up) and sums them per cell into `member`.
void file_couplings(std::vector<PlacedCoupling> placed, std::size_t hubs, GridLevel& level,
                    GridPlane& member);

/// What is known of a level only while the next one is made.
struct LevelPulls {
    GridPlane anchor;            ///< to fixed values, per cell
    GridPlane member;            ///< to hubs, per cell; empty without hubs
    GridPlane spread;            ///< 1 / the bilinear weights of those coarse cells that exist; empty: 1
    Image<std::uint8_t> coarse;  ///< cells of the next level: 1 where one exists
};

/// Once diagonal and shares of `fine` are known: its couplings in terms of the next level's cells, and the
/// next level's hub matrix.
std::vector<PlacedCoupling> coarse_couplings(const GridLevel& fine, std::size_t hubs, const LevelPulls& pulls,
                                             const Exec& exec, std::vector<double>& hub_matrix);

/// A row of the matrix that its pulls rule: interpolation follows the row's own equation there.
inline bool is_stiff(float pull, float diagonal) {
    return pull > 0.3f * diagonal;
}
/// What smooth interpolation keeps of a cell whose row has this diagonal and is pulled by `pull`, in (0, 1]:
/// never nothing, so that what was scaled by it can be scaled back.
inline float kept_share(float pull, float diagonal) {
    constexpr float least = 1e-3f;
    return is_stiff(pull, diagonal) ? std::max(1.0f - pull / diagonal, least) : 1.0f;
}

}  // namespace obscura
