#pragma once
// The strategies behind near_field(): each computes the same field, in its own way, into rows of `target`
// (target.stride >= grid.width). `turns` is pitch^2 / (2 lambda z): half the phase, in turns, that a texel
// off the axis adds.

#include "core/isa.h"
#include "optics/field.h"
#include "optics/mask_changes.h"
#include "optics/near_field.h"
#include "optics/near_field_axis.h"
#include "optics/quads.h"

namespace obscura {

/// What every strategy reads.
struct NearFieldCase {
    ImageView<const float> mask;
    PlaneGrid grid;
    double turns = 0;
    LineChanges changes;  ///< of the mask's rows
    MaskSymmetry symmetry;
    PlaneAxis horizontal() const { return {mask.width, grid.width, grid.first_x, grid.step}; }
    PlaneAxis vertical() const { return {mask.height, grid.height, grid.first_y, grid.step}; }
};

/// The mask to compute with and the plane in its texels; `coarse` keeps the mask if it is not the aperture's
/// own. Throws InputError for lengths and positions that mean nothing.
NearFieldCase near_field_case(const Aperture& aperture, const PlaneGrid& grid, const NearFieldParams& params,
                              Aperture& coarse);

/// The planner's choice, or the method that `params` names. Throws InputError when that cannot serve the
/// plane or cannot cull.
NearFieldReport plan_near_field_case(const NearFieldCase& c, const NearFieldParams& params);

/// What of the plane must be computed, from its upper left corner on: half an axis along which mask and plane
/// both are their own mirror images, the whole of any other.
struct PlanePart {
    int columns = 0, rows = 0;
};
PlanePart part_to_compute(const NearFieldCase& c);

/// Equation 3.19 as it stands: quads x pixels, in double.
void near_field_direct(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                       const Exec& exec);

/// The thesis's two passes: the factors of every quad along x and along y, then their products.
void near_field_two_pass(const NearFieldCase& c, const QuadList& quads, const FieldTarget& target,
                         const Exec& exec);

/// As few products as the mask has distinct columns (or rows, where they are fewer). Writes the counts of
/// blocks to `report` when `cull` > 0.
void near_field_edges(const NearFieldCase& c, double cull, const FieldTarget& target, const Exec& exec,
                      NearFieldReport& report);

/// Runs of rows by their ends, then convolutions of columns. step = p / q, q <= 16, and less than 2^16 texels
/// of mask and plane together.
void near_field_hybrid(const NearFieldCase& c, const FieldTarget& target, const Exec& exec);

/// Convolutions of rows, then of columns: the kernel is a product, so the two-dimensional transform falls
/// apart. The grids of the hybrid, in both axes.
void near_field_fft(const NearFieldCase& c, const FieldTarget& target, const Exec& exec);

}  // namespace obscura
