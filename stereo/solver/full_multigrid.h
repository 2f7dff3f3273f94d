#pragma once
// Full multigrid: a first solution from the coarsest level up, one V-cycle per level (Brandt 1977;
// Trottenberg, Oosterlee, Schueller 2001, section 2.6).

#include "stereo/solver/v_cycle.h"

namespace obscura {

/// An approximate solution of A x = r of the finest level.
GridVector full_multigrid(GridHierarchy& hierarchy, const GridVector& r, const Exec& exec,
                          LevelSeconds& seconds);

}  // namespace obscura
