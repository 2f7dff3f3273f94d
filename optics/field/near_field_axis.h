#pragma once
// One axis of the Fresnel integral: what every edge of the mask does to every pixel.
//
// A run of open texels between the edges j0 and j1 lights pixel i with E(j1, i) - E(j0, i), where E is the
// Fresnel integral at the distance from pixel to edge. Where step is a ratio p / q of small whole numbers all
// these distances lie on one lattice of pitch 1 / q, so a table of q texels + p pixels entries holds every
// row. Differences of its entries lose digits only where the whole mask is narrow in units of the chirp (z
// far beyond the far field); rows are then integrated from the mask's middle edge instead, one by one.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/isa.h"

namespace obscura {

/// Pixel i stands at first + i step from the mask's centre, edge j at j - texels / 2. In texels.
struct PlaneAxis {
    int texels = 0, pixels = 0;
    double first = 0, step = 0;
    /// From pixel to edge.
    double distance(int edge, int pixel) const { return edge - (0.5 * texels + first) - pixel * step; }
    friend bool operator==(const PlaneAxis&, const PlaneAxis&) = default;
};

/// step = p / q, without a common divisor.
struct StepRatio {
    int p = 0, q = 0;
};
/// Nothing when no q <= 16 makes it whole.
std::optional<StepRatio> step_ratio(double step);

/// True where differences of Fresnel integrals would lose digits: the mask spans less than 1e-4 of the
/// chirp's unit of length.
bool is_narrow(const PlaneAxis& axis, double turns);

/// Rows of E. Row `edge` has axis.pixels values, and 15 more that may be read.
class EdgeTable {
  public:
    /// `turns`: pitch^2 / (2 lambda z), turns of phase at a distance of one texel. `edges`: those whose rows
    /// will be read, ascending.
    EdgeTable(const PlaneAxis& axis, double turns, const std::vector<std::int32_t>& edges, const Exec& exec);
    std::int64_t offset(int edge) const { return offset_[static_cast<std::size_t>(edge)]; }
    const double* re(int edge = 0) const { return re_.data() + offset(edge); }
    const double* im(int edge = 0) const { return im_.data() + offset(edge); }
    /// Of all rows together: row `edge` begins offset(edge) after it.
    const double* re_base() const { return re_.data(); }
    const double* im_base() const { return im_.data(); }

  private:
    void fill_lattice(const PlaneAxis& axis, double turns, StepRatio ratio, const Exec& exec);
    void fill_rows(const PlaneAxis& axis, double turns, const std::vector<std::int32_t>& edges,
                   const Exec& exec);
    std::vector<double> re_, im_;
    std::vector<std::int64_t> offset_;
};

}  // namespace obscura
