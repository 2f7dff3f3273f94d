#pragma once
// One monotone curve for the disparities of the whole picture: the comparison that local edits are held
// against.
//
// Lang, Hornung, Wang, Poulakos, Smolic, Gross, "Nonlinear Disparity Mapping for Stereoscopic 3D", SIGGRAPH
// 2010, section 4: linear and logarithmic operators on the range, and curves whose slope follows the content.
// Ours: the content is the histogram of disparity alone (no saliency), and one operator brings two
// disparities together as in figure 4.4 (right) of Scandolo's thesis: flat between them, a shift elsewhere.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/middle_view.h"

namespace obscura {

enum class RemapKind {
    none,
    linear,       ///< the map's own range to the wanted one
    logarithmic,  ///< the same ends; near depth compressed and far depth stretched, or the other way round
    histogram,    ///< the same ends; disparities that many pixels have get more of the range
    match,        ///< two disparities become one; what lies beyond either keeps its distance to it
};
/// "none", "linear", "log", "histogram", "match"; nothing for any other text.
std::optional<RemapKind> parse_remap(std::string_view text);

struct RangeRemap {
    RemapKind kind = RemapKind::none;
    double nearest_px = 0, farthest_px = 0;  ///< wanted range, nearest >= farthest; not for match
    double curvature = 4;  ///< logarithmic: |curvature| > 0; positive: slope at the near end is 1/(1 + it) of
                           ///< that at the far end; negative: the reverse
    double strength = 0.5;  ///< histogram, [0, 1]: 0 is linear, 1 equalises (unused disparities vanish)
    double first_px = 0, second_px = 0;  ///< match: disparities that are brought together, in either order
    double matched_px = 0;               ///< match: what both become
};

/// Knots, disparities ascending, values not descending; straight between, slope 1 beyond. None: the identity.
struct RemapCurve {
    std::vector<double> from, to;
    double at(double disparity) const;
};

/// The curve for a map's pixels that are valid. A map of one disparity is moved into the wanted range.
RemapCurve remap_curve(const DisparityMap& map, const Image<std::uint8_t>& valid, const RangeRemap& remap);

/// Every valid pixel through the curve; others stay.
DisparityMap remapped(const DisparityMap& map, const Image<std::uint8_t>& valid, const RemapCurve& curve,
                      const Exec& exec = {});

}  // namespace obscura
