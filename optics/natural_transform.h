#pragma once
// What the methods on natural grids need besides the mask: made once, it serves every mask of one size, as
// the plan of an FFT library does.

#include <vector>

#include "filters/fft.h"
#include "optics/far_field.h"
#include "optics/field/field.h"
#include "optics/field/natural_grid.h"
#include "optics/field/row_runs.h"
#include "optics/spectrum_columns.h"

namespace obscura {

struct NaturalTransform {
    NaturalGrid grid;
    int width = 0, height = 0;  ///< of the mask
    FftPlan u_plan, v_plan;
    UnitRoots roots;  ///< of the period of u
    ExactRoots u_roots, v_roots;
    /// Roots of lane * x, element 16 x + lane, for the edges x = 0 to width (and the same about the middle).
    std::vector<float> step_re, step_im, mirror_step_re, mirror_step_im;
    AxisFactors u_texel, v_texel, u_edge;  ///< see natural_grid.h
    /// Of every group of columns: for sums over texels, over edges, and real sums about the middle.
    std::vector<GroupStrips> texel_strips, edge_strips, mirror_strips;

    /// Groups that the grid shows anything of, ascending: all of them, or a window's.
    std::vector<int> used_groups;

    SpectrumRows rows() const { return spectrum_rows(grid.v, v_plan, v_texel); }
};

NaturalTransform natural_transform(int width, int height, const NaturalGrid& grid);

/// Far field of a mask of the transform's size, over the transform's grid; see optics/far_field_methods.h.
/// `runs` are row_runs() of the mask.
void far_field_runs(ImageView<const float> mask, const RowRuns& runs, const NaturalTransform& transform,
                    const FieldTarget& target, const Exec& exec);
void far_field_raster_fft(ImageView<const float> mask, const NaturalTransform& transform,
                          const FieldTarget& target, const Exec& exec);

/// far_field_into() with tables made before, for `grid` and the mask's size: what to call for many masks.
void far_field_into(const Aperture& aperture, const FrequencyGrid& grid, const FarFieldParams& params,
                    const NaturalTransform& tables, const FieldTarget& target, const Exec& exec,
                    FarFieldReport* report = nullptr);

}  // namespace obscura
