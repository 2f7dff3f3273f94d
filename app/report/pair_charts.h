#pragma once
// Charts of a stereo report as inline SVG. Colours are the page's own, by class: see style.h.

#include <string>
#include <vector>

#include "stereo/comfort.h"
#include "stereo/middle_view.h"
#include "stereo/solver/solve_report.h"
#include "stereo/solver/solver.h"

namespace obscura {

/// Shares of pixels by disparity.
struct DisparityHistogram {
    double first_px = 0, step_px = 1;  ///< bin i holds [first + i step, first + (i + 1) step)
    std::vector<double> before, after;
    std::int64_t pixels = 0;
    double near_percent = 0, far_percent = 0;  ///< of `after`, outside of the zone
    double near_percent_before = 0, far_percent_before = 0;
    double before_low = 0, before_high = 0, after_low = 0, after_high = 0;  ///< pixels of disparity
};

/// Of what the picture without margins shows; pixels where nothing is are left out.
DisparityHistogram disparity_histogram(const MiddleView& view, const DisparityMap& optimised,
                                       const ComfortZone& zone);

/// Both over one axis, in pixels and in percent of the picture's width, with the comfort zone.
std::string histogram_svg(const DisparityHistogram& histogram, const ComfortZone& zone, int picture_width);

/// Residual and error estimates against the iteration on a logarithmic axis, with the tolerances. Empty
/// where a solver took no steps.
std::string convergence_svg(const SolveReport& report, const SolverParams& params);

struct ChartBar {
    std::string name;
    double seconds = 0;
};
/// Horizontal bars, each with its time.
std::string bars_svg(const std::vector<ChartBar>& bars, const std::string& what);

/// "0.32 s", "4.1 ms".
std::string time_text(double seconds);

}  // namespace obscura
