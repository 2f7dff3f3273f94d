#pragma once
// The linear system of an edited disparity map: what edits and conflicts write, and what the solver reads.
//
// Scandolo, Bauszat, Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018; thesis equations 4.1 to
// 4.6. The energy of a map x is
//
//   E(x) =   c1 * 2 * sum over pairs of valid neighbours p, q = p + (1,0) or p + (0,1) of
//                                                          (x_q - x_p - gradient_p)^2
//          + sum over p of anchor_weight_p (x_p - anchor_value_p)^2
//          + sum over sets, members p of weight (x_p - x_source - target_p)^2
//          + epsilon * sum over p of (x_p - original_p)^2
//
// (each gradient equation stands twice in 4.1, hence the 2). Its minimiser is the optimised map. Pixels that
// are not valid (nothing is seen there, or a photograph has no value) are in no term and keep `start`.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/middle_view.h"

namespace obscura {

struct MatchedPixel {
    std::int32_t x = 0, y = 0;
    float target = 0;  ///< wanted x_p - x_source, pixels: offset + D_p - D_destination
};

/// Members follow the disparity of one source pixel (thesis 4.4). The source may not be a member.
struct MatchingSet {
    std::string name;  ///< of the edit, for reports
    std::int32_t source_x = 0, source_y = 0;
    float weight = 1;                   ///< c3 times the edit's own, > 0
    std::vector<MatchedPixel> members;  ///< ascending in (y, x), no pixel twice
};

/// Name of the area where comfort zone and sides of the picture hold edits back.
constexpr const char* limits_area_name = "comfort zone and sides of the picture";

/// What one edit's anchor asks for, pixel by pixel. For reports: the energy reads the sums of all of them.
struct AnchorArea {
    std::string name;                  ///< of the edit
    float weight = 1;                  ///< c2 times the edit's own
    std::vector<MatchedPixel> pixels;  ///< target: the wanted disparity
};

struct DisparitySystem {
    DisparityMap original;       ///< D
    DisparityMap start;          ///< D~: edits applied pixel by pixel, conflicts and all
    Image<float> gradient_x;     ///< wanted x(i + 1, j) - x(i, j); the last column is not read
    Image<float> gradient_y;     ///< wanted x(i, j + 1) - x(i, j); the last row is not read
    Image<float> anchor_weight;  ///< c2 times the edits' own, summed; >= 0
    Image<float> anchor_value;   ///< weighted mean of the anchors' values; read where the weight is > 0
    Image<std::uint8_t> valid;   ///< 1, or 0 for pixels outside of the system
    std::vector<MatchingSet> sets;
    std::vector<AnchorArea> anchors;  ///< what anchor_weight and anchor_value are made of; may be empty
    float gradient_weight = 1;        ///< c1 > 0
    float epsilon = 1e-4f;            ///< > 0
    int width() const { return original.width; }
    int height() const { return original.height; }
};

/// A system without edits: gradients and anchors of `original` itself, everything valid or as in `valid` (may
/// be empty). Its minimiser is `original`.
DisparitySystem unedited_system(const DisparityMap& original, const Image<std::uint8_t>& valid,
                                const Exec& exec = {});

/// E(x) in double.
double energy(const DisparitySystem& system, const DisparityMap& x);

/// b - A x in double, unrounded: minus half the gradient of the energy. 0 at pixels that are not valid.
Image<double> residual(const DisparitySystem& system, const DisparityMap& x);

/// The same for row y without matching sets; `out` has width() doubles.
void residual_row(const DisparitySystem& system, const DisparityMap& x, int y, double* out);

/// Calls add(x, y, value) with what matching sets add to the residual, members before their source.
template <class Add>
void set_residuals(const DisparitySystem& system, const DisparityMap& x, Add&& add) {
    for (const MatchingSet& set : system.sets) {
        if (system.valid(set.source_x, set.source_y) == 0) continue;
        const auto source = static_cast<double>(x(set.source_x, set.source_y));
        const auto weight = static_cast<double>(set.weight);
        double back = 0;
        for (const MatchedPixel& p : set.members) {
            if (system.valid(p.x, p.y) == 0 || (p.x == set.source_x && p.y == set.source_y)) continue;
            const double pull =
                weight * (static_cast<double>(p.target) + source - static_cast<double>(x(p.x, p.y)));
            add(p.x, p.y, pull);
            back -= pull;
        }
        add(set.source_x, set.source_y, back);
    }
}

}  // namespace obscura
