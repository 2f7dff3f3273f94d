#pragma once
// The paper's solver (F. L. Scandolo, thesis, 2019, section 4.3.3): a pyramid of half resolutions, ten Jacobi
// sweeps per level, once from coarse to fine. For teaching and comparison: each level is a problem of its
// own, with sampled disparities and weights as they are, so what it hands on is the solution of something
// else; and ten sweeps reach four pixels far. The notes to the printed formula for going up a level are at
// `printed_sign`.

#include "stereo/solver/grid_plane.h"
#include "stereo/solver/solver.h"

namespace obscura {

/// One level of the pyramid: every second pixel of the one below it. Gradients are summed along the way from
/// pixel to pixel, members of sets and sources are those that are met.
DisparitySystem halved(const DisparitySystem& system);

/// x of the finer level: the coarse solution at the nearest coarse pixel plus what the edited maps differ by,
/// D~_fine - D~_coarse. printed_sign: minus that, as printed. Pixels whose coarse one is not valid: D~_fine.
DisparityMap upsampled(const DisparitySystem& fine, const DisparitySystem& coarse, const DisparityMap& x,
                       bool printed_sign);

/// The system as x = (b + pull of neighbours and sets) / diagonal: what Jacobi's method repeats.
struct JacobiForm {
    GridPlane b, relax;  ///< relax = 1 / diagonal; 0 where a pixel is not valid
};
/// Summed in double, then rounded to what the row loops take.
JacobiForm jacobi_form(const DisparitySystem& system, const Exec& exec);

/// `sweeps` undamped Jacobi sweeps on the system itself.
DisparityMap jacobi_sweeps(const DisparitySystem& system, DisparityMap x, int sweeps, const Exec& exec);

/// The same with the map as 16-bit floats between sweeps: half of the memory, a map that is off by up to half
/// a unit of 2^-10 of its value per sweep (1/64 pixel between 32 and 64 pixels).
DisparityMap jacobi_sweeps_half(const DisparitySystem& system, DisparityMap x, int sweeps, const Exec& exec);

/// The whole cascade; report.steps has one entry per level, without estimates: there are none to be had.
/// Where params.verify asks for it, the report says how far the map is from the minimiser that solve() finds.
/// params.method is not read.
Solution solve_cascade(const DisparitySystem& system, const SolverParams& params, const Exec& exec);

}  // namespace obscura
